"""A sidecar to start from: what a URDF suggests, each guess commented out and marked with its reason."""

from rover_pin.description.starter.subject import Guess
from rover_pin.description.starter.write import Start, start

__all__ = ["Guess", "Start", "start"]
