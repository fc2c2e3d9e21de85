"""A rover driven along a line: loads, friction, torque, margins and posture, and where it stops."""

from rover_pin.analysis.traverse.largest_step import LargestStep, largest_step
from rover_pin.analysis.traverse.run import traverse

__all__ = ["LargestStep", "largest_step", "traverse"]
