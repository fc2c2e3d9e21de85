"""Tip angle: how far the ground may tilt before the centre of mass passes over an edge."""

from __future__ import annotations

import numpy as np

from rover_pin.numerics import Array, formula
from rover_pin.stability.margin import Margin
from rover_pin.stability.measure import Measure, Standing


@formula
def tip_angles(starts: Array, ends: Array, com: Array) -> Array:
    """atan2(distance to the edge, height over the edge), both as gravity sees them; positive inside.

    The height is that over the point of the edge's line beside the centre of mass.

    Args:
        starts: (n, 3) m, corners counterclockwise from above.
        ends: (n, 3) m, the corner after each.
        com: (3,) m.

    Returns:
        (n,) rad.
    """
    out = np.empty(starts.shape[0])
    for i in range(starts.shape[0]):
        ex, ey, ez = ends[i, 0] - starts[i, 0], ends[i, 1] - starts[i, 1], ends[i, 2] - starts[i, 2]
        cx, cy = com[0] - starts[i, 0], com[1] - starts[i, 1]
        length = np.hypot(ex, ey)
        distance = (ex * cy - ey * cx) / length
        height = com[2] - starts[i, 2] - ez * (ex * cx + ey * cy) / (length * length)
        out[i] = np.arctan2(distance, height)
    return out


def evaluate(standing: Standing) -> Margin:
    """The least tip angle over the polygon's edges [rad]."""
    com = standing.stance.com
    return MEASURE.on_polygon(standing, lambda starts, ends: tip_angles(starts, ends, com))


MEASURE = Measure("tip", "rad", "high", 0.01, evaluate)
