"""The support polygon inside compiled loops: the convex hull of a handful of points.

The plain path asks Qhull, which cannot be called from here; tests hold the two together.
"""

from __future__ import annotations

from rover_pin.compiled.posed import Integers
from rover_pin.numerics import Array, inlined

COLLINEAR = 1e-13
"""Share of the squared size: a corner that stands out less than this is none."""

FLAT = 1e-6
"""A polygon narrower than this share of its length is a line, as for `rover_pin.stability.support`."""


@inlined
def hull(points: Array, chosen: Integers, count: int, corners: Integers) -> int:
    """Corners counterclockwise from above (Andrew's monotone chain).

    Args:
        points: (s, >= 3) x and y in columns 1 and 2.
        chosen: (>= count,) rows of `points` to span; sorted on return.
        count: how many.
        corners: (>= 2 count,) receives rows of `points`.

    Returns:
        Number of corners; 0 where the points span no polygon.
    """
    if count < 3:
        return 0
    for i in range(1, count):
        k = chosen[i]
        j = i
        while j > 0 and _after(points, chosen[j - 1], k):
            chosen[j] = chosen[j - 1]
            j -= 1
        chosen[j] = k
    wide = points[chosen[count - 1], 1] - points[chosen[0], 1]
    low, high = points[chosen[0], 2], points[chosen[0], 2]
    for i in range(count):
        low, high = min(low, points[chosen[i], 2]), max(high, points[chosen[i], 2])
    size = max(wide, high - low)
    least = COLLINEAR * size * size
    n = 0
    for i in range(count):
        while n >= 2 and _area(points, corners[n - 2], corners[n - 1], chosen[i]) <= least:
            n -= 1
        corners[n] = chosen[i]
        n += 1
    lower = n + 1
    for i in range(count - 2, -1, -1):
        while n >= lower and _area(points, corners[n - 2], corners[n - 1], chosen[i]) <= least:
            n -= 1
        corners[n] = chosen[i]
        n += 1
    n -= 1
    double = 0.0
    for i in range(1, n - 1):
        double += _area(points, corners[0], corners[i], corners[i + 1])
    return n if n >= 3 and 0.5 * double > FLAT * size * size else 0


@inlined
def _after(points: Array, a: int, b: int) -> bool:
    """Whether row a comes after row b by x, then y."""
    return bool(points[a, 1] > points[b, 1] or (points[a, 1] == points[b, 1] and points[a, 2] > points[b, 2]))


@inlined
def _area(points: Array, a: int, b: int, c: int) -> float:
    """Twice the signed area of a triangle."""
    ux, uy = points[b, 1] - points[a, 1], points[b, 2] - points[a, 2]
    vx, vy = points[c, 1] - points[a, 1], points[c, 2] - points[a, 2]
    area: float = ux * vy - uy * vx
    return area
