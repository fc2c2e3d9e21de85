"""Rows of contact points on the configuration, from the columns of the tree that carries them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rover_pin.mechanism.columns import speed
from rover_pin.numerics import Array, formula


@formula
def contact_rows(
    parent: NDArray[np.int64], turn: Array, move: Array, ref: Array, carriers: NDArray[np.int64],
    points: Array, normals: Array, basis: Array, motion: Array, force: Array,
) -> None:  # fmt: skip
    """Velocity of body-fixed points along the ground's normal and along the vertical.

    Along the normal it is the gradient of the gap, along the vertical the generalised force of a unit load
    against gravity.

    Args:
        parent: (nv,) the tree, see `rover_pin.mechanism.columns`.
        turn: (nv, 3) likewise.
        move: (nv, 3) likewise.
        ref: (3,) likewise.
        carriers: (m,) last column of the body of each point.
        points: (m, 3) m, world.
        normals: (m, 3) unit, world.
        basis: (nv, n) of the free coordinates.
        motion: (>= m, n) receives the rows along the normals [m per unit coordinate].
        force: (>= m, n) receives the vertical rows [m per unit coordinate].
    """
    for i in range(points.shape[0]):
        x, y, z = normals[i, 0], normals[i, 1], normals[i, 2]
        motion[i] = 0.0
        force[i] = 0.0
        v = carriers[i]
        while v >= 0:
            vx, vy, vz = speed(turn, move, ref, v, points[i, 0], points[i, 1], points[i, 2])
            along = x * vx + y * vy + z * vz
            for c in range(basis.shape[1]):
                motion[i, c] += along * basis[v, c]
                force[i, c] += vz * basis[v, c]
            v = parent[v]
