"""Energy stability margin, normalised (Messuri and Klein 1985; Hirose et al. 2001)."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from rover_pin.numerics import Array, formula, inlined
from rover_pin.stability.margin import Margin
from rover_pin.stability.measure import Measure, Standing


@inlined
def energy_height(
    ax: float, ay: float, az: float, bx: float, by: float, bz: float, cx: float, cy: float, cz: float
) -> float:
    """h = |R| (1 - cos theta) cos psi [m]: how far the point c rises before it tips over the edge a-b.

    R goes from the edge to c at right angles, psi is the edge's inclination, theta the angle about the edge
    from R to the plane through the edge that holds the vertical. Negative where c is past the edge: by how
    much it has fallen.
    """
    ex, ey, ez = bx - ax, by - ay, bz - az
    unit = 1.0 / math.sqrt(ex * ex + ey * ey + ez * ez)
    ex, ey, ez = ex * unit, ey * unit, ez * unit
    rx, ry, rz = cx - ax, cy - ay, cz - az
    along = rx * ex + ry * ey + rz * ez
    rx, ry, rz = rx - along * ex, ry - along * ey, rz - along * ez
    level = math.sqrt(ex * ex + ey * ey)
    # (1 - cos theta) from the sideways part: exact digits near the edge too
    sideways = (ex * ry - ey * rx) / level
    length = math.sqrt(rx * rx + ry * ry + rz * rz)
    upward = rz / level
    rise = sideways * sideways / (length + upward) if upward > 0.0 else length - upward
    sign = 0.0
    if sideways != 0.0:
        sign = 1.0 if sideways > 0.0 else -1.0
    return sign * rise * level


@formula
def energy_heights(starts: Array, ends: Array, com: Array) -> Array:
    """`energy_height` of every edge.

    Args:
        starts: (n, 3) m, corners counterclockwise from above.
        ends: (n, 3) m, the corner after each.
        com: (3,) m.

    Returns:
        (n,) m.
    """
    out = np.empty(starts.shape[0])
    for i in range(starts.shape[0]):
        a, b = starts[i], ends[i]
        out[i] = energy_height(a[0], a[1], a[2], b[0], b[1], b[2], com[0], com[1], com[2])
    return out


def evaluate(standing: Standing) -> Margin:
    """The least rise over the polygon's edges [m]; details hold the energy, m g h [J]."""
    com = standing.stance.com
    margin = MEASURE.on_polygon(standing, lambda starts, ends: energy_heights(starts, ends, com))
    if not margin.answered:
        return margin
    return replace(margin, details={"energy_j": margin.value * standing.stance.weight})


MEASURE = Measure("energy", "m", "high", 0.01, evaluate)
