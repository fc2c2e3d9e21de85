"""How fast one side rises against the other."""

from __future__ import annotations

import math

from rover_pin.control.motion_constraints.of_rates import OfRates
from rover_pin.control.now import Now
from rover_pin.numerics import Array


class RollRate(OfRates):
    """(v_left,z - v_right,z) / max(|v_b|, floor) (motion constraint 9).

    v_z are the hinges' velocities upwards, v_b the commanded horizontal velocity of the root link's origin.
    """

    name = "roll_rate"
    number = 9
    unit = "1"

    def rows(self, now: Now) -> Array:
        """(1, nv) s/m."""
        rows = self.stations.at(now.at).rise_rows
        speed = math.hypot(float(now.nominal[0]), float(now.nominal[1]))
        return (rows[:1] - rows[1:]) / max(speed, self.options.speed_floor)


CONSTRAINT = RollRate
