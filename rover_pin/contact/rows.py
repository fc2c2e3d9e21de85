"""Rows of contact points on the configuration, from the Jacobian of the joint that carries them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rover_pin.numerics import Array, formula


@formula
def contact_rows(
    jacobians: Array,
    origins: Array,
    owners: NDArray[np.int64],
    points: Array,
    directions: Array,
    basis: Array,
) -> Array:
    """Velocity of body-fixed points along given directions, as rows on the free coordinates.

    The velocity of a body's point p along d is [d, (p - o) x d] . J with J the 6-row Jacobian of the joint's
    origin o along world axes.

    Args:
        jacobians: (s, 6, nv) of the carriers.
        origins: (s, 3) m, world.
        owners: (m,) carrier of each point, as an index into `jacobians`.
        points: (m, 3) m, world.
        directions: (m, 3) world.
        basis: (nv, n) of the free coordinates.

    Returns:
        (m, n) [m per unit coordinate].
    """
    m = points.shape[0]
    nv = basis.shape[0]
    n = basis.shape[1]
    rows = np.zeros((m, n))
    wrench = np.zeros(6)
    for i in range(m):
        owner = owners[i]
        rx = points[i, 0] - origins[owner, 0]
        ry = points[i, 1] - origins[owner, 1]
        rz = points[i, 2] - origins[owner, 2]
        dx, dy, dz = directions[i, 0], directions[i, 1], directions[i, 2]
        wrench[0], wrench[1], wrench[2] = dx, dy, dz
        wrench[3] = ry * dz - rz * dy
        wrench[4] = rz * dx - rx * dz
        wrench[5] = rx * dy - ry * dx
        for v in range(nv):
            value = 0.0
            for k in range(6):
                value += wrench[k] * jacobians[owner, k, v]
            if value != 0.0:
                for c in range(n):
                    rows[i, c] += value * basis[v, c]
    return rows
