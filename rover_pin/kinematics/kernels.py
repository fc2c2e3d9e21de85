"""The compiled inner work of a step: rows of points, the cost, the check of an answer.

They call no compiled function of another file: numba's cache on disk compares a function with its own file.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rover_pin.numerics import Array, formula

Integers = NDArray[np.int64]


@formula
def velocity_rows(
    jacobian: Array, chains: Array, joints: Integers, points: Array, directions: Array, out: Array
) -> None:
    """Velocities of points of bodies along directions.

    Args:
        jacobian: (6, nv) velocity at the world's origin and axis of every column, world axes.
        chains: (joints, nv) 1 where a column moves a body.
        joints: (k,) bodies.
        points: (k, 3) m, world.
        directions: (k, 3), world.
        out: (k, nv) receives the rows.
    """
    for i in range(joints.shape[0]):
        px, py, pz = points[i, 0], points[i, 1], points[i, 2]
        dx, dy, dz = directions[i, 0], directions[i, 1], directions[i, 2]
        mx, my, mz = py * dz - pz * dy, pz * dx - px * dz, px * dy - py * dx
        for c in range(jacobian.shape[1]):
            if chains[joints[i], c] != 0.0:
                out[i, c] = (
                    dx * jacobian[0, c] + dy * jacobian[1, c] + dz * jacobian[2, c]
                    + mx * jacobian[3, c] + my * jacobian[4, c] + mz * jacobian[5, c]
                )  # fmt: skip
            else:
                out[i, c] = 0.0


@formula
def place_shapes(frames: Array, centers: Array, axes: Array, placed: Array, turned: Array) -> None:
    """Centres and axes of shapes in the world.

    Args:
        frames: (s, 4, 4) placements of the bodies that carry them.
        centers: (s, 3) m, in their bodies' frames.
        axes: (s, 3) unit, likewise.
        placed: (s, 3) receives the centres, m, world.
        turned: (s, 3) receives the axes, world.
    """
    for i in range(frames.shape[0]):
        for k in range(3):
            x, y, z = frames[i, k, 0], frames[i, k, 1], frames[i, k, 2]
            placed[i, k] = x * centers[i, 0] + y * centers[i, 1] + z * centers[i, 2] + frames[i, k, 3]
            turned[i, k] = x * axes[i, 0] + y * axes[i, 1] + z * axes[i, 2]


@formula
def rolling_frame(
    jacobian: Array, chains: Array, joints: Integers, contacts: Array, axes: Array, along: Array, rows: Array
) -> None:
    """Directions at the places of contact and velocities along them.

    Args:
        jacobian: (6, nv) as in `velocity_rows`.
        chains: (joints, nv) 1 where a column moves a body.
        joints: (s,) bodies.
        contacts: (s, 7) gap, point [m], unit normal, world.
        axes: (s, 3) unit, world.
        along: (3, s, 3) receives unit vectors: the normal; where wheels roll to, axis x normal; to the left
            of it, in the ground's tangent plane. The last two are zeros where the axis is along the normal.
        rows: (3, s, nv) receives velocities of the points along them.
    """
    for i in range(axes.shape[0]):
        ax, ay, az = axes[i, 0], axes[i, 1], axes[i, 2]
        nx, ny, nz = contacts[i, 4], contacts[i, 5], contacts[i, 6]
        x, y, z = ay * nz - az * ny, az * nx - ax * nz, ax * ny - ay * nx
        share = 1.0 / max(math.sqrt(x * x + y * y + z * z), 1e-12)
        x, y, z = x * share, y * share, z * share
        along[0, i, 0], along[0, i, 1], along[0, i, 2] = nx, ny, nz
        along[1, i, 0], along[1, i, 1], along[1, i, 2] = x, y, z
        along[2, i, 0], along[2, i, 1], along[2, i, 2] = ny * z - nz * y, nz * x - nx * z, nx * y - ny * x
    points = contacts[:, 1:4]
    for k in range(3):
        velocity_rows(jacobian, chains, joints, points, along[k], rows[k])


@formula
def add_cost(rows: Array, targets: Array, weights: Array, hessian: Array, gradient: Array) -> None:
    """Add weight (row v - target)^2 / 2 to hessian and gradient.

    Args:
        rows: (k, nv).
        targets: (k,).
        weights: (k,).
        hessian: (n, n), n >= nv.
        gradient: (n,).
    """
    for i in range(rows.shape[0]):
        for a in range(rows.shape[1]):
            along = weights[i] * rows[i, a]
            if along != 0.0:
                gradient[a] -= along * targets[i]
                for b in range(rows.shape[1]):
                    hessian[a, b] += along * rows[i, b]


@formula
def outside(matrix: Array, low: Array, high: Array, x: Array) -> float:
    """What low <= matrix x <= high is missed by; infinite where x is not finite."""
    worst = 0.0
    for i in range(matrix.shape[0]):
        along = 0.0
        for c in range(x.shape[0]):
            along += matrix[i, c] * x[c]
        if not math.isfinite(along):
            return math.inf
        worst = max(worst, low[i] - along, along - high[i])
    return worst


@formula
def beyond(x: Array, floor: Array, ceiling: Array) -> float:
    """What floor <= x <= ceiling is missed by; infinite where x is not finite."""
    worst = 0.0
    for i in range(x.shape[0]):
        if not math.isfinite(x[i]):
            return math.inf
        worst = max(worst, floor[i] - x[i], x[i] - ceiling[i])
    return worst


@formula
def idle(z: float, along: float, low: float, high: float) -> float:
    """Multiplier times distance to the side that it speaks for: 0 where it is that side that binds."""
    if z == 0.0:
        return 0.0
    distance = high - along if z > 0.0 else along - low
    return abs(z) * min(abs(distance), 1.0)


@formula
def unbalanced(
    hessian: Array, gradient: Array, equations: Array, matrix: Array, low: Array, high: Array, floor: Array,
    ceiling: Array, x: Array, y: Array, z: Array,
) -> float:  # fmt: skip
    """Largest entry of the Lagrangian's gradient and of multiplier times slack, over the largest term.

    Args:
        hessian: (n, n).
        gradient: (n,).
        equations: (e, n).
        matrix: (m, n).
        low: (m,).
        high: (m,).
        floor: (n,).
        ceiling: (n,).
        x: (n,).
        y: (e,) multipliers of the equations.
        z: (m + n,) of rows, then bounds; positive pushes from the high side.
    """
    n, m = x.shape[0], matrix.shape[0]
    size, left = 1.0, 0.0
    for c in range(n):
        push, pull = 0.0, z[m + c]
        for k in range(n):
            push += hessian[c, k] * x[k]
        for i in range(equations.shape[0]):
            pull += equations[i, c] * y[i]
        for i in range(m):
            pull += matrix[i, c] * z[i]
        size = max(size, abs(push), abs(pull))
        left = max(left, abs(push + gradient[c] + pull))
        left = max(left, idle(z[m + c], x[c], floor[c], ceiling[c]))
    for i in range(m):
        along = 0.0
        for c in range(n):
            along += matrix[i, c] * x[c]
        left = max(left, idle(z[i], along, low[i], high[i]))
    return left / size if math.isfinite(left) else math.inf


@formula
def reduce(
    hessian: Array, gradient: Array, equations: Array, right: Array, matrix: Array, low: Array, high: Array,
    floor: Array, ceiling: Array, pins: Integers, most: float,
) -> tuple[
    bool, Integers, Integers, Array, Array, Array, Array, Array, Array, Array, Array, Array
]:  # fmt: skip
    """The program of the coordinates that no equation pins.

    Args:
        hessian: (n, n).
        gradient: (n,).
        equations: (e, n).
        right: (e,).
        matrix: (m, n).
        low: (m,).
        high: (m,).
        floor: (n,).
        ceiling: (n,).
        pins: (e,) the coordinate that an equation gives its value, -1 where it binds several.
        most: size that open sides are cut to.

    Returns:
        Whether every entry is a finite number and every side a number; places of free coordinates and of the
        equations left; then hessian, gradient, equations, right, matrix, low, high, floor, ceiling of those.
    """
    n, e, m = gradient.shape[0], right.shape[0], low.shape[0]
    good = True
    value = np.zeros(n)
    pinned = np.zeros(n, dtype=np.bool_)
    kept = 0
    for i in range(e):
        good = good and math.isfinite(right[i])
        if pins[i] >= 0:
            value[pins[i]] = right[i]
            pinned[pins[i]] = True
        else:
            kept += 1
    free = np.empty(n - np.sum(pinned), dtype=np.int64)
    k = 0
    for c in range(n):
        good = good and math.isfinite(gradient[c]) and not (math.isnan(floor[c]) or math.isnan(ceiling[c]))
        if not pinned[c]:
            free[k] = c
            k += 1
    size = free.shape[0]
    rest = np.empty(kept, dtype=np.int64)
    h, g, a, b = np.empty((size, size)), np.empty(size), np.empty((kept, size)), np.empty(kept)
    rows, lower, upper = np.empty((m, size)), np.empty(m), np.empty(m)
    bottom, top = np.empty(size), np.empty(size)
    for r in range(size):
        c = free[r]
        g[r] = gradient[c]
        bottom[r], top[r] = max(floor[c], -most), min(ceiling[c], most)
        for d in range(n):
            good = good and math.isfinite(hessian[c, d])
            g[r] += hessian[c, d] * value[d]
        for s in range(size):
            h[r, s] = hessian[c, free[s]]
    k = 0
    for i in range(e):
        for d in range(n):
            good = good and math.isfinite(equations[i, d])
        if pins[i] >= 0:
            continue
        rest[k] = i
        b[k] = right[i]
        for d in range(n):
            b[k] -= equations[i, d] * value[d]
        for s in range(size):
            a[k, s] = equations[i, free[s]]
        k += 1
    for i in range(m):
        good = good and not (math.isnan(low[i]) or math.isnan(high[i]))
        moved = 0.0
        for d in range(n):
            good = good and math.isfinite(matrix[i, d])
            moved += matrix[i, d] * value[d]
        lower[i], upper[i] = max(low[i] - moved, -most), min(high[i] - moved, most)
        for s in range(size):
            rows[i, s] = matrix[i, free[s]]
    return good, free, rest, h, g, a, b, rows, lower, upper, bottom, top


@formula
def expand(
    hessian: Array, gradient: Array, equations: Array, right: Array, matrix: Array, pins: Integers,
    free: Integers, rest: Integers, part: Array, y_part: Array, z_part: Array,
) -> tuple[Array, Array, Array]:  # fmt: skip
    """The point and multipliers of the whole program; those of pins follow from the gradient.

    Args:
        hessian: (n, n).
        gradient: (n,).
        equations: (e, n).
        right: (e,).
        matrix: (m, n).
        pins: (e,).
        free: places of free coordinates.
        rest: places of the equations that are no pins.
        part: the free coordinates.
        y_part: multipliers of the rest.
        z_part: of the rows, then of the free coordinates' bounds.

    Returns:
        x (n,), y (e,), z (m + n,).
    """
    n, e, m = gradient.shape[0], right.shape[0], matrix.shape[0]
    x, y, z = np.zeros(n), np.zeros(e), np.zeros(m + n)
    open_ = np.ones(n, dtype=np.bool_)
    for i in range(e):
        if pins[i] >= 0:
            x[pins[i]] = right[i]
    for r in range(free.shape[0]):
        x[free[r]] = part[r]
        z[m + free[r]] = z_part[m + r]
    for k in range(rest.shape[0]):
        y[rest[k]] = y_part[k]
    z[:m] = z_part[:m]
    for i in range(e):
        c = pins[i]
        if c < 0 or not open_[c]:
            continue
        open_[c] = False  # of several that pin a coordinate one has the multiplier
        left = gradient[c]
        for d in range(n):
            left += hessian[c, d] * x[d]
        for k in range(rest.shape[0]):
            left += equations[rest[k], c] * y[rest[k]]
        for k in range(m):
            left += matrix[k, c] * z[k]
        y[i] = -left
    return x, y, z


@formula
def finished(
    hessian: Array, gradient: Array, equations: Array, right: Array, matrix: Array, low: Array, high: Array,
    floor: Array, ceiling: Array, pins: Integers, free: Integers, rest: Integers, part: Array, y_part: Array,
    z_part: Array, weight: float,
) -> tuple[Array, float, float]:  # fmt: skip
    """The whole program's point, and its conditions worked out again.

    Args:
        hessian: (n, n) of the program, as are the next.
        gradient: (n,).
        equations: (e, n).
        right: (e,).
        matrix: (m, n).
        low: (m,).
        high: (m,).
        floor: (n,).
        ceiling: (n,).
        pins: (e,).
        free: as in `expand`, as are the next.
        rest: places of the equations that are no pins.
        part: the free coordinates.
        y_part: multipliers, of the program times `weight`.
        z_part: likewise.
        weight: what the objective was multiplied by.

    Returns:
        x (n,); the largest miss of a row or bound; what is left of the balance (`unbalanced`).
    """
    x, y, z = expand(
        hessian, gradient, equations, right, matrix, pins, free, rest, part, y_part / weight, z_part / weight
    )
    primal = max(
        outside(equations, right, right, x), outside(matrix, low, high, x), beyond(x, floor, ceiling)
    )
    return x, primal, unbalanced(hessian, gradient, equations, matrix, low, high, floor, ceiling, x, y, z)
