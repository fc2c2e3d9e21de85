"""The formulas of closed loops and struts, on places, axes and Jacobians, whoever supplies those."""

from __future__ import annotations

import math

import numpy as np

from rover_pin.numerics import Array, formula

BALL, HINGE, PLANAR, WELD, DISTANCE, LEVEL = range(6)

SIZES = (3, 5, 2, 6, 1, 1)
"""Rows of each kind of loop."""


@formula
def close(
    kind: int, across: Array, length: float, o1: Array, r1: Array, j1: Array, o2: Array, r2: Array, j2: Array,
    residual: Array, jacobian: Array,
) -> None:  # fmt: skip
    """Residual and Jacobian of a loop between two frames; e = o2 - o1.

    Ball: e, world axes. Planar: t1.e and t2.e, with t1, t2 across the axis in the first frame. Hinge: the
    ball's rows, and a.t1', a.t2' with a the axis in the first frame and t1', t2' across the same axis in the
    second. Weld: e, and twice the vector part of the quaternion of R1' R2. Distance: |e| - length.
    Level: the height of the axis in the first frame, which is to be horizontal; the second frame counts for
    nothing.

    Args:
        kind: BALL, HINGE, PLANAR, WELD, DISTANCE or LEVEL.
        across: (3, 3) columns t1, t2 and the axis, in a frame's coordinates.
        length: m, of a distance loop.
        o1: (3,) m, the first frame's origin, world.
        r1: (3, 3) its rotation, world.
        j1: (6, n) velocity of its origin, then its angular velocity, world axes.
        o2: the same of the second frame.
        r2: likewise.
        j2: likewise.
        residual: (rows,) receives the residual [m; rad for rows of orientation].
        jacobian: (rows, n) receives its derivative.
    """
    n = j1.shape[1]
    if kind == LEVEL:
        ax, ay, az = _axis(r1, across, 2)
        residual[0] = az
        for k in range(n):
            jacobian[0, k] = ay * j1[3, k] - ax * j1[4, k]
        return
    ex, ey, ez = o2[0] - o1[0], o2[1] - o1[1], o2[2] - o1[2]
    if kind == DISTANCE:
        far = math.sqrt(ex * ex + ey * ey + ez * ez)
        s = 1.0 / max(far, 1e-12)
        residual[0] = far - length
        for k in range(n):
            along = ex * (j2[0, k] - j1[0, k]) + ey * (j2[1, k] - j1[1, k]) + ez * (j2[2, k] - j1[2, k])
            jacobian[0, k] = s * along
        return
    if kind == PLANAR:
        for i in range(2):
            tx, ty, tz = _axis(r1, across, i)
            residual[i] = tx * ex + ty * ey + tz * ez
            mx, my, mz = ty * ez - tz * ey, tz * ex - tx * ez, tx * ey - ty * ex
            for k in range(n):
                moving = tx * (j2[0, k] - j1[0, k]) + ty * (j2[1, k] - j1[1, k]) + tz * (j2[2, k] - j1[2, k])
                jacobian[i, k] = moving + mx * j1[3, k] + my * j1[4, k] + mz * j1[5, k]
        return
    residual[0], residual[1], residual[2] = ex, ey, ez
    for i in range(3):
        for k in range(n):
            jacobian[i, k] = j2[i, k] - j1[i, k]
    if kind == HINGE:
        ax, ay, az = _axis(r1, across, 2)
        for i in range(2):
            tx, ty, tz = _axis(r2, across, i)
            residual[3 + i] = tx * ax + ty * ay + tz * az
            mx, my, mz = ty * az - tz * ay, tz * ax - tx * az, tx * ay - ty * ax
            for k in range(n):
                turn = mx * (j2[3, k] - j1[3, k]) + my * (j2[4, k] - j1[4, k]) + mz * (j2[5, k] - j1[5, k])
                jacobian[3 + i, k] = turn
    if kind == WELD:
        w, x, y, z = quaternion_between(r1, r2)
        residual[3], residual[4], residual[5] = 2.0 * x, 2.0 * y, 2.0 * z
        # quaternion' = quaternion * (0, angular velocity in the second frame) / 2
        lever = np.array([[w, -z, y], [z, w, -x], [-y, x, w]])
        for i in range(3):
            mx = lever[i, 0] * r2[0, 0] + lever[i, 1] * r2[0, 1] + lever[i, 2] * r2[0, 2]
            my = lever[i, 0] * r2[1, 0] + lever[i, 1] * r2[1, 1] + lever[i, 2] * r2[1, 2]
            mz = lever[i, 0] * r2[2, 0] + lever[i, 1] * r2[2, 1] + lever[i, 2] * r2[2, 2]
            for k in range(n):
                turn = mx * (j2[3, k] - j1[3, k]) + my * (j2[4, k] - j1[4, k]) + mz * (j2[5, k] - j1[5, k])
                jacobian[3 + i, k] = turn


@formula
def _axis(rotation: Array, across: Array, i: int) -> tuple[float, float, float]:
    """Column i of `across`, turned into the world."""
    u, v, w = across[0, i], across[1, i], across[2, i]
    return (
        rotation[0, 0] * u + rotation[0, 1] * v + rotation[0, 2] * w,
        rotation[1, 0] * u + rotation[1, 1] * v + rotation[1, 2] * w,
        rotation[2, 0] * u + rotation[2, 1] * v + rotation[2, 2] * w,
    )


@formula
def quaternion_between(r1: Array, r2: Array) -> tuple[float, float, float, float]:
    """Quaternion (w >= 0, x, y, z) of R1' R2, by its largest component (Shepperd 1978)."""
    m = np.empty((3, 3))
    for i in range(3):
        for j in range(3):
            m[i, j] = r1[0, i] * r2[0, j] + r1[1, i] * r2[1, j] + r1[2, i] * r2[2, j]
    trace = m[0, 0] + m[1, 1] + m[2, 2]
    if trace >= max(m[0, 0], m[1, 1], m[2, 2]):
        w = math.sqrt(1.0 + trace)
        s = 0.5 / w
        return 0.5 * w, (m[2, 1] - m[1, 2]) * s, (m[0, 2] - m[2, 0]) * s, (m[1, 0] - m[0, 1]) * s
    i = 0
    if m[1, 1] > m[0, 0]:
        i = 1
    if m[2, 2] > m[i, i]:
        i = 2
    j, k = (i + 1) % 3, (i + 2) % 3
    q = np.empty(4)
    long = math.sqrt(1.0 + m[i, i] - m[j, j] - m[k, k])
    s = 0.5 / long
    q[1 + i] = 0.5 * long
    q[1 + j] = (m[j, i] + m[i, j]) * s
    q[1 + k] = (m[k, i] + m[i, k]) * s
    w = (m[k, j] - m[j, k]) * s
    sign = 1.0 if w >= 0.0 else -1.0
    return sign * w, sign * q[1], sign * q[2], sign * q[3]


@formula
def push(length: float, stiffness: float, preload: float, length_max: float) -> float:
    """Force of a strut [N]: preload + stiffness (length_max - length)."""
    return preload + stiffness * (length_max - length)


@formula
def torque(q: float, stiffness: float, rest: float, preload: float) -> float:
    """Torque [N m] or force [N] of a joint's spring: preload - stiffness (q - rest)."""
    return preload - stiffness * (q - rest)
