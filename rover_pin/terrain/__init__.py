"""Terrain: height, gradient and normal of one surface, whoever asks."""

from rover_pin.terrain.summary import Summary
from rover_pin.terrain.surface import CALLABLE, LINEAR, PLANE, SMOOTH, surface
from rover_pin.terrain.terrain import Terrain

__all__ = ["CALLABLE", "LINEAR", "PLANE", "SMOOTH", "Summary", "Terrain", "surface"]
