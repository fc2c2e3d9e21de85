"""Small second-order cone programs, solved by Clarabel and checked afterwards."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from scipy.sparse import csc_matrix

from rover_pin.errors import SolverError
from rover_pin.numerics import Array

Outcome = Literal["solved", "infeasible", "unbounded", "failed"]

TOLERANCE = 1e-11
"""What the solver is asked for."""

ACCEPTED = 1e-8
"""What its answer must reach by our own count, whatever it calls it."""


@dataclass(frozen=True)
class Answer:
    """What a program came to.

    Attributes:
        outcome: `solved` only where residuals and duality gap were recomputed and are within ACCEPTED.
        x: (n,) the minimiser.
        value: the objective at x.
        bound: the dual objective, less what its own residuals leave in doubt for a point of x's size: no
            such point that is feasible lies below it.
        cone_multipliers: (c, 3) dual variables of the cones.
    """

    outcome: Outcome
    x: Array
    value: float
    bound: float
    cone_multipliers: Array


PROVEN = 1e-6
"""What is left of a certificate of infeasibility or unboundedness, as a share of its gain."""


class ConeProgram:
    """A convex quadratic objective under linear and second-order cone constraints, a few dozen of each.

    minimise x'Px/2 + q'x subject to equal @ x = level, at_least @ x + base >= 0, and
    |s_i[1:]| <= s_i[0] with s_i = cones[i] @ x + offset[i]. It is set up once; further solves with another
    objective or other cones reuse the set-up.
    """

    def __init__(
        self,
        *,
        cost: Array,
        quadratic: Array | None = None,
        equal: Array | None = None,
        level: Array | None = None,
        at_least: Array | None = None,
        base: Array | None = None,
        cones: Array | None = None,
        offset: Array | None = None,
    ) -> None:
        n = cost.size
        equal = np.zeros((0, n)) if equal is None else equal
        level = np.zeros(len(equal)) if level is None else level
        at_least = np.zeros((0, n)) if at_least is None else at_least
        base = np.zeros(len(at_least)) if base is None else base
        cones = np.zeros((0, 3, n)) if cones is None else cones
        offset = np.zeros(cones.shape[:2]) if offset is None else offset
        self._cost = cost
        self._quadratic = np.zeros((n, n)) if quadratic is None else quadratic
        self._counts = (len(equal), len(at_least), len(cones))
        self._left = np.vstack([equal, -at_least, -cones.reshape(-1, n)])
        self._right = np.concatenate([level, base, offset.reshape(-1)])
        self._solver: Any = None

    def set_cones(self, cones: Array) -> None:
        """Replace the cones' (c, 3, n) matrix."""
        equals, linear, _ = self._counts
        self._left[equals + linear :] = -cones.reshape(-1, self._cost.size)
        if self._solver is not None:
            self._check_finite()
            self._solver.update(A=self._left.T.ravel())

    def set_cost(self, cost: Array) -> None:
        """Replace the linear objective, (n,)."""
        self._cost = cost
        if self._solver is not None:
            self._check_finite()
            self._solver.update(q=cost)

    def solve(self, accepted: float = ACCEPTED) -> Answer:
        """Solve and check.

        Args:
            accepted: the largest residual or duality gap that is `solved`, relative to the data's 1.

        Raises:
            SolverError: the data are not finite.
        """
        if self._solver is None:
            self._set_up()
        answer = self._attempt(accepted)
        for settings in ({}, {"max_step_fraction": 0.9}, {"equilibrate_enable": True}):
            if answer.outcome != "failed":
                break
            # a solver that has had its data changed can stumble where a fresh one does not
            self._set_up(**settings)
            answer = self._attempt(accepted)
        return answer

    def _attempt(self, accepted: float) -> Answer:
        found = self._solver.solve()
        status = str(found.status)
        x, z = np.array(found.x), np.array(found.z)
        if not (np.isfinite(x).all() and np.isfinite(z).all()):
            return self._nothing("failed")
        if "PrimalInfeasible" in status:
            return self._nothing("infeasible" if self._proves_infeasible(z) else "failed")
        if "DualInfeasible" in status:
            return self._nothing("unbounded" if self._proves_unbounded(x) else "failed")
        return self._checked(x, z, accepted)

    def _set_up(self, **others: float) -> None:
        import clarabel

        self._check_finite()
        equals, linear, cones = self._counts
        kinds = [clarabel.ZeroConeT(equals)] if equals else []
        kinds += [clarabel.NonnegativeConeT(linear)] if linear else []
        kinds += [clarabel.SecondOrderConeT(3)] * cones
        settings = clarabel.DefaultSettings()
        settings.verbose = False
        settings.max_threads = 1
        settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = TOLERANCE
        # what comes here is scaled already, and its scaling would be that of the first data
        settings.equilibrate_enable = False
        # both of these rewrite the problem and would forbid new data
        settings.presolve_enable = False
        settings.chordal_decomposition_enable = False
        for name, value in others.items():
            setattr(settings, name, value)
        self._solver = clarabel.DefaultSolver(
            csc_matrix(np.triu(self._quadratic)),
            self._cost,
            _dense_columns(self._left),
            self._right,
            kinds,
            settings,
        )

    def _check_finite(self) -> None:
        for part in (self._quadratic, self._cost, self._left, self._right):
            if not np.isfinite(part).all():
                raise SolverError("a cone program with entries that are not finite", problem=self.__dict__)

    def _nothing(self, outcome: Outcome) -> Answer:
        n = self._cost.size
        return Answer(outcome, np.full(n, np.nan), np.nan, np.nan, np.full((self._counts[2], 3), np.nan))

    def _proves_infeasible(self, z: Array) -> bool:
        """Farkas: z in the dual cone, left'z = 0 and right'z < 0 leave no feasible point."""
        equals, linear, _ = self._counts
        gain = -float(self._right @ z)
        wrong = max(np.max(np.abs(self._left.T @ z), initial=0.0), _outside(z[equals:], linear))
        return gain > 0 and bool(wrong <= PROVEN * gain)

    def _proves_unbounded(self, x: Array) -> bool:
        """A direction x that stays feasible for ever and always lowers the objective."""
        equals, linear, _ = self._counts
        gain = -float(self._cost @ x)
        move = -self._left @ x
        wrong = max(
            np.max(np.abs(self._quadratic @ x), initial=0.0),
            np.max(np.abs(move[:equals]), initial=0.0),
            _outside(move[equals:], linear),
        )
        return gain > 0 and bool(wrong <= PROVEN * gain)

    def _checked(self, x: Array, z: Array, accepted: float) -> Answer:
        equals, linear, cones = self._counts
        slack = self._right - self._left @ x
        curved = self._quadratic @ x
        value = float(self._cost @ x + 0.5 * curved @ x)
        bound = float(-0.5 * curved @ x - self._right @ z)
        gradient = float(np.max(np.abs(self._cost + curved + self._left.T @ z), initial=0.0))
        outward = _outside(z[equals:], linear)
        wrong = max(
            float(np.max(np.abs(slack[:equals]), initial=0.0)),
            _outside(slack[equals:], linear),
            outward,
            gradient,
            (value - bound) / max(1.0, abs(value)),
        )
        outcome: Outcome = "solved" if wrong <= accepted * max(1.0, float(np.max(np.abs(x)))) else "failed"
        doubt = gradient * float(np.sum(np.abs(x))) + outward * float(np.sum(np.abs(slack[equals:])))
        return Answer(outcome, x, value, bound - doubt, z[equals + linear :].reshape(cones, 3))


def _outside(slack: Array, linear: int) -> float:
    """How far a point is outside the non-negative orthant and the cones."""
    cones = slack[linear:].reshape(-1, 3)
    return float(
        max(
            -np.min(slack[:linear], initial=0.0),
            np.max(np.hypot(cones[:, 1], cones[:, 2]) - cones[:, 0], initial=0.0),
        )
    )


def _dense_columns(matrix: Array) -> Any:
    """A sparse matrix that stores every entry, so that its data are the columns in turn."""
    m, n = matrix.shape
    return csc_matrix((matrix.T.ravel(), np.tile(np.arange(m), n), np.arange(0, m * n + 1, m)), shape=(m, n))
