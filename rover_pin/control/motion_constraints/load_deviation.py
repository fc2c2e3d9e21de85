"""How far one wheel's load is from the mean."""

from __future__ import annotations

from rover_pin.control.motion_constraints.of_loads import OfLoads
from rover_pin.numerics import Array


class LoadDeviation(OfLoads):
    """Wfmr = max(max W - mean W, mean W - min W) over wheels in contact [N] (motion constraint 11)."""

    name = "load_deviation"
    number = 11

    def statistic(self, loads: Array) -> float:
        """N."""
        mean = loads.mean()
        return float(max(loads.max() - mean, mean - loads.min()))


CONSTRAINT = LoadDeviation
