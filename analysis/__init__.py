"""Studies: many cases of one question, run by an engine, answered as one labelled Dataset."""

from rover_pin.analysis.chances import probabilities
from rover_pin.analysis.comparison import Comparison, Design, compare, paired
from rover_pin.analysis.indices import sobol_indices
from rover_pin.analysis.mobility import mobility
from rover_pin.analysis.search import search
from rover_pin.analysis.sensitivity import sensitivity
from rover_pin.analysis.slopes import slopes
from rover_pin.analysis.study import Study
from rover_pin.analysis.traverse import LargestStep, largest_step, traverse

__all__ = [
    "Comparison",
    "Design",
    "LargestStep",
    "Study",
    "compare",
    "largest_step",
    "mobility",
    "paired",
    "probabilities",
    "search",
    "sensitivity",
    "slopes",
    "sobol_indices",
    "traverse",
]
