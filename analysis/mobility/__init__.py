"""Every place of a height map, in every heading: where a rover can stand, and how well."""

from rover_pin.analysis.mobility.run import mobility

__all__ = ["mobility"]
