"""The belly's clearance: raised or lowered at a speed, or brought to a goal."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from rover_pin.errors import InputError
from rover_pin.kinematics.instant import Instant, Integers
from rover_pin.kinematics.rows import Aim, above, gain_between, number, weight
from rover_pin.numerics import Array
from rover_pin.terrain import surface


@dataclass(frozen=True)
class Clearance:
    """Mean height of the belly's points over the ground below them, as a rate or as a goal.

    Attributes:
        rate: m/s, or None.
        goal: m, or None.
        speed: m/s, at most on the way to the goal.
        gain: share of the way to the goal that a step goes.
        weight: of a (m/s) squared.
        name: what people read.

    Raises:
        InputError: neither or both of rate and goal, or something that is no finite number.
    """

    rate: float | None = None
    goal: float | None = None
    speed: float = 0.01
    gain: float = 0.2
    weight: float = 1.0
    name: str = "clearance"

    def __post_init__(self) -> None:
        if (self.rate is None) == (self.goal is None):
            raise InputError("needs a rate or a goal, one of them", element=self.name)
        for word in ("rate", "goal"):
            value = getattr(self, word)
            if value is not None:
                number(f"{self.name}: {word}", value)
        above(f"{self.name}: speed", self.speed)
        gain_between(f"{self.name}: gain", self.gain)
        weight(self.name, self.weight)

    def aim(self, at: Instant, dt: float) -> Aim:
        """One row.

        Raises:
            InputError: the rover declares no belly.
        """
        if self.rate is not None:
            target = self.rate
        else:
            way = self.gain * (float(self.goal or 0.0) - clearance(at)) / dt
            target = min(max(way, -self.speed), self.speed)
        return Aim(clearance_row(at)[None, :], np.array([target]), np.array([self.weight]))


def belly_points(at: Instant) -> Array:
    """(p, 3) m, world.

    Raises:
        InputError: the rover declares no belly.
    """
    return _under(at)[0]


def clearance(at: Instant) -> float:
    """Mean height of the belly's points over the ground [m]."""
    points, ground = _under(at)
    return float((points[:, 2] - ground[:, 0]) @ _belly(at).share)


def clearance_row(at: Instant) -> Array:
    """(nv,) rate of `clearance` [m/s]: the points' own, less the ground's slope times their way over it."""
    points, ground = _under(at)
    along = -ground[:, [1, 2, 0]]
    along[:, 2] = 1.0
    row: Array = _belly(at).share @ at.rows(_belly(at).joints, points, along)
    return row


def _under(at: Instant) -> tuple[Array, Array]:
    """The belly's points (p, 3) m, world; height [m] and slopes (p, 3) of the ground under them."""
    return at.once("belly", lambda: _look(at))


def _look(at: Instant) -> tuple[Array, Array]:
    placed, parts = at.placed, []
    for joint, points in _belly(at).groups:
        placement = placed[joint]
        parts.append(points @ placement.rotation.T + placement.translation)
    found = parts[0] if len(parts) == 1 else np.concatenate(parts)
    kind, table, params = at.bodies.terrain.kind, at.bodies.terrain.table, at.bodies.terrain.params
    return found, np.array([surface(kind, table, params, x, y)[:3] for x, y, _ in found.tolist()])


class _Belly(NamedTuple):
    """Points (p, 3) m of the belly in their joints' frames, by joint; joints and shares (p,)."""

    groups: list[tuple[int, Array]]
    joints: Integers
    share: Array


def _belly(at: Instant) -> _Belly:
    return at.bodies.once("belly", lambda: _find_belly(at))


def _find_belly(at: Instant) -> _Belly:
    belly = at.rover.belly
    if not belly:
        raise InputError(
            "a clearance needs belly points",
            file=at.rover.sidecar_path,
            element="belly",
            cure="declare `belly` in the sidecar",
        )
    joints = sorted({int(point.joint) for point in belly})
    groups = [(j, np.array([point.point for point in belly if point.joint == j])) for j in joints]
    count = len(belly)
    carriers = np.repeat(np.array(joints, dtype=np.int64), [len(points) for _, points in groups])
    return _Belly(groups, carriers, np.full(count, 1.0 / count))
