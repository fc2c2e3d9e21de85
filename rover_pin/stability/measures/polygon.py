"""Support polygon margin: how far inside the polygon the centre of mass lies (McGhee and Frank 1968)."""

from __future__ import annotations

import math

import numpy as np

from rover_pin.numerics import Array, formula, inlined
from rover_pin.stability.margin import Margin
from rover_pin.stability.measure import Measure, Standing


@inlined
def edge_distance(ax: float, ay: float, bx: float, by: float, x: float, y: float) -> float:
    """Distance [m] of (x, y) from the line a-b in the plane across gravity, positive to the left of it."""
    ex, ey = bx - ax, by - ay
    return (ex * (y - ay) - ey * (x - ax)) / math.hypot(ex, ey)


@formula
def edge_distances(starts: Array, ends: Array, point: Array) -> Array:
    """Distance of a point from each edge's line in the plane across gravity, positive inside.

    n . (point - start), n the unit vector across the edge to its left in the horizontal plane.

    Args:
        starts: (n, 3) m, corners counterclockwise from above.
        ends: (n, 3) m, the corner after each.
        point: (3,) or (2,) m.

    Returns:
        (n,) m.
    """
    out = np.empty(starts.shape[0])
    for i in range(starts.shape[0]):
        out[i] = edge_distance(starts[i, 0], starts[i, 1], ends[i, 0], ends[i, 1], point[0], point[1])
    return out


def evaluate(standing: Standing) -> Margin:
    """The least distance of the centre of mass, seen along gravity, from the polygon's edges [m]."""
    com = standing.stance.com
    return MEASURE.on_polygon(standing, lambda starts, ends: edge_distances(starts, ends, com))


MEASURE = Measure("polygon", "m", "high", 0.01, evaluate)
