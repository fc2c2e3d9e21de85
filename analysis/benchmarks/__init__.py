"""How quick rover_pin is here, beside its own plain path and the peers that are installed."""

from rover_pin.analysis.benchmarks.row import Row
from rover_pin.analysis.benchmarks.run import Report, bench

__all__ = ["Report", "Row", "bench"]
