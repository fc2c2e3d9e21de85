"""Figures of a drive from logged data, one a file."""

from rover_pin.analysis.locomotion.relative_error import relative_error

__all__ = ["relative_error"]
