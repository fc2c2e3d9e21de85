"""A terrain as the kernels take it: one record, its table, and the bounds over its tiles."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rover_pin.compiled.bounds import HEIGHT, RINGS, STEEP, Tiles, tiles_of
from rover_pin.numerics import Array
from rover_pin.terrain import Terrain
from rover_pin.terrain.surface import PLANE, SMOOTH

Ground = Any
"""A record of GROUND."""

GroundArrays = tuple[NDArray[np.void], Array, Array, Tiles]
"""(1,) record, parameters, table and tiles."""

MOST_SIZES = 8
"""Sizes of shapes that a record has reaches for."""

MOST_REACHES = RINGS * MOST_SIZES + 1

GROUND = np.dtype(
    [
        ("kind", np.int64),  # as `rover_pin.terrain.surface` reads it
        ("spacing", np.float64),  # m, feature size
        ("extent", np.float64, 4),  # xmin, xmax, ymin, ymax [m]
        ("bounded", np.int64),  # whether the tiles bound anything
        ("side", np.float64),  # m, of a tile
        ("corner", np.float64, 2),  # m, the first tile's
        ("n_reaches", np.int64),
        ("reaches", np.float64, MOST_REACHES),  # m: RINGS for each size of shape, then the outlines'
    ],
    align=True,
)


def ground_of(terrain: Terrain, reaches: tuple[float, ...]) -> GroundArrays:
    """Record, parameters, table and tiles of a terrain; `rover_pin.compiled.bounds` has tiles and reaches.

    Args:
        terrain: the terrain.
        reaches: m, at most MOST_REACHES.
    """
    record = np.zeros(1, dtype=GROUND)
    record["kind"] = terrain.kind
    record["spacing"] = terrain.spacing
    record["extent"] = terrain.extent
    record["n_reaches"] = len(reaches)
    record["reaches"][0, : len(reaches)] = reaches
    tiles = np.zeros((len(reaches), 1, 1, 3), dtype=np.float32)
    if terrain.kind == PLANE:
        record["bounded"] = 1
        tiles[..., HEIGHT] = np.inf
        slope = np.float32(math.hypot(float(terrain.params[3]), float(terrain.params[4])))
        tiles[..., STEEP] = np.nextafter(slope, np.float32(np.inf))
    elif terrain.kind == SMOOTH:
        record["bounded"] = 1
        tiles, side = tiles_of(np.asarray(terrain.table), float(terrain.params[4]), reaches)
        record["side"] = side
        record["corner"] = terrain.params[2:4] - 0.5 * terrain.params[4]
    return record, terrain.params, terrain.table, tiles
