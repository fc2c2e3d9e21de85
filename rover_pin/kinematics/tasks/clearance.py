"""The belly's clearance: raised or lowered at a speed, or brought to a goal."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rover_pin.errors import InputError
from rover_pin.kinematics.instant import Instant
from rover_pin.kinematics.rows import Aim, gain_between, number, weight
from rover_pin.numerics import Array


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
        for word in ("rate", "goal", "speed"):
            value = getattr(self, word)
            if value is not None:
                number(f"{self.name}: {word}", value)
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
            target = float(np.clip(way, -self.speed, self.speed))
        return Aim(clearance_row(at)[None, :], np.array([target]), np.array([self.weight]))


def belly_points(at: Instant) -> Array:
    """(p, 3) m, world.

    Raises:
        InputError: the rover declares no belly.
    """
    belly = at.rover.belly
    if not belly:
        raise InputError(
            "a clearance needs belly points",
            file=at.rover.sidecar_path,
            element="belly",
            cure="declare `belly` in the sidecar",
        )
    placed = at.placed
    return np.array(
        [placed[p.joint].rotation @ np.asarray(p.point) + placed[p.joint].translation for p in belly]
    )


def clearance(at: Instant, points: Sequence[int] | None = None) -> float:
    """Mean height of the belly's points over the ground [m]; of some of them where `points` says so."""
    found = belly_points(at)[list(points) if points is not None else slice(None)]
    return float(np.mean(found[:, 2] - at.bodies.terrain.height(found[:, 0], found[:, 1])))


def clearance_row(at: Instant) -> Array:
    """(nv,) rate of `clearance` [m/s]: the points' own, less the ground's slope times their way over it."""
    found = belly_points(at)
    slope = np.asarray(at.bodies.terrain.gradient(found[:, 0], found[:, 1])).reshape(-1, 2)
    along = np.column_stack([-slope, np.ones(len(found))])
    joints = np.array([point.joint for point in at.rover.belly], dtype=np.int64)
    rows: Array = at.rows(joints, found, along).mean(axis=0)
    return rows
