"""The centre of mass at a place, or moving."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rover_pin.errors import InputError
from rover_pin.kinematics.instant import Instant
from rover_pin.kinematics.rows import Aim, above, gain_between, number, weight


@dataclass(frozen=True)
class CenterOfMass:
    """Draw the centre of mass to a place, world axes; None leaves an axis alone.

    Attributes:
        goal: x, y, z [m, world].
        gain: share of the way that a step goes.
        speed: m/s, at most.
        weight: of a (m/s) squared.
        name: what people read.

    Raises:
        InputError: not three entries, none of them a number, or a bad gain, speed or weight.
    """

    goal: Sequence[float | None]
    gain: float = 0.1
    speed: float = 0.05
    weight: float = 1.0
    name: str = "centre of mass"

    def __post_init__(self) -> None:
        if len(self.goal) != 3 or all(value is None for value in self.goal):
            raise InputError("needs x, y, z, one of them a number", element=self.name, value=tuple(self.goal))
        for axis, value in zip("xyz", self.goal, strict=True):
            if value is not None:
                number(f"{self.name}: {axis}", value)
        gain_between(f"{self.name}: gain", self.gain)
        above(f"{self.name}: speed", self.speed)
        weight(self.name, self.weight)

    def aim(self, at: Instant, dt: float) -> Aim:
        """A row an axis: gain (goal - c) / dt, cut to the speed."""
        asked = [i for i, value in enumerate(self.goal) if value is not None]
        goal = np.array([float(self.goal[i] or 0.0) for i in asked])
        wanted = self.gain * (goal - at.com[asked]) / dt
        target = np.clip(wanted, -self.speed, self.speed)
        return Aim(at.com_rows[asked], target, np.full(len(asked), self.weight))
