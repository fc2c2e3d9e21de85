"""Distance of two wheels along the heading, and how it changes as a suspension is reshaped."""

from __future__ import annotations

import math

import numpy as np

from rover_pin.kinematics.instant import Instant
from rover_pin.numerics import Array


def heading_direction(at: Instant) -> Array:
    """(3,) unit, world: horizontal, along the root link's yaw."""
    return np.array([math.cos(at.heading), math.sin(at.heading), 0.0])


def wheelbase(at: Instant, front: str, rear: str) -> float:
    """Distance of two wheels' centres along the heading [m], positive where `front` is ahead.

    Raises:
        InputError: no wheel of that name.
    """
    ahead, behind = at.centers[at.index([front, rear])]
    return float((ahead - behind) @ heading_direction(at))


def wheelbase_row(at: Instant, front: str, rear: str) -> Array:
    """(nv,) its rate [m/s]; the heading's own turning counts where the wheels stand askew.

    Raises:
        InputError: no wheel of that name.
    """
    which = at.index([front, rear])
    along = heading_direction(at)
    joints, centers = at.bodies.packed.joints[which], at.centers[which]
    both = at.rows(joints, centers, np.tile(along, (2, 1)))
    row: Array = both[0] - both[1]
    ahead, behind = centers
    row[3] += float((ahead - behind) @ np.array([-along[1], along[0], 0.0]))
    return row
