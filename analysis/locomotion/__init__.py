"""Figures of a drive from logged data, one idea a file."""

from rover_pin.analysis.locomotion.power import energy, mean_power, power
from rover_pin.analysis.locomotion.relative_error import relative_error
from rover_pin.analysis.locomotion.slip_ratio import slip_ratio
from rover_pin.analysis.locomotion.traction import traction_coefficient, traction_efficiency

__all__ = [
    "energy",
    "mean_power",
    "power",
    "relative_error",
    "slip_ratio",
    "traction_coefficient",
    "traction_efficiency",
]
