"""Wheels lifted off the ground or let down to it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from rover_pin.errors import InputError
from rover_pin.kinematics.instant import Instant, Integers
from rover_pin.kinematics.rolling import contact_rows
from rover_pin.kinematics.rows import Aim, above, gain_between, number, weight
from rover_pin.numerics import Array

LANDING = 0.005
"""m: below this a wheel that is let down goes by its gap."""


@dataclass(frozen=True)
class WheelLift:
    """Rate of a wheel's height over the ground below it, or a height to go to.

    The height is that of the wheel's lowest point over the ground under its centre, so that a step beside the
    wheel does not count; for the last millimetres to 0 it is the gap that goes to 0.

    Attributes:
        wheel: its name.
        rate: m/s, or None.
        height: m over the ground below, or None.
        speed: m/s, at most on the way to the height.
        gain: share of the way that a step goes.
        weight: of a (m/s) squared.

    Raises:
        InputError: neither or both of rate and height, or something that is no finite number.
    """

    wheel: str
    rate: float | None = None
    height: float | None = None
    speed: float = 0.01
    gain: float = 0.2
    weight: float = 1.0

    def __post_init__(self) -> None:
        if (self.rate is None) == (self.height is None):
            raise InputError("needs a rate or a height, one of them", element=self.name)
        for word in ("rate", "height"):
            value = getattr(self, word)
            if value is not None:
                number(f"{self.name}: {word}", value)
        above(f"{self.name}: speed", self.speed)
        gain_between(f"{self.name}: gain", self.gain)
        weight(self.name, self.weight)

    @property
    def name(self) -> str:
        """What people read."""
        return f"lift of {self.wheel}"

    def aim(self, at: Instant, dt: float) -> Aim:
        """One row along the ground's normal.

        Raises:
            InputError: no wheel of that name.
        """
        which = at.index([self.wheel])
        here = height(at, int(which[0]))
        if self.height == 0.0 and here < LANDING:
            row, left = contact_rows(at, which, ("normal",)), -float(at.contacts[which[0], 0])
        else:
            row, left = height_row(at, which), (self.height or 0.0) - here
        target = self.rate
        if target is None:
            target = min(max(self.gain * left / dt, -self.speed), self.speed)
        return Aim(row, np.array([target]), np.array([self.weight]))


def height(at: Instant, place: int) -> float:
    """Of a wheel's lowest point over the ground under its centre [m]."""
    (x, y, z), shapes = at.centers[place], at.bodies.packed
    ring, tread = float(shapes.rings[place]), float(shapes.treads[place])
    lowest = z - ring * math.sqrt(max(1.0 - float(at.axes[place, 2]) ** 2, 0.0)) - tread
    return float(lowest - at.bodies.terrain.height(x, y))


def height_row(at: Instant, which: Integers) -> Array:
    """(k, nv) rate of `height` [m/s]: of the centre over the ground, and of the axis that leans."""
    centers, axes, joints = at.centers[which], at.axes[which], at.bodies.packed.joints[which]
    slope = np.asarray(at.bodies.terrain.gradient(centers[:, 0], centers[:, 1])).reshape(-1, 2)
    along = np.column_stack([-slope, np.ones(len(centers))])
    lean = at.bodies.packed.rings[which] * axes[:, 2] / np.sqrt(np.maximum(1.0 - axes[:, 2] ** 2, 1e-12))
    leaning = np.column_stack([axes[:, 1], -axes[:, 0], np.zeros(len(axes))])  # axis x up: how its z changes
    return at.rows(joints, centers, along) + lean[:, None] * at.turns(joints, leaning)
