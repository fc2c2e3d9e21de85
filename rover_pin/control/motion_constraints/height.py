"""How much higher one side's hinge is."""

from __future__ import annotations

import numpy as np

from rover_pin.control.motion_constraints.constraint import MotionConstraint
from rover_pin.control.now import Now
from rover_pin.numerics import Array


class Height(MotionConstraint):
    """(z_left - z_right) / span of the hinges (motion constraint 4): the sine of the roll of their line."""

    name = "height"
    number = 4
    unit = "1"
    kind = "posture"

    def value(self, now: Now) -> Array:
        """(1,) positive where the left hinge is higher."""
        z = self.stations.at(now.at).hinges[:, 2]
        return np.array([(z[0] - z[1]) / self.stations.span])

    def gradient(self, now: Now) -> Array:
        """(1, nv) per rad or m of q."""
        rows = self.stations.at(now.at).rise_rows
        return (rows[:1] - rows[1:]) / self.stations.span


CONSTRAINT = Height
