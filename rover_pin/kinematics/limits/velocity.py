"""Joints stay within their speeds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from rover_pin.errors import InputError
from rover_pin.kinematics.instant import Instant
from rover_pin.kinematics.rows import columns
from rover_pin.numerics import Array


@dataclass(frozen=True)
class SpeedLimits:
    """The URDF's velocity limits, some of them replaced.

    Attributes:
        most: rad/s or m/s, by name of `Rover.dof_names`, in place of the URDF's.

    Raises:
        InputError: a speed that is not above 0.
    """

    most: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name, value in self.most.items():
            if not value > 0.0:
                raise InputError("a speed limit is above 0", element=f"speed of {name}", value=value)
        object.__setattr__(self, "most", dict(self.most))

    def box(self, at: Instant, dt: float) -> tuple[Array, Array]:
        """(nv,) each.

        Raises:
            InputError: an unknown coordinate.
        """
        if not self.most:
            return -at.rover.velocity, at.rover.velocity
        speeds = np.array(at.rover.velocity)
        speeds[columns(at, "speed limits", tuple(self.most))] = list(self.most.values())
        return -speeds, speeds

    def bound_name(self, dof: str, upper: bool) -> str:
        """What people read."""
        return f"speed of {dof}"
