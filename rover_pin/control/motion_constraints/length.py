"""How much further ahead of its wheels one side's hinge is."""

from __future__ import annotations

import numpy as np

from rover_pin.control.motion_constraints.constraint import MotionConstraint
from rover_pin.control.now import Now
from rover_pin.numerics import Array


class Length(MotionConstraint):
    """(x_left - x_right) / span (motion constraint 5): rockers that are unlike turn the body.

    x is how far a hinge is ahead of its side's second wheel's centre along the heading, less the same at
    home, span the distance between the hinges. It is taken from the wheels as the hinges sit on one body and
    are abreast of each other in its own axes, whatever the rockers do: if the second wheels stay where they
    are, the body turns by about this angle.
    """

    name = "length"
    number = 5
    unit = "1"
    kind = "posture"

    def value(self, now: Now) -> Array:
        """(1,) positive where the left hinge is further ahead of its wheels than the right one."""
        x = self.stations.at(now.at).ahead - self.stations.home_ahead
        return np.array([(x[0] - x[1]) / self.stations.span])

    def gradient(self, now: Now) -> Array:
        """(1, nv) per rad or m of q."""
        rows = self.stations.at(now.at).ahead_rows
        return (rows[:1] - rows[1:]) / self.stations.span


CONSTRAINT = Length
