"""Velocities of points of a tree of joints, column by column.

A tree is given by columns, one a coordinate, each after the one it hangs on: `parent` (-1 of the first),
`turn` its axis in the world (zero where it slides), `move` the velocity of its body's point at `ref`. A point
p of a body whose last column is e moves by v_c(p) = move_c + turn_c x (p - ref) with every column c of its
chain, e and those it hangs on.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rover_pin.numerics import Array, formula, inlined

Integers = NDArray[np.int64]


@inlined
def speed(
    turn: Array, move: Array, ref: Array, c: int, x: float, y: float, z: float
) -> tuple[float, float, float]:
    """v_c at the world point (x, y, z)."""
    rx, ry, rz = x - ref[0], y - ref[1], z - ref[2]
    wx, wy, wz = turn[c, 0], turn[c, 1], turn[c, 2]
    return (
        move[c, 0] + wy * rz - wz * ry,
        move[c, 1] + wz * rx - wx * rz,
        move[c, 2] + wx * ry - wy * rx,
    )


@inlined
def is_above(parent: Integers, c: int, e: int) -> bool:
    """Whether column c is e or one that e hangs on; columns come after those they hang on."""
    while e > c:
        e = parent[e]
    return e == c


@formula
def add_pulls(
    parent: Integers, turn: Array, move: Array, ref: Array, ends: Integers, points: Array, forces: Array,
    out: Array,
) -> None:  # fmt: skip
    """Add the generalised force of forces at points of bodies, per column.

    Args:
        parent: (m,).
        turn: (m, 3).
        move: (m, 3).
        ref: (3,) m.
        ends: (k,) columns of the bodies.
        points: (k, 3) m, world.
        forces: (k, 3) N.
        out: (m,).
    """
    for i in range(ends.shape[0]):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        c = ends[i]
        while c >= 0:
            vx, vy, vz = speed(turn, move, ref, c, x, y, z)
            out[c] += forces[i, 0] * vx + forces[i, 1] * vy + forces[i, 2] * vz
            c = parent[c]


@formula
def to_columns(jacobian: Array, ref: Array, turn: Array, move: Array) -> None:
    """Columns from a Jacobian (6, m) of linear and angular velocity at the world's origin, world axes.

    Args:
        jacobian: (6, m).
        ref: (3,) m.
        turn: (m, 3) receives the axes.
        move: (m, 3) receives the velocities at `ref`.
    """
    for c in range(jacobian.shape[1]):
        x, y, z = jacobian[3, c], jacobian[4, c], jacobian[5, c]
        turn[c, 0], turn[c, 1], turn[c, 2] = x, y, z
        move[c, 0] = jacobian[0, c] + y * ref[2] - z * ref[1]
        move[c, 1] = jacobian[1, c] + z * ref[0] - x * ref[2]
        move[c, 2] = jacobian[2, c] + x * ref[1] - y * ref[0]


@formula
def frame_rows(
    parent: Integers, turn: Array, move: Array, ref: Array, e: int, point: Array, out: Array
) -> None:
    """Jacobian of a place on the body of column e: velocity of the point, then angular velocity.

    Args:
        parent: (m,).
        turn: (m, 3).
        move: (m, 3).
        ref: (3,) m.
        e: column, -1 of the world.
        point: (3,) m, world.
        out: (6, m) receives the rows, world axes.
    """
    out[:] = 0.0
    while e >= 0:
        out[0, e], out[1, e], out[2, e] = speed(turn, move, ref, e, point[0], point[1], point[2])
        out[3, e], out[4, e], out[5, e] = turn[e, 0], turn[e, 1], turn[e, 2]
        e = parent[e]


@formula
def stretch(
    parent: Integers, turn: Array, move: Array, ref: Array, ends: Integers, points: Array, gradient: Array
) -> float:
    """Distance of two points [m] and its derivative; columns that move both bodies alike do not count.

    Args:
        parent: (m,).
        turn: (m, 3).
        move: (m, 3).
        ref: (3,) m.
        ends: (2,) columns of the bodies.
        points: (2, 3) m, world.
        gradient: (m,) receives the derivative; zero where the points coincide.

    Returns:
        The distance.
    """
    ex, ey, ez = points[1, 0] - points[0, 0], points[1, 1] - points[0, 1], points[1, 2] - points[0, 2]
    length = math.sqrt(ex * ex + ey * ey + ez * ez)
    share = 1.0 / length if length > 0.0 else 0.0
    for c in range(parent.shape[0]):
        gradient[c] = 0.0
    for i in range(2):
        sign = share if i == 1 else -share
        c = ends[i]
        while c >= 0 and not is_above(parent, c, ends[1 - i]):
            vx, vy, vz = speed(turn, move, ref, c, points[i, 0], points[i, 1], points[i, 2])
            gradient[c] = sign * (ex * vx + ey * vy + ez * vz)
            c = parent[c]
    return length


@formula
def strut(
    parent: Integers, turn: Array, move: Array, ref: Array, rotations: Array, origins: Array,
    joints: Integers, ends: Integers, local: Array, points: Array, gradient: Array,
) -> float:  # fmt: skip
    """`stretch` between two points given in the frames of their joints.

    Args:
        parent: (m,).
        turn: (m, 3).
        move: (m, 3).
        ref: (3,) m.
        rotations: (joints, 3, 3), world.
        origins: (joints, 3) m.
        joints: (2,).
        ends: (2,) columns of the bodies.
        local: (2, 3) m, in the joints' frames.
        points: (2, 3) receives the points, world [m].
        gradient: (m,) receives the derivative.

    Returns:
        The distance [m].
    """
    for i in range(2):
        r, o = rotations[joints[i]], origins[joints[i]]
        u, v, w = local[i, 0], local[i, 1], local[i, 2]
        for k in range(3):
            points[i, k] = o[k] + r[k, 0] * u + r[k, 1] * v + r[k, 2] * w
    return stretch(parent, turn, move, ref, ends, points, gradient)
