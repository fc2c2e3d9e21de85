"""Wheels and feet stay on the ground and do not slide on it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from rover_pin.errors import InputError
from rover_pin.kinematics.instant import Bodies, Instant, Integers
from rover_pin.kinematics.rolling import DIRECTIONS
from rover_pin.kinematics.rows import Rows, equations, gain_between, weight
from rover_pin.numerics import Array


@dataclass(frozen=True)
class ContactKept:
    """Rows of what stands: along the normal, along the rolling direction, sideways.

    A wheel without a turning joint of its own, which a track carries or a simple URDF fixes, rolls freely.
    Feet have no rolling direction: what holds them along holds them across, whatever side slip may do.

    Attributes:
        lifted: wheels and feet that do not stand.
        directions: which of `normal`, `roll`, `slip` these rows are. Where sliding may bend it has a
            ContactKept of its own: `ContactKept(directions=("normal", "roll"))` and
            `ContactKept(directions=("slip",), bend=100.0)` for a rover that must skid to turn.
        gain: share of a gap that is closed in a step.
        bend: weight of a (m/s) squared, see `Rows`.

    Raises:
        InputError: no or an unknown direction, a gain outside (0, 1], or a bend that is no weight.
    """

    lifted: tuple[str, ...] = ()
    directions: tuple[str, ...] = DIRECTIONS
    gain: float = 0.5
    bend: float = math.inf
    _kept: list[tuple[Bodies, Standing]] = field(default_factory=list, repr=False, compare=False)

    def __post_init__(self) -> None:
        gain_between("contact: gain", self.gain)
        weight("contact: bend", self.bend, may_be_infinite=True)
        if not self.directions:
            raise InputError("keeps no direction", element="contact", cure=f"known: {', '.join(DIRECTIONS)}")
        for word in self.directions:
            if word not in DIRECTIONS:
                raise InputError("is no direction of a contact", element="contact", value=word,
                                 cure=f"known: {', '.join(DIRECTIONS)}")  # fmt: skip
        object.__setattr__(self, "lifted", tuple(self.lifted))
        object.__setattr__(self, "directions", tuple(self.directions))

    def rows(self, at: Instant, dt: float) -> Rows:
        """Rows of every wheel and foot that stands, direction by direction.

        Raises:
            InputError: a lifted wheel that the rover does not have.
        """
        places, names, normals = self._standing(at)
        every = at.contact_rows
        matrix: Array = every.reshape(-1, every.shape[2]).take(places, axis=0)
        rate = np.zeros(len(matrix))
        if normals is not None:
            first, which = normals
            rate[first : first + len(which)] = -self.gain / dt * at.contacts[which, 0]
        return equations(names, matrix, rate, self.bend)

    def _standing(self, at: Instant) -> Standing:
        """Shapes of each direction's rows, and names; kept, as they are the same in every step."""
        if not self._kept or self._kept[0][0] is not at.bodies:
            away = set(at.index(self.lifted).tolist())
            shapes = at.bodies.names
            stands = [i for i in range(len(shapes)) if i not in away]
            rolls = [i for i in stands if at.bodies.can_hold[i]]
            feet = [i for i in stands if i >= len(at.rover.wheels)]
            normals = None
            places: list[int] = []
            names: list[str] = []
            for word in self.directions:
                for row, chosen in _rows_of(word, stands, rolls, feet):
                    if row == "normal":
                        normals = len(names), np.array(chosen, dtype=np.int64)
                    first = DIRECTIONS.index(row) * len(shapes)
                    places += [first + i for i in chosen]
                    names += [f"{_WORDS[row]} of {shapes[i]}" for i in chosen]
            self._kept[:] = [(at.bodies, Standing(np.array(places, dtype=np.int64), tuple(names), normals))]
        return self._kept[0][1]


def _rows_of(word: str, stands: list[int], rolls: list[int], feet: list[int]) -> list[tuple[str, list[int]]]:
    """Directions and shapes of the rows that a word stands for."""
    if word == "roll":
        return [("roll", rolls), ("slip", feet)] if feet else [("roll", rolls)]
    if word == "slip":
        return [("slip", [i for i in stands if i not in feet])]
    return [(word, stands)]


class Standing(NamedTuple):
    """Rows of what stands.

    Attributes:
        places: of each row among all shapes' normal, rolling and sideways rows.
        names: of all rows.
        normals: first row and shapes of the rows along the normal, where there are some.
    """

    places: Integers
    names: tuple[str, ...]
    normals: tuple[int, Integers] | None


SLIP = 1e-2
"""Weight of side slip squared, small beside a task's: wheels scrub sideways where uneven ground, a lifted
side or a rover that has to skid leaves nothing else. Where steering agrees they do not slip."""


def rolling_contacts(lifted: tuple[str, ...] = (), slip: float = SLIP) -> tuple[ContactKept, ContactKept]:
    """Wheels stay on the ground and roll, and slip sideways as little as can be.

    Args:
        lifted: wheels and feet that do not stand.
        slip: weight of side slip squared; inf forbids it.
    """
    return (
        ContactKept(lifted, directions=("normal", "roll")),
        ContactKept(lifted, directions=("slip",), bend=slip),
    )


_WORDS = {"normal": "contact", "roll": "rolling", "slip": "side slip"}
