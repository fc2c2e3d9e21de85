"""The stance on level supports as a minimum of energy, by scipy's SLSQP.

On level ground contact forces are vertical anyway, so standing is: least energy of gravity and springs with
no wheel below its plateau, couplings closed. The gap of a wheel on level ground is known in closed form: the
lowest point of a circle of radius R whose axis has the vertical part a_z lies R sqrt(1 - a_z^2) below its
centre.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import minimize, nnls
from tree_walk import BASE, STEP, Machine


def energy_minimum(machine: Machine, heights, place, fixed=None, held=(), gravity=9.81) -> dict[str, float]:
    """Free coordinates of the minimum.

    Args:
        machine: what stands.
        heights: m, of the plateau under each wheel, by name.
        place: x, y, yaw of the base.
        fixed: joint values by name.
        held: passive joints that do not move.
        gravity: m/s2.

    Raises:
        ValueError: what SLSQP found is no minimum to first order.
    """
    names = machine.free(held)
    fixed = dict(fixed or {})
    rows, right = machine.coupling_rows(names, fixed)
    weight = machine.mass * gravity

    def both(q):
        """Energy over the weight and gaps, with gradients by the complex step."""
        n = len(q)
        steps = np.tile(q.astype(complex), (n, 1)) + 1j * STEP * np.eye(n)
        poses = machine.walk(place, names, steps, fixed)
        values = [machine.potential(poses, names, steps, gravity) / weight]
        values += [level_gap(poses, disc) - heights[disc.name] for disc in machine.discs]
        table = np.array(values)
        return table[:, 0].real, table.imag / STEP

    kept: dict[bytes, tuple] = {}

    def known(q):
        key = q.tobytes()
        if key not in kept:
            kept.clear()
            kept[key] = both(q)
        return kept[key]

    start = np.array([0.0 if name in BASE else fixed.get(name, 0.0) for name in names])
    start[0] -= np.min(both(start)[0][1:])
    limits = {b.name: b.limits for b in machine.branches}
    constraints = [
        {"type": "ineq", "fun": lambda q: known(q)[0][1:], "jac": lambda q: known(q)[1][1:]},
        {"type": "eq", "fun": lambda q: rows @ q - right, "jac": lambda _: rows},
    ]
    bounds = [limits.get(name, (-np.inf, np.inf)) for name in names]
    q, best = start, np.inf
    for _ in range(6):  # anew from where it ended: SLSQP forgets its Hessian and ends nearer
        q = minimize(
            lambda q: known(q)[0][0], q, jac=lambda q: known(q)[1][0], method="SLSQP", bounds=bounds,
            constraints=constraints[: 2 if len(rows) else 1], options={"ftol": 1e-16, "maxiter": 1000},
        ).x  # fmt: skip
        best = _first_order(*known(q), np.vstack([rows, -rows, _at_limits(q, bounds)]), rows @ q - right)
        if best < 1e-10:
            break
    if best < 2e-8:  # of the weight: a pose off by far less than what is compared
        return dict(zip(names, q.tolist(), strict=True))
    raise ValueError(f"not a minimum: {best:g}")


def _first_order(values, table, others, closed) -> float:
    """Largest violation of the conditions of a minimum, multipliers by non-negative least squares."""
    active = values[1:] < 1e-9
    sides = np.vstack([table[1:][active], others]).T
    _, unbalanced = nnls(sides, table[0])
    return float(max(unbalanced, -np.min(values[1:]), np.max(np.abs(closed), initial=0.0)))


def _at_limits(q, bounds) -> np.ndarray:
    """Inward rows of the joints that stand on a limit."""
    unit = np.eye(len(q))
    low = [unit[i] for i, (least, _) in enumerate(bounds) if q[i] - least < 1e-9]
    high = [-unit[i] for i, (_, most) in enumerate(bounds) if most - q[i] < 1e-9]
    return np.array([*low, *high]).reshape(-1, len(q))


def level_gap(poses, disc) -> np.ndarray:
    """(B,) height of a wheel's lowest point [m]."""
    pose = poses[disc.link]
    height = pose[:, 2, :3] @ disc.center + pose[:, 2, 3]
    lean = pose[:, 2, :3] @ disc.axis
    return height - disc.ring * np.sqrt(1.0 - lean * lean) - disc.tread
