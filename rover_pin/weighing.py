"""Masses and first moments of a rover whose masses are others than its files say, many rovers at once.

All of statics hangs on the mass m_j of what is fixed to a joint and on its first moment m_j c_j. A link of
mass m with its centre at c (in the joint's frame) that weighs m' and is moved by d (in the link's own
frame, R to the joint's) changes them by m' - m and by (m' - m) c + m' R d.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rover_pin.description.masses import ROBOT
from rover_pin.description.recipe import Payload, seat
from rover_pin.numerics import Array

NONE = 1e-12
"""kg or kg m: below this there is nothing that could be moved."""


class Body(NamedTuple):
    """A link of n rovers (arrays of one row where all are alike).

    Attributes:
        joint: what it is fixed to.
        mass: (n,) kg.
        center: (n, 3) m, its centre of mass in the joint's frame.
        rotation: (n, 3, 3) of the link's frame in the joint's.
        origin: (n, 3) m, of the link's frame there.
    """

    joint: int
    mass: Array
    center: Array
    rotation: Array
    origin: Array


@dataclass(frozen=True)
class Changes:
    """Other masses of n rovers; words as in `Masses`.

    Attributes:
        kg, scale: link or `robot` to (n,).
        com: link or `robot` to (n, 3) m.
        payload: (n,) kg and (n, 3) m in the root link's frame, on top of what is there.
    """

    kg: Mapping[str, Array] = field(default_factory=dict)
    scale: Mapping[str, Array] = field(default_factory=dict)
    com: Mapping[str, Array] = field(default_factory=dict)
    payload: Sequence[tuple[Array, Array]] = ()

    @property
    def links(self) -> tuple[str, ...]:
        """The links that are changed."""
        return tuple(name for name in {**self.kg, **self.scale, **self.com} if name != ROBOT)

    def __bool__(self) -> bool:
        """Whether anything is changed."""
        return bool(self.kg or self.scale or self.com or self.payload)

    def pick(self, which: NDArray[np.int64]) -> Changes:
        """Those of some rovers."""
        kg, scale, com = (
            {name: values[which] for name, values in each.items()} for each in (self.kg, self.scale, self.com)
        )
        return Changes(kg, scale, com, tuple((kgs[which], places[which]) for kgs, places in self.payload))

    @property
    def count(self) -> int:
        """n."""
        first = (*self.kg.values(), *self.scale.values(), *self.com.values(), *(kg for kg, _ in self.payload))
        return len(first[0]) if first else 1


def weigh_anew(
    masses: Array,
    moments: Array,
    bodies: Mapping[str, Body],
    root: str,
    payload: Sequence[Payload],
    changes: Changes,
) -> tuple[Array, Array, NDArray[np.bool_]]:
    """(n, j) kg, (n, j, 3) kg m, and whether there can be such a rover (n,); each row's bits are its own.

    Args:
        masses: (n or 1, j) kg, payload included.
        moments: (n or 1, j, 3) kg m in the joints' frames.
        bodies: the root link, the links that are changed, and those that carry payload.
        root: the root link's name.
        payload: what is on it already.
        changes: of n rovers.
    """
    count = max(len(masses), changes.count)
    mass = np.array(np.broadcast_to(masses, (count, masses.shape[1])))
    moment = np.array(np.broadcast_to(moments, (count, *moments.shape[1:])))
    seats = [(kg, *seat(place, root)) for kg, place in payload]
    carried = [(kg, bodies[link], np.array([point])) for kg, link, point in seats]
    for kg, body, place in carried:
        _put(mass, moment, body, -kg, place)
    own = {name: _own(mass, moment, bodies[name], name, changes) for name in changes.links}
    valid = np.ones(count, dtype=bool)
    for values in own.values():
        valid &= values >= 0.0
    factor = _factor(mass, changes)
    valid &= (factor > 0.0) & np.isfinite(factor)
    factor = np.where(valid, factor, 1.0)
    mass *= factor[:, None]
    moment *= factor[:, None, None]
    for name, offset in changes.com.items():
        body = bodies[root if name == ROBOT else name]
        moved = _sum(mass) if name == ROBOT else own[name] * factor
        moment[:, body.joint] += moved[:, None] * _turned(body.rotation, offset)
    for kg, body, place in carried:
        _put(mass, moment, body, kg, place)
    for kgs, places in changes.payload:
        valid &= kgs >= 0.0
        _put(mass, moment, bodies[root], kgs, places)
    valid &= _sum(mass) > 0.0
    empty = (mass <= NONE) & (np.abs(moment) > NONE).any(axis=2)
    return mass, moment, valid & ~empty.any(axis=1) & np.isfinite(moment).all(axis=(1, 2))


def _own(mass: Array, moment: Array, body: Body, name: str, changes: Changes) -> Array:
    """(n,) kg that a link weighs; its joint's mass and moment are changed."""
    before = np.broadcast_to(body.mass, (len(mass),))
    after = changes.kg.get(name, before * changes.scale.get(name, 1.0))
    more = after - before
    mass[:, body.joint] += more
    moment[:, body.joint] += more[:, None] * body.center
    return np.broadcast_to(after, (len(mass),))


def _factor(mass: Array, changes: Changes) -> Array:
    """(n,) on all masses."""
    factor = np.broadcast_to(changes.scale.get(ROBOT, np.ones(1)), (len(mass),))
    if ROBOT in changes.kg:
        total = _sum(mass)
        factor = changes.kg[ROBOT] / np.where(total > 0.0, total, np.nan)
    return factor


def _put(mass: Array, moment: Array, body: Body, kg: float | Array, place: Array) -> None:
    """Put a point mass at a place of a link."""
    mass[:, body.joint] += kg
    moment[:, body.joint] += np.reshape(kg, (-1, 1)) * (_turned(body.rotation, place) + body.origin)


def _sum(mass: Array) -> Array:
    """(n,) over the joints in their order, so that a row's bits are its own."""
    total = np.zeros(len(mass))
    for column in mass.T:
        total += column
    return total


def _turned(rotation: Array, vector: Array) -> Array:
    """(n, 3) R v, element by element."""
    result: Array = (
        rotation[:, :, 0] * vector[:, 0:1]
        + rotation[:, :, 1] * vector[:, 1:2]
        + rotation[:, :, 2] * vector[:, 2:3]
    )
    return result
