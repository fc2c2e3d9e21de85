"""ProxQP on the program of a step: capped, and believed only after its conditions were worked out again.

Every program is set up anew: warm starts have sent the solver on long ways where matrices change, and the
same instant must give the same answer whatever was solved before.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from proxsuite import proxqp

from rover_pin.kinematics.kernels import beyond, outside, unbalanced
from rover_pin.kinematics.program import Program
from rover_pin.numerics import Array

ITERATIONS = 100
PATIENCE = 10
PRECISION = 1e-9
ACCEPTED = 1e-7
"""m/s or rad/s that rows may be missed by; share of the gradient's size that stationarity may."""

OPEN = 1e20
"""ProxQP's word for no bound."""


@dataclass(frozen=True)
class Answer:
    """What the solver found, checked.

    Attributes:
        x: (n,) the point, whatever it is worth.
        solved: whether it meets every condition.
        primal: largest miss of a row or bound [m/s or rad/s].
        dual: largest entry of the Lagrangian's gradient, over 1 or the largest of its terms.
        iterations: of the solver.
    """

    x: Array
    solved: bool
    primal: float
    dual: float
    iterations: int


def solve(program: Program) -> Answer:
    """The least of the program, or the best that came out, marked as not solved."""
    return _attempt(program, proxqp.InitialGuess.EQUALITY_CONSTRAINED_INITIAL_GUESS, ITERATIONS)


def solve_patiently(program: Program) -> Answer:
    """The same from another start with more iterations: for a program that is known not to be infeasible."""
    return _attempt(program, proxqp.InitialGuess.NO_INITIAL_GUESS, PATIENCE * ITERATIONS)


def _attempt(program: Program, guess: Any, iterations: int) -> Answer:
    """Solve for the coordinates that no equation pins; multipliers of pins follow from the gradient."""
    p = program
    pinning = p.pins >= 0
    x = np.zeros(len(p.gradient))
    x[p.pins[pinning]] = p.right[pinning]
    is_free = np.ones(len(x), dtype=bool)
    is_free[p.pins[pinning]] = False
    free, rest = np.flatnonzero(is_free), np.flatnonzero(~pinning)
    equations = p.equations[rest]
    hessian, matrix = p.hessian[free], p.matrix[:, free]
    moved = p.matrix @ x
    qp = proxqp.dense.QP(
        len(free), len(rest), len(p.low), True, proxqp.dense.HessianType.Dense,
        proxqp.dense.DenseBackend.PrimalDualLDLT,
    )  # fmt: skip
    settings = qp.settings
    settings.initial_guess = guess
    settings.max_iter = iterations
    settings.max_iter_in = ITERATIONS
    settings.eps_abs = PRECISION
    settings.eps_rel = 0.0
    qp.init(
        hessian[:, free], p.gradient[free] + hessian @ x, equations[:, free], p.right[rest] - equations @ x,
        matrix, np.maximum(p.low - moved, -OPEN), np.minimum(p.high - moved, OPEN),
        np.maximum(p.floor[free], -OPEN), np.minimum(p.ceiling[free], OPEN),
    )  # fmt: skip
    qp.solve()
    found = qp.results
    x[free] = found.x
    y, z = np.zeros(len(p.right)), np.zeros(len(p.low) + len(x))
    y[rest] = found.y
    z[: len(p.low)] = found.z[: len(p.low)]
    z[len(p.low) + free] = found.z[len(p.low) :]
    left = p.hessian @ x + p.gradient + p.equations.T @ y + p.matrix.T @ z[: len(p.low)]
    y[pinning] = -left[p.pins[pinning]]
    primal, dual = _misses(p, x, y, z)
    return Answer(x, primal <= ACCEPTED and dual <= ACCEPTED, primal, dual, int(found.info.iter))


def _misses(program: Program, x: Array, y: Array, z: Array) -> tuple[float, float]:
    """Primal and dual miss; what is not finite counts as infinite."""
    p = program
    primal = max(
        outside(p.equations, p.right, p.right, x),
        outside(p.matrix, p.low, p.high, x),
        beyond(x, p.floor, p.ceiling),
    )
    dual = unbalanced(
        p.hessian, p.gradient, p.equations, p.matrix, p.low, p.high, p.floor, p.ceiling, x, y, z
    )  # fmt: skip
    return primal, dual
