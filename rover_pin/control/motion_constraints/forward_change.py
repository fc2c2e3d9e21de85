"""How much the rockers change the body's forward speed."""

from __future__ import annotations

import numpy as np

from rover_pin.control.motion_constraints.of_rates import ChangeOfRates
from rover_pin.control.now import Now
from rover_pin.numerics import Array


class ForwardChange(ChangeOfRates):
    """dv_bx / max(|v_bx|, floor) (motion constraint 7).

    v_bx is the commanded velocity of the root link's origin along the heading, dv_bx what the velocity looked
    at has more of it.
    """

    name = "forward_change"
    number = 7
    unit = "1"

    def rows(self, now: Now) -> Array:
        """(1, nv) s/m."""
        row = np.zeros((1, len(now.v)))
        row[0, :2] = self.stations.at(now.at).heading[:2]
        return row / max(abs(float(row[0] @ now.nominal)), self.options.speed_floor)


CONSTRAINT = ForwardChange
