"""Studies: many cases of one question, run by an engine, answered as one labelled Dataset."""

from rover_pin.analysis.mobility import mobility
from rover_pin.analysis.search import search
from rover_pin.analysis.sensitivity import sensitivity
from rover_pin.analysis.slopes import slopes
from rover_pin.analysis.study import Study
from rover_pin.analysis.traverse import LargestStep, largest_step, traverse

__all__ = [
    "LargestStep",
    "Study",
    "largest_step",
    "mobility",
    "search",
    "sensitivity",
    "slopes",
    "traverse",
]
