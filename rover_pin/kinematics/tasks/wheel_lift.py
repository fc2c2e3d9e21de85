"""Wheels lifted off the ground or let down to it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rover_pin.errors import InputError
from rover_pin.kinematics.instant import Instant
from rover_pin.kinematics.rolling import contact_rows
from rover_pin.kinematics.rows import Aim, gain_between, number, weight


@dataclass(frozen=True)
class WheelLift:
    """Rate of a wheel's gap to the ground, or a gap to go to.

    Attributes:
        wheel: its name.
        rate: m/s, or None.
        height: m, or None.
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
        for word in ("rate", "height", "speed"):
            value = getattr(self, word)
            if value is not None:
                number(f"{self.name}: {word}", value)
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
        if self.rate is not None:
            target = self.rate
        else:
            way = self.gain * (float(self.height or 0.0) - float(at.contacts[which[0], 0])) / dt
            target = float(np.clip(way, -self.speed, self.speed))
        return Aim(contact_rows(at, which, ("normal",)), np.array([target]), np.array([self.weight]))
