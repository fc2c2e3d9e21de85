"""Tip angle: how far the ground may tilt before the centre of mass passes over an edge."""

from __future__ import annotations

import math

import numpy as np

from rover_pin.numerics import Array, formula, inlined
from rover_pin.stability.margin import Margin
from rover_pin.stability.measure import Measure, Standing


@inlined
def tip_angle(
    ax: float, ay: float, az: float, bx: float, by: float, bz: float, cx: float, cy: float, cz: float
) -> float:
    """Angle [rad] by which the ground may tilt about the edge a-b before the point c stands over it.

    atan2(distance to the edge, height over the point of its line beside c), both as gravity sees them.
    """
    ex, ey, ez = bx - ax, by - ay, bz - az
    rx, ry = cx - ax, cy - ay
    length = math.hypot(ex, ey)
    distance = (ex * ry - ey * rx) / length
    height = cz - az - ez * (ex * rx + ey * ry) / (length * length)
    return math.atan2(distance, height)


@formula
def tip_angles(starts: Array, ends: Array, com: Array) -> Array:
    """`tip_angle` of every edge, positive inside.

    Args:
        starts: (n, 3) m, corners counterclockwise from above.
        ends: (n, 3) m, the corner after each.
        com: (3,) m.

    Returns:
        (n,) rad.
    """
    out = np.empty(starts.shape[0])
    for i in range(starts.shape[0]):
        a, b = starts[i], ends[i]
        out[i] = tip_angle(a[0], a[1], a[2], b[0], b[1], b[2], com[0], com[1], com[2])
    return out


def evaluate(standing: Standing) -> Margin:
    """The least tip angle over the polygon's edges [rad]."""
    com = standing.stance.com
    return MEASURE.on_polygon(standing, lambda starts, ends: tip_angles(starts, ends, com))


MEASURE = Measure("tip", "rad", "high", 0.01, evaluate)
