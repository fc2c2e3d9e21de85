"""Friction cones by linear programs: tangent planes are added where the answer leaves a cone."""

from __future__ import annotations

import numpy as np
from scipy.optimize import linprog

from rover_pin.statics.friction_problem import FrictionProblem

ROUNDS = 60


class CuttingPlanes:
    """Contact forces in units of the weight in contact frames, multipliers and one more variable t."""

    def __init__(self, problem: FrictionProblem) -> None:
        k = len(problem.contacts)
        rows = problem.rows
        T = np.zeros((3 * k, 3 * k))
        for i, frame in enumerate(problem.frames):
            T[3 * i : 3 * i + 3, 3 * i : 3 * i + 3] = frame.T
        self.k = k
        self.A = np.hstack([rows.contact @ T, rows.internal, np.zeros((len(rows.gravity), 1))])
        self.b = rows.gravity / problem.weight
        self.n = self.A.shape[1]
        bounds = []
        for i in range(k):
            rolling = (0.0, 0.0) if problem.contacts[i].free else (None, None)
            bounds += [(0.0, None), rolling, (None, None)]
        bounds += [(None if np.isneginf(low) else low, None) for low in rows.internal_lower]
        self.bounds = [*bounds, (None, None)]

    def minimise(self, cost: np.ndarray, mu: np.ndarray, slack: float, more: list[np.ndarray] | None = None):
        """Least cost'x with |tangential| <= mu normal + slack t; `more` are rows <= 0. None if infeasible."""
        angles = np.linspace(0, 2 * np.pi, 17)[:-1]
        cuts = [self._cut(i, a, mu[i], slack) for i in range(self.k) for a in angles] + (more or [])
        for _ in range(ROUNDS):
            found = linprog(
                cost,
                A_ub=np.array(cuts),
                b_ub=np.zeros(len(cuts)),
                A_eq=self.A,
                b_eq=self.b,
                bounds=self.bounds,
                method="highs",
                options={"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10},
            )
            if found.status == 3:
                return -np.inf
            if found.status != 0:
                return None
            f = found.x[: 3 * self.k].reshape(-1, 3)
            over = np.hypot(f[:, 1], f[:, 2]) - mu * f[:, 0] - slack * found.x[-1]
            if over.max() < 1e-10:
                break
            for i in np.flatnonzero(over > 1e-11):
                cuts.append(self._cut(i, np.arctan2(f[i, 2], f[i, 1]), mu[i], slack))
        return found.fun

    def _cut(self, i: int, angle: float, mu: float, slack: float) -> np.ndarray:
        row = np.zeros(self.n)
        row[3 * i : 3 * i + 3] = -mu, np.cos(angle), np.sin(angle)
        row[-1] = -slack
        return row

    def excess(self, mu: np.ndarray) -> float | None:
        """min t with |tangential| <= mu normal + t."""
        cost = np.zeros(self.n)
        cost[-1] = 1.0
        return self.minimise(cost, mu, 1.0)

    def torque(self, mu: np.ndarray, levers: np.ndarray) -> float | None:
        """min t with |lever' rolling| <= t per row, within the cones."""
        cost = np.zeros(self.n)
        cost[-1] = 1.0
        more = []
        for row in levers:
            for sign in (1.0, -1.0):
                line = np.zeros(self.n)
                line[1 : 3 * self.k : 3] = sign * row
                line[-1] = -1.0
                more.append(line)
        return self.minimise(cost, mu, 0.0, more)
