"""Readers of height maps: one format a file, registered by suffix."""

from rover_pin.terrain.readers.registry import HeightMap, read_heights, reader, suffixes

__all__ = ["HeightMap", "read_heights", "reader", "suffixes"]
