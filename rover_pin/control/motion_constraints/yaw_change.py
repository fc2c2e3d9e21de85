"""How much the rockers change the body's rate of turning."""

from __future__ import annotations

import numpy as np

from rover_pin.control.motion_constraints.of_rates import ChangeOfRates
from rover_pin.control.now import Now
from rover_pin.control.stations import YAW
from rover_pin.numerics import Array


class YawChange(ChangeOfRates):
    """dw_bz / max(|w_bz|, floor) (motion constraint 8).

    w_bz is the commanded rate of the heading, dw_bz what the velocity looked at has more of it.
    """

    name = "yaw_change"
    number = 8
    unit = "1"

    def rows(self, now: Now) -> Array:
        """(1, nv) s/rad."""
        row = np.zeros((1, len(now.v)))
        row[0, YAW] = 1.0 / max(abs(float(now.nominal[YAW])), self.options.yaw_floor)
        return row


CONSTRAINT = YawChange
