"""Zero-moment point: where the ground's forces act as one, against the polygon's nearest edge."""

from __future__ import annotations

import numpy as np

from rover_pin.numerics import Array, formula
from rover_pin.stability.margin import Margin
from rover_pin.stability.measure import Measure, Standing
from rover_pin.stability.measures.polygon import edge_distances


@formula
def zero_moment_point(points: Array, loads: Array) -> Array:
    """n x M0 / (f . n), n upwards: where vertical forces' moment has no horizontal part.

    Args:
        points: (k, 3) m, contact points.
        loads: (k,) N, forces against gravity at them.

    Returns:
        (2,) m, x and y; not finite where the loads add up to nothing.
    """
    force, about_x, about_y = 0.0, 0.0, 0.0
    for i in range(points.shape[0]):
        force += loads[i]
        about_x += points[i, 1] * loads[i]
        about_y -= points[i, 0] * loads[i]
    out = np.empty(2)
    out[0] = -about_y / force
    out[1] = about_x / force
    return out


def evaluate(standing: Standing) -> Margin:
    """Signed distance of the zero-moment point from the polygon's nearest edge [m].

    It comes from the contact forces and their moment, not from the centre of mass; at rest both points
    are the same, so a difference from `polygon` shows loads that are not in equilibrium.
    """
    contacts = standing.stance.contacts
    if not contacts:
        return MEASURE.closed("0 contacts span no polygon")
    point = zero_moment_point(np.array([c.point for c in contacts]), np.array([c.load for c in contacts]))
    return MEASURE.on_polygon(standing, lambda starts, ends: edge_distances(starts, ends, point))


MEASURE = Measure("zmp", "m", "high", 0.01, evaluate)
