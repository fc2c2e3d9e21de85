"""Two or more designs side by side on the same cases."""

from rover_pin.analysis.comparison.design import Design
from rover_pin.analysis.comparison.result import Comparison
from rover_pin.analysis.comparison.run import compare, paired

__all__ = ["Comparison", "Design", "compare", "paired"]
