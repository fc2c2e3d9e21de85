"""Joints stay within their limits of place."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rover_pin.kinematics.instant import Instant
from rover_pin.kinematics.rows import gain_between
from rover_pin.numerics import Array


@dataclass(frozen=True)
class JointLimits:
    """A step goes at most `gain` of what is left to a limit; a joint beyond it may only come back.

    Attributes:
        gain: in (0, 1].

    Raises:
        InputError: a gain outside.
    """

    gain: float = 0.5

    def __post_init__(self) -> None:
        gain_between("joint limits: gain", self.gain)

    def box(self, at: Instant, dt: float) -> tuple[Array, Array]:
        """(nv,) each: gain (limit - q) / dt, never away from a limit passed."""
        rover = at.rover
        share = self.gain / dt
        return np.minimum(share * (rover.lower - at.q), 0.0), np.maximum(share * (rover.upper - at.q), 0.0)

    def bound_name(self, dof: str, upper: bool) -> str:
        """What people read."""
        return f"{'upper' if upper else 'lower'} limit of {dof}"
