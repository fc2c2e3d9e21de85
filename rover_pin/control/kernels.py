"""The compiled inner work of motion constraints: where sides are, and what their rockers do.

As in `rover_pin.kinematics.kernels`, they call no compiled function of another file.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rover_pin.numerics import Array, formula

Integers = NDArray[np.int64]

YAW = 3


@formula
def place_sides(
    jacobian: Array, chains: Array, carriers: Integers, points: Array, cos: float, sin: float, rows: Array,
    rise: Array,
) -> tuple[Array, Array, Array, Array]:  # fmt: skip
    """Distances along the heading of two sides, and their rates.

    Args:
        jacobian: (6, nv) velocity at the world's origin and axis of every column, world axes.
        chains: (joints, nv) 1 where a column moves a body.
        carriers: (2 n + 2,) bodies of n wheels' centres of the left side, of the right, and of both hinges.
        points: (2 n + 2, 3) m, world.
        cos: of the heading.
        sin: of the heading.
        rows: (2 n + 2, nv) receives velocities of the points along the heading.
        rise: (2, nv) receives velocities of the hinges upwards.

    Returns:
        First wheel's centre ahead of the second one's (2,) m and its rate (2, nv); hinge ahead of the second
        wheel's centre (2,) m and its rate (2, nv). The heading turns with the base's yaw.
    """
    nv, count = jacobian.shape[1], carriers.shape[0]
    wheels = (count - 2) // 2
    for i in range(count):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        mx, my, mz = -z * sin, z * cos, x * sin - y * cos
        for c in range(nv):
            on = chains[carriers[i], c]
            rows[i, c] = on * (
                cos * jacobian[0, c] + sin * jacobian[1, c]
                + mx * jacobian[3, c] + my * jacobian[4, c] + mz * jacobian[5, c]
            )  # fmt: skip
            if i >= count - 2:
                rise[i - count + 2, c] = on * (jacobian[2, c] + y * jacobian[3, c] - x * jacobian[4, c])
    apart, ahead = np.empty(2), np.empty(2)
    apart_rows, ahead_rows = np.empty((2, nv)), np.empty((2, nv))
    for s in range(2):
        first, second, hinge = s * wheels, s * wheels + 1, 2 * wheels + s
        dx, dy = points[first, 0] - points[second, 0], points[first, 1] - points[second, 1]
        hx, hy = points[hinge, 0] - points[second, 0], points[hinge, 1] - points[second, 1]
        apart[s], ahead[s] = dx * cos + dy * sin, hx * cos + hy * sin
        apart_rows[s] = rows[first] - rows[second]
        ahead_rows[s] = rows[hinge] - rows[second]
        apart_rows[s, YAW] += dy * cos - dx * sin
        ahead_rows[s, YAW] += hy * cos - hx * sin
    return apart, apart_rows, ahead, ahead_rows


@formula
def _solved(square: Array, right: Array) -> Array:
    """Gauss with the largest pivot of a column; inf where there is none. Both arguments are overwritten."""
    m = square.shape[0]
    for c in range(m):
        pivot = c
        for i in range(c + 1, m):
            if abs(square[i, c]) > abs(square[pivot, c]):
                pivot = i
        if abs(square[pivot, c]) < 1e-12:
            return np.full(right.shape, np.inf)
        if pivot != c:
            for k in range(m):
                square[c, k], square[pivot, k] = square[pivot, k], square[c, k]
            for k in range(right.shape[1]):
                right[c, k], right[pivot, k] = right[pivot, k], right[c, k]
        for i in range(c + 1, m):
            share = square[i, c] / square[c, c]
            for k in range(c, m):
                square[i, k] -= share * square[c, k]
            for k in range(right.shape[1]):
                right[i, k] -= share * right[c, k]
    for c in range(m - 1, -1, -1):
        for k in range(right.shape[1]):
            for i in range(c + 1, m):
                right[c, k] -= square[c, i] * right[i, k]
            right[c, k] /= square[c, c]
    return right


@formula
def rates_by_rockers(
    rows: Array, free: Integers, rockers: Integers, apart_rows: Array, steep: float, kept: float
) -> tuple[bool, Array]:
    """d(apart)/d(rocker) of each side where rows x = 0 determines the free rates.

    Args:
        rows: (m, nv) that have to stay 0.
        free: (m,) columns that follow.
        rockers: (2,) columns that turn, one after the other.
        apart_rows: (2, nv).
        steep: rates beyond which the rows count as singular.
        kept: share of a rocker's effect on a row that may be left over before it counts as stuck.

    Returns:
        Whether the rows are regular, and the rates (2,).
    """
    m = rows.shape[0]
    square, turning = np.empty((m, m)), np.empty((m, 2))
    for i in range(m):
        for k in range(m):
            square[i, k] = rows[i, free[k]]
        for s in range(2):
            turning[i, s] = rows[i, rockers[s]]
    found = _solved(square.copy(), -turning)
    rates = np.zeros(2)
    for s in range(2):
        rate, most, missed = apart_rows[s, rockers[s]], 0.0, 0.0
        for k in range(m):
            if not abs(found[k, s]) < steep:
                return False, rates
            rate += apart_rows[s, free[k]] * found[k, s]
        for i in range(m):
            left = turning[i, s]
            most = max(most, abs(left))
            for k in range(m):
                left += square[i, k] * found[k, s]
            missed = max(missed, abs(left))
        rates[s] = 0.0 if missed > kept * most else rate
    return True, rates
