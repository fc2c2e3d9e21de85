"""Energy stability margin, normalised (Messuri and Klein 1985; Hirose et al. 2001)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from rover_pin.numerics import Array, formula
from rover_pin.stability.margin import Margin
from rover_pin.stability.measure import Measure, Standing


@formula
def energy_heights(starts: Array, ends: Array, com: Array) -> Array:
    """h = |R| (1 - cos theta) cos psi per edge: how far the centre of mass rises before it tips over.

    R goes from the edge to the centre of mass at right angles, psi is the edge's inclination, theta the
    angle about the edge from R to the plane through the edge that holds the vertical. Negative where the
    centre of mass is past the edge: by how much it has fallen.

    Args:
        starts: (n, 3) m, corners counterclockwise from above.
        ends: (n, 3) m, the corner after each.
        com: (3,) m.

    Returns:
        (n,) m.
    """
    out = np.empty(starts.shape[0])
    for i in range(starts.shape[0]):
        e = ends[i] - starts[i]
        e = e / np.sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2])
        r = com - starts[i]
        along = r[0] * e[0] + r[1] * e[1] + r[2] * e[2]
        r = r - along * e
        level = np.sqrt(e[0] * e[0] + e[1] * e[1])
        # (1 - cos theta) from the sideways part: exact digits near the edge too
        sideways = (e[0] * r[1] - e[1] * r[0]) / level
        length = np.sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2])
        upward = r[2] / level
        if upward > 0.0:
            rise = sideways * sideways / (length + upward)
        else:
            rise = length - upward
        out[i] = np.sign(sideways) * rise * level
    return out


def evaluate(standing: Standing) -> Margin:
    """The least rise over the polygon's edges [m]; details hold the energy, m g h [J]."""
    com = standing.stance.com
    margin = MEASURE.on_polygon(standing, lambda starts, ends: energy_heights(starts, ends, com))
    if not margin.answered:
        return margin
    return replace(margin, details={"energy_j": margin.value * standing.stance.weight})


MEASURE = Measure("energy", "m", "high", 0.01, evaluate)
