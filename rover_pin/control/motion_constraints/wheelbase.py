"""How much of the distance between front and second wheel the arms have taken."""

from __future__ import annotations

from rover_pin.control.motion_constraints.constraint import MotionConstraint
from rover_pin.control.now import Now
from rover_pin.numerics import Array


class Wheelbase(MotionConstraint):
    """(d0 - d_fm) / d0 of each side (motion constraint 3), so that the two wheels do not collide.

    d_fm is how far the front wheel's centre is ahead of the second one's along the heading, d0 the same at
    home. The divisor is an option (`Options.wheelbase_divisor`), as the paper divides by a wheelbase that its
    own arms cannot have.
    """

    name = "wheelbase"
    number = 3
    unit = "1"
    kind = "posture"
    by_side = True

    @property
    def divisor(self) -> Array | float:
        """M: of each side, or of both."""
        given = self.options.wheelbase_divisor
        return self.stations.home if given is None else given

    def value(self, now: Now) -> Array:
        """(2,) positive where the wheels have come closer."""
        taken: Array = (self.stations.home - self.stations.at(now.at).apart) / self.divisor
        return taken

    def gradient(self, now: Now) -> Array:
        """(2, nv) per rad or m of q."""
        rows = -self.stations.at(now.at).apart_rows
        return (rows.T / self.divisor).T


CONSTRAINT = Wheelbase
