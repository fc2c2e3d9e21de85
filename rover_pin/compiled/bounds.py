"""How high, steep and hollow the ground can be around a place: bounds over tiles, worked out once a map.

Between two nodes the biquadratic spline's second derivatives along x or y are means of second differences of
coefficients, the mixed one a mean of mixed differences, the first ones of first differences, the height of
coefficients: their extremes over a cell's 3 x 3 coefficients bound them (convex hull property of B-splines).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter

from rover_pin.numerics import Array, inlined

Tiles = NDArray[np.float32]

MOST_TILES = 4_000_000

RINGS = 4
"""Reaches of every size of shape: the ground's hollows near a contact count more than those farther off."""

SHARES = (0.35, 0.7, 1.1, 1.6)
"""Those reaches, over the shape's size."""

SURE = 0.98
"""Share of the skin's curvature that counts."""

HEIGHT, HOLLOW, STEEP = range(3)
"""m; 1/m, the largest second derivative in any direction; the largest slope."""


def tiles_of(c: Array, spacing: float, reaches: tuple[float, ...]) -> tuple[Tiles, float]:
    """Bounds over squares of a smooth map, each for all within a reach of any point of the square.

    Args:
        c: (rows + 2, columns + 2) m, the spline's coefficients.
        spacing: m.
        reaches: m.

    Returns:
        (reaches, rows, columns, 3) float32 of HEIGHT, HOLLOW and STEEP, rounded upwards, the first tile's
        corner half a spacing before the first node; and the tiles' side [m].
    """
    fine = _of_cells(c, spacing)
    rows, columns = fine[0].shape
    share = max(1, math.ceil(math.sqrt(rows * columns * len(reaches) / MOST_TILES)))
    side = share * spacing
    cells = [_coarser(part, share) for part in fine]
    wide = [[_dilated(part, reach / side) for part in cells] for reach in reaches]
    packed = np.ascontiguousarray(np.moveaxis(np.array(wide), 1, 3), dtype=np.float32)
    return np.nextafter(packed, np.float32(np.inf)), side


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
    half = 0.5 * (xx - yy)
    hollow = 0.5 * (xx + yy) + np.sqrt(half * half + xy * xy)  # grows with xx, yy and |xy|
    return height, k * k * hollow, k * np.hypot(dx, dy)


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
def tile(ground: Any, tiles: Tiles, x: float, y: float) -> tuple[int, int]:
    """Row and column of the tile that holds (x, y), or the nearest one: beyond a map its border goes on."""
    rows, columns = tiles.shape[1], tiles.shape[2]
    if rows == 1 and columns == 1:
        return 0, 0
    u, v = (x - ground.corner[0]) / ground.side, (y - ground.corner[1]) / ground.side
    return int(min(max(v, 0.0), rows - 1.0)), int(min(max(u, 0.0), columns - 1.0))


@inlined
def sure_within(
    ground: Any, tiles: Tiles, r: int, x: float, y: float, off: float, az: float, ring: float, tread: float,
    gap: float,
) -> float:  # fmt: skip
    """How far around a contact the skin is known to come no nearer to the ground; infinite where everywhere.

    Skin points whose slope is at most the ground's greatest slope tan(beta) lie within beta of straight down;
    there the skin's principal curvatures are at least 1 / R with R = ring / cos(alpha + beta) + tread, alpha
    being the axis's inclination, and so are its second derivatives as a function over the plane. Over a
    segment of length l from the contact, along which the ground's second derivative is at most k(r) at
    distance r, the skin rises above the ground by at least l^2 / 2 R less the integral of (l - r) k(r).
    Beyond those skin points it rises more steeply than the ground. A skin that hovers is as one
    grown by its gap.

    Args:
        ground: the surface's record.
        tiles: its bounds.
        r: the first of the shape's RINGS reaches.
        x: of the contact, m.
        y: of the contact, m.
        off: horizontal distance from the contact to the shape's centre, m.
        az: z component of the unit axis.
        ring: ring's radius, m.
        tread: ball's radius, m.
        gap: of the contact found, m.
    """
    grown = tread + max(gap, 0.0)
    longest = off + ring + grown
    last = r + RINGS - 1
    if ground.bounded == 0 or longest > ground.reaches[last]:
        return 0.0
    i, j = tile(ground, tiles, x, y)
    slope = 1.25 * tiles[last, i, j, STEEP] + 0.05
    level = math.sqrt(max(1.0 - az * az, 0.0))
    cosine = (level - abs(az) * slope) / math.sqrt(1.0 + slope * slope) if ring > 0.0 else 1.0
    if cosine < 0.1:
        return 0.0
    stiff = SURE / (ring / cosine + grown)
    if tiles[last, i, j, HOLLOW] < stiff:
        return math.inf
    # by rings: k(r) is constant between reaches, and what is left over is least at one of them
    before, slant, rise = 0.0, 0.0, 0.0
    for k in range(r, r + RINGS):
        reach = min(ground.reaches[k], longest)
        wide = reach - before
        rate = stiff - tiles[k, i, j, HOLLOW]
        rise += (slant + 0.5 * rate * wide) * wide
        slant += rate * wide
        if rise <= 0.0:
            return before
        before = reach
    return math.inf
