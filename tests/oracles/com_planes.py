"""How far the centre of mass may move, and the slack of generators, by linear programs (HiGHS).

Every multiplier, torque and the move itself is a variable; nothing is eliminated beforehand.
"""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
from cutting_planes import CuttingPlanes
from scipy.optimize import linprog


def reach(problem: Any, direction: Any, effort: Any = (), levers: Any = (), drive_effort: Any = ()) -> float:
    """m from the centre of mass as it is, friction cones exact by tangent planes; NaN where nowhere."""
    rows, limits = problem.rows, [-np.inf] * (len(effort) + 2)
    wide = SimpleNamespace(
        gravity=rows.gravity,
        contact=rows.contact,
        internal=np.hstack([rows.internal, rows.torque, -rows.lean / problem.weight]),
        internal_lower=np.r_[rows.internal_lower, limits],
    )
    planes = CuttingPlanes(replace(problem, rows=wide))
    first = planes.n - 3 - len(effort)
    for i, limit in enumerate(np.asarray(effort) / problem.weight):
        planes.bounds[first + i] = (-limit, limit)
    cost = np.zeros(planes.n)
    cost[-3:-1] = -np.asarray(direction)
    more = []
    for lever, limit in zip(levers, drive_effort, strict=True):
        # |lever' rolling| <= limit: the last variable, fixed at one, carries the limit
        for sign in (1.0, -1.0):
            line = np.zeros(planes.n)
            line[1 : 3 * planes.k : 3] = sign * np.asarray(lever)
            line[-1] = -limit / problem.weight
            more.append(line)
    planes.bounds[-1] = (1.0, 1.0)
    found = planes.minimise(cost, problem.friction, 0.0, more)
    return np.nan if found is None else -found


def generator_slack(problem: Any, edges: int) -> float:
    """edges * b0 [N]: the largest b0 with G b = D c + d, b >= b0, generators of normal part 1."""
    rows = problem.rows
    angles = 2.0 * np.pi * np.arange(edges) / edges
    columns = []
    for i, (frame, mu) in enumerate(zip(problem.frames, problem.friction, strict=True)):
        own = rows.contact[:, 3 * i : 3 * i + 3]
        columns += [own @ (frame[0] + mu * (np.cos(a) * frame[1] + np.sin(a) * frame[2])) for a in angles]
    G = np.array(columns).T
    n, j = G.shape[1], rows.internal.shape[1]
    floor = np.hstack([-np.eye(n), np.zeros((n, j)), np.ones((n, 1))])
    found = linprog(
        np.r_[np.zeros(n + j), -1.0],
        A_ub=floor,
        b_ub=np.zeros(n),
        A_eq=np.hstack([G, rows.internal, np.zeros((len(G), 1))]) / problem.weight,
        b_eq=rows.gravity / problem.weight,
        bounds=[(None, None)] * n
        + [(None if np.isneginf(low) else low, None) for low in rows.internal_lower]
        + [(None, None)],
        method="highs",
    )
    assert found.status == 0
    return float(edges * found.x[-1])
