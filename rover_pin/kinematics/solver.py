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
    n, e, m = len(program.gradient), len(program.right), len(program.low)
    qp = proxqp.dense.QP(
        n, e, m, True, proxqp.dense.HessianType.Dense, proxqp.dense.DenseBackend.PrimalDualLDLT
    )
    settings = qp.settings
    settings.initial_guess = guess
    settings.max_iter = iterations
    settings.max_iter_in = ITERATIONS
    settings.eps_abs = PRECISION
    settings.eps_rel = 0.0
    qp.init(
        program.hessian, program.gradient, program.equations, program.right, program.matrix,
        np.maximum(program.low, -OPEN), np.minimum(program.high, OPEN),
        np.maximum(program.floor, -OPEN), np.minimum(program.ceiling, OPEN),
    )  # fmt: skip
    qp.solve()
    found = qp.results
    x = np.array(found.x)
    primal, dual = _misses(program, x, np.array(found.y), np.array(found.z))
    good = primal <= ACCEPTED and dual <= ACCEPTED
    return Answer(x, bool(good), primal, dual, int(found.info.iter))


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
