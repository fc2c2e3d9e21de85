"""The largest difference of two wheels' loads."""

from __future__ import annotations

from rover_pin.control.motion_constraints.of_loads import OfLoads
from rover_pin.numerics import Array


class LoadDifference(OfLoads):
    """Wdiff = max W - min W over wheels in contact [N] (motion constraint 10)."""

    name = "load_difference"
    number = 10

    def statistic(self, loads: Array) -> float:
        """N."""
        return float(loads.max() - loads.min())


CONSTRAINT = LoadDifference
