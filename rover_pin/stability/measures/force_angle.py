"""Force-angle measure (Papadopoulos and Rey 2000)."""

from __future__ import annotations

import math

import numpy as np

from rover_pin.numerics import Array, formula, inlined
from rover_pin.stability.margin import Margin
from rover_pin.stability.measure import Measure, Standing


@inlined
def force_angle(
    ax: float, ay: float, az: float, bx: float, by: float, bz: float, cx: float, cy: float, cz: float,
    weight: float,
) -> float:  # fmt: skip
    """theta |d| |f_e| [N m] of the edge a-b, for a weight [N] at c.

    With e the edge's direction: l = (I - ee')(a - c), f_e = (I - ee') f, f the weight, theta the angle from
    f_e to l about e, positive inside, d = -l + (l . f^) f^ with f^ = f_e / |f_e|.
    """
    ex, ey, ez = bx - ax, by - ay, bz - az
    unit = 1.0 / math.sqrt(ex * ex + ey * ey + ez * ez)
    ex, ey, ez = ex * unit, ey * unit, ez * unit
    lx, ly, lz = ax - cx, ay - cy, az - cz
    along = lx * ex + ly * ey + lz * ez
    lx, ly, lz = lx - along * ex, ly - along * ey, lz - along * ez
    fx, fy, fz = ez * ex, ez * ey, ez * ez - 1.0
    pull = math.sqrt(fx * fx + fy * fy + fz * fz)
    fx, fy, fz = fx / pull, fy / pull, fz / pull
    cross = ex * (ly * fz - lz * fy) + ey * (lz * fx - lx * fz) + ez * (lx * fy - ly * fx)
    dot = lx * fx + ly * fy + lz * fz
    # |d| is the part of l across f, which is |l x f|
    return math.atan2(cross, dot) * abs(cross) * pull * weight


@formula
def force_angles(starts: Array, ends: Array, com: Array, weight: float) -> Array:
    """`force_angle` of every edge.

    Args:
        starts: (n, 3) m, corners counterclockwise from above.
        ends: (n, 3) m, the corner after each.
        com: (3,) m.
        weight: N, downwards.

    Returns:
        (n,) N m.
    """
    out = np.empty(starts.shape[0])
    for i in range(starts.shape[0]):
        a, b = starts[i], ends[i]
        out[i] = force_angle(a[0], a[1], a[2], b[0], b[1], b[2], com[0], com[1], com[2], weight)
    return out


def evaluate(standing: Standing) -> Margin:
    """The least force-angle measure over the polygon's edges [N m]; the force is the weight."""
    com, weight = standing.stance.com, standing.stance.weight
    return MEASURE.on_polygon(standing, lambda starts, ends: force_angles(starts, ends, com, weight))


MEASURE = Measure("force_angle", "N m", "high", 0.01, evaluate)
