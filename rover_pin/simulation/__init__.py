"""Motion in time: what a controller and the ground make of a rover, step by step."""

from rover_pin.simulation.quasi_static import Setting, simulate
from rover_pin.simulation.run import Run

__all__ = ["Run", "Setting", "simulate"]
