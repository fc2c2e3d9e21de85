"""Force-angle measure (Papadopoulos and Rey 2000)."""

from __future__ import annotations

import numpy as np

from rover_pin.numerics import Array, formula
from rover_pin.stability.margin import Margin
from rover_pin.stability.measure import Measure, Standing


@formula
def force_angles(starts: Array, ends: Array, com: Array, weight: float) -> Array:
    """theta |d| |f_e| per edge.

    With e the edge's direction: l = (I - ee')(start - com), f_e = (I - ee') f, f the weight,
    theta the angle from f_e to l about e, positive inside, d = -l + (l . f^) f^ with f^ = f_e / |f_e|.

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
        e = ends[i] - starts[i]
        e = e / np.sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2])
        l = starts[i] - com  # noqa: E741
        along = l[0] * e[0] + l[1] * e[1] + l[2] * e[2]
        l = l - along * e  # noqa: E741
        f = e[2] * e
        f[2] -= 1.0
        pull = np.sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2])
        f = f / pull
        cross = (
            e[0] * (l[1] * f[2] - l[2] * f[1])
            + e[1] * (l[2] * f[0] - l[0] * f[2])
            + e[2] * (l[0] * f[1] - l[1] * f[0])
        )
        dot = l[0] * f[0] + l[1] * f[1] + l[2] * f[2]
        # |d| is the part of l across f, which is |l x f|
        out[i] = np.arctan2(cross, dot) * np.abs(cross) * pull * weight
    return out


def evaluate(standing: Standing) -> Margin:
    """The least force-angle measure over the polygon's edges [N m]; the force is the weight."""
    com, weight = standing.stance.com, standing.stance.weight
    return MEASURE.on_polygon(standing, lambda starts, ends: force_angles(starts, ends, com, weight))


MEASURE = Measure("force_angle", "N m", "high", 0.01, evaluate)
