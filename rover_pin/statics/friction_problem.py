"""What every friction rule starts from: contacts, their friction, and the rover's equilibrium."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from rover_pin.errors import InputError
from rover_pin.numerics import Array, frozen
from rover_pin.statics.force_space import ForceSpace, force_space
from rover_pin.statics.stance import Contact, Stance


class Rows(Protocol):
    """Equilibrium of a stance: contact @ f + internal @ lam = gravity, lam >= internal_lower.

    f holds the world force (3) of each contact in turn; a lower bound is -inf or 0.
    """

    @property
    def gravity(self) -> Array:
        """(m,) generalised weight, springs included."""

    @property
    def contact(self) -> Array:
        """(m, 3k) columns of the world force components."""

    @property
    def internal(self) -> Array:
        """(m, j) columns of the multipliers of couplings, loops, stops and tracks."""

    @property
    def internal_lower(self) -> Array:
        """(j,) -inf where a multiplier binds both ways, 0 where it only pushes."""


@dataclass(frozen=True)
class FrictionProblem:
    """Contacts with friction under a weight.

    Attributes:
        contacts: k contacts.
        friction: (k,) coefficient of friction at each.
        frames: (k, 3, 3) rows: normal, rolling and lateral direction of each contact, world.
        weight: N.
        driven: names of the wheels a motor turns.
        rows: the equilibrium.
    """

    contacts: tuple[Contact, ...]
    friction: Array
    frames: Array
    weight: float
    driven: frozenset[str]
    rows: Rows

    @cached_property
    def space(self) -> ForceSpace:
        """All forces in equilibrium, computed once."""
        return force_space(self.rows, self.frames, self.free, self.weight)

    @cached_property
    def free(self) -> tuple[bool, ...]:
        """Per contact, whether its wheel turns freely."""
        return tuple(c.free for c in self.contacts)

    @cached_property
    def names(self) -> tuple[str, ...]:
        """A name per contact: the wheel's, with `#2`, `#3` at its further contacts."""
        return contact_names(self.contacts)


def contact_names(contacts: Sequence[Contact]) -> tuple[str, ...]:
    """A name per contact: the wheel's, with `#2`, `#3` at its further contacts."""
    seen: dict[str, int] = {}
    names = []
    for contact in contacts:
        seen[contact.wheel] = count = seen.get(contact.wheel, 0) + 1
        names.append(contact.wheel if count == 1 else f"{contact.wheel}#{count}")
    return tuple(names)


def contact_frames(contacts: Sequence[Contact]) -> Array:
    """(k, 3, 3) orthonormal rows: normal, rolling and lateral = normal x rolling; any tangent for a foot."""
    frames = np.empty((len(contacts), 3, 3))
    for frame, contact in zip(frames, contacts, strict=True):
        normal = contact.normal / np.linalg.norm(contact.normal)
        rolling = contact.rolling - (contact.rolling @ normal) * normal
        if rolling @ rolling < 1e-12:
            rolling = np.eye(3)[int(np.argmin(np.abs(normal)))]
            rolling = rolling - (rolling @ normal) * normal
        rolling = rolling / np.linalg.norm(rolling)
        frame[0], frame[1], frame[2] = normal, rolling, np.cross(normal, rolling)
    return frames


def friction_of(contacts: Sequence[Contact], friction: float | None) -> Array:
    """(k,) coefficients: `friction` everywhere, or what each shape declares where it is None.

    Raises:
        InputError: a coefficient that is not a positive finite number.
    """
    if friction is not None:
        _check_friction(friction, "friction", "give a number above 0, like 0.6")
        return np.full(len(contacts), float(friction))
    for contact in contacts:
        _check_friction(
            contact.friction,
            contact.wheel,
            "declare the wheel's `friction` above 0 in the sidecar, or give one",
        )
    return np.array([float(c.friction) for c in contacts])


def _check_friction(value: object, element: str, cure: str) -> None:
    number = isinstance(value, (int, float, np.floating, np.integer)) and not isinstance(value, bool)
    if not number or not math.isfinite(value) or value <= 0:  # type: ignore[arg-type, operator]
        raise InputError("not a coefficient of friction", element=element, value=value, cure=cure)


def friction_problem(stance: Stance, friction: float | None) -> FrictionProblem:
    """The problem of a settled stance.

    Raises:
        InputError: the stance is not settled, or the friction is not positive and finite.
    """
    require_settled(stance)
    from rover_pin.statics.balance import balance

    driven = frozenset(w.name for w in stance.rover.wheels if w.drive is not None and not w.free)
    return make_problem(stance.contacts, balance(stance), stance.weight, friction, driven)


def make_problem(
    contacts: Sequence[Contact], rows: Rows, weight: float, friction: float | None, driven: frozenset[str]
) -> FrictionProblem:
    """The problem of contacts and their equilibrium, whatever they come from."""
    return FrictionProblem(
        contacts=tuple(contacts),
        friction=frozen(friction_of(contacts, friction)),
        frames=frozen(contact_frames(contacts)),
        weight=float(weight),
        driven=driven,
        rows=rows,
    )


def require_settled(stance: Stance) -> None:
    """Raise InputError where the rover does not stand."""
    if not stance.settled:
        why = f": {stance.reason}" if stance.reason else ""
        raise InputError(
            f"the rover does not stand, so nothing carries it{why}",
            element=f"stance of {stance.rover.name}",
            value=str(stance.status),
            cure="ask this of a stance whose status is settled",
        )
