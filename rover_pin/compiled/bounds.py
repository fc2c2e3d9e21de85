"""How high, steep and hollow the ground can be around a place: bounds over tiles, worked out once a map.

Between two nodes the biquadratic spline's second derivatives along x or y are means of second differences of
coefficients, the mixed one a mean of mixed differences, the first ones of first differences, the height of
coefficients: their extremes over a cell's 3 x 3 coefficients bound them (the B-spline's convex hull property).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from scipy.ndimage import maximum_filter

from rover_pin.numerics import Array, inlined

MOST_TILES = 4_000_000

HEIGHT, HOLLOW, STEEP = range(3)
"""m; 1/m, the largest second derivative in any direction; the largest slope."""


def tiles_of(c: Array, spacing: float, reaches: tuple[float, ...]) -> tuple[Array, float]:
    """Bounds over squares of a smooth map, each for all within a reach of any point of the square.

    Args:
        c: (rows + 2, columns + 2) m, the spline's coefficients.
        spacing: m.
        reaches: m.

    Returns:
        (3, reaches, rows, columns) of HEIGHT, HOLLOW and STEEP, the first tile's corner half a spacing before
        the first node; the tiles' side [m].
    """
    cells = _of_cells(c, spacing)
    rows, columns = cells[0].shape
    share = max(1, math.ceil(math.sqrt(rows * columns * len(reaches) / MOST_TILES)))
    side = share * spacing
    wide = [
        [_dilated(part, reach / side) for reach in reaches] for part in (_coarser(c, share) for c in cells)
    ]
    return np.array(wide), side


def _of_cells(c: Array, spacing: float) -> tuple[Array, Array, Array]:
    """Height, hollow and slope bounds (rows, columns) of each node's cell, half a spacing around it.

    Args:
        c: (rows + 2, columns + 2) m, coefficients.
        spacing: m.
    """
    k = 1.0 / spacing
    height = maximum_filter(c, size=3)[1:-1, 1:-1]
    xx = _of_three(c[:, 2:] - 2.0 * c[:, 1:-1] + c[:, :-2], 0)
    yy = _of_three(c[2:] - 2.0 * c[1:-1] + c[:-2], 1)
    mixed = np.abs(c[1:, 1:] - c[1:, :-1] - c[:-1, 1:] + c[:-1, :-1])
    xy = np.maximum(np.maximum(mixed[1:, 1:], mixed[1:, :-1]), np.maximum(mixed[:-1, 1:], mixed[:-1, :-1]))
    along, across = np.abs(np.diff(c, axis=1)), np.abs(np.diff(c, axis=0))
    dx = _of_three(np.maximum(along[:, 1:], along[:, :-1]), 0)
    dy = _of_three(np.maximum(across[1:], across[:-1]), 1)
    return height, k * k * (np.maximum(xx, yy) + xy), k * np.hypot(dx, dy)


def _of_three(values: Array, axis: int) -> Array:
    """Largest of three neighbours along an axis, which no mean of them exceeds; two entries fewer."""
    v = np.moveaxis(values, axis, 0)
    result: Array = np.moveaxis(np.maximum(np.maximum(v[2:], v[1:-1]), v[:-2]), 0, axis)
    return result


def _coarser(part: Array, share: int) -> Array:
    """Largest entries of squares of `share` cells a side."""
    if share == 1:
        return part
    rows, columns = (-(-size // share) for size in part.shape)
    padded = np.full((rows * share, columns * share), -np.inf)
    padded[: part.shape[0], : part.shape[1]] = part
    blocks = padded.reshape(rows, share, columns, share)
    return np.ascontiguousarray(blocks.max(axis=(1, 3)))


def _dilated(part: Array, reach: float) -> Array:
    """Largest entry within `reach` tiles of any point of a tile."""
    result: Array = maximum_filter(part, size=2 * math.ceil(reach) + 1, mode="nearest")
    return result


@inlined
def tile(ground: Any, tiles: Array, x: float, y: float) -> tuple[int, int]:
    """Row and column of the tile that holds (x, y), or the nearest one: beyond a map its border goes on."""
    rows, columns = tiles.shape[2], tiles.shape[3]
    if rows == 1 and columns == 1:
        return 0, 0
    u, v = (x - ground.corner[0]) / ground.side, (y - ground.corner[1]) / ground.side
    return int(min(max(v, 0.0), rows - 1.0)), int(min(max(u, 0.0), columns - 1.0))


@inlined
def touches_once(
    ground: Any, tiles: Array, r: int, cx: float, cy: float, az: float, ring: float, tread: float, gap: float
) -> bool:
    """Whether a ring-shaped skin can face the ground in one place only, so that a contact found is the least.

    Skin points whose slope is at most the ground's greatest slope tan(beta) lie within beta of straight down;
    there the skin's principal curvatures are at least 1 / (ring / cos(alpha + beta) + tread), alpha being the
    axis's inclination, and so are its second derivatives as a function over the plane. Where the ground's are
    less, two places with equal slopes would need a displacement d with d'H d both less and more than
    |d|^2 / that radius. Beyond those skin points the skin rises more steeply than the ground. A skin that
    hovers is as one grown by its gap.

    Args:
        ground: the surface's record.
        tiles: its bounds.
        r: which reach.
        cx: centre, m.
        cy: centre, m.
        az: z component of the unit axis.
        ring: ring's radius, m.
        tread: ball's radius, m.
        gap: of the contact found, m.
    """
    grown = tread + max(gap, 0.0)
    if ground.bounded == 0 or ring + grown > ground.reaches[r]:
        return False
    i, j = tile(ground, tiles, cx, cy)
    slope, hollow = tiles[2, r, i, j], tiles[1, r, i, j]
    if ring == 0.0:
        return hollow * grown < 0.98
    level = math.sqrt(max(1.0 - az * az, 0.0))
    cosine = (level - abs(az) * slope) / math.sqrt(1.0 + slope * slope)
    if cosine < 0.1:
        return False
    return hollow * (ring / cosine + grown) < 0.98
