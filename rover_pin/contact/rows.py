"""Rows of contact points on the configuration, from the Jacobian of the joint that carries them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rover_pin.numerics import Array, formula


@formula
def contact_rows(
    jacobians: Array, origins: Array, owners: NDArray[np.int64], points: Array, normals: Array, basis: Array,
    motion: Array, force: Array,
) -> None:  # fmt: skip
    """Velocity of body-fixed points along the ground's normal and along the vertical.

    The velocity of a body's point p along d is [d, (p - o) x d] . J with J the 6-row Jacobian of the joint's
    origin o along world axes. Along the normal it is the gradient of the gap, along the vertical the
    generalised force of a unit load against gravity.

    Args:
        jacobians: (s, 6, nv) of the carriers.
        origins: (s, 3) m, world.
        owners: (m,) carrier of each point, as an index into `jacobians`.
        points: (m, 3) m, world.
        normals: (m, 3) unit, world.
        basis: (nv, n) of the free coordinates.
        motion: (>= m, n) receives the rows along the normals [m per unit coordinate].
        force: (>= m, n) receives the vertical rows [m per unit coordinate].
    """
    for i in range(points.shape[0]):
        owner = owners[i]
        rx = points[i, 0] - origins[owner, 0]
        ry = points[i, 1] - origins[owner, 1]
        rz = points[i, 2] - origins[owner, 2]
        x, y, z = normals[i, 0], normals[i, 1], normals[i, 2]
        tx, ty, tz = ry * z - rz * y, rz * x - rx * z, rx * y - ry * x
        motion[i] = 0.0
        force[i] = 0.0
        for v in range(basis.shape[0]):
            j = jacobians[owner, :, v]
            along = x * j[0] + y * j[1] + z * j[2] + tx * j[3] + ty * j[4] + tz * j[5]
            up = j[2] + ry * j[3] - rx * j[4]
            if along != 0.0 or up != 0.0:
                for c in range(basis.shape[1]):
                    motion[i, c] += along * basis[v, c]
                    force[i, c] += up * basis[v, c]
