"""ProxQP on the program of a step: capped, and believed only after its conditions were worked out again.

Every program is set up anew: warm starts have sent the solver on long ways where matrices change, and the
same instant must give the same answer whatever was solved before.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from proxsuite import proxqp

from rover_pin.kinematics.instant import Integers
from rover_pin.kinematics.kernels import beyond, expand, outside, reduce, unbalanced
from rover_pin.kinematics.program import Program, refuse
from rover_pin.numerics import Array

ITERATIONS = 100
PATIENCE = 10
PRECISION = 1e-9
ACCEPTED = 1e-7
"""m/s or rad/s that rows may be missed by; share of the gradient's size that stationarity may."""

WEIGHT = 1e2
"""Times the cost: the solver's precision is absolute, and what damping alone decides would be left vague."""

SOFTNESS = 1e-7
"""Of equations in the solver's first step: ten thousand times less than its own default, with which wishes of
unlike weights take ten steps and more; with this most programs take one."""

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
    """The least of the program, or the best that came out, marked as not solved.

    Raises:
        InputError: an entry that is not finite, or a side that is no number; named by its row.
    """
    return _attempt(program, proxqp.InitialGuess.EQUALITY_CONSTRAINED_INITIAL_GUESS, ITERATIONS)


def solve_patiently(program: Program) -> Answer:
    """The same from another start with more iterations: for a program that is known not to be infeasible."""
    return _attempt(program, proxqp.InitialGuess.NO_INITIAL_GUESS, PATIENCE * ITERATIONS)


def _attempt(program: Program, guess: Any, iterations: int) -> Answer:
    """Solve for the coordinates that no equation pins."""
    p = program
    good, free, rest, *parts = reduce(
        p.hessian, p.gradient, p.equations, p.right, p.matrix, p.low, p.high, p.floor, p.ceiling, p.pins, OPEN
    )
    if not good:
        refuse(p)
    if not len(free):
        return _checked(p, free, rest, np.zeros(0), np.zeros(len(rest)), np.zeros(len(p.low)), 0)
    qp = proxqp.dense.QP(len(free), len(rest), len(p.low), True, _DENSE, _BACKEND)
    settings = qp.settings
    settings.initial_guess = guess
    settings.max_iter = iterations
    settings.max_iter_in = ITERATIONS
    settings.eps_abs = PRECISION
    settings.eps_rel = 0.0
    settings.default_mu_eq = SOFTNESS
    parts[0] *= WEIGHT
    parts[1] *= WEIGHT
    qp.init(*parts, compute_preconditioner=False)
    qp.solve()
    found = qp.results
    return _checked(p, free, rest, found.x, found.y / WEIGHT, found.z / WEIGHT, int(found.info.iter))


def _checked(
    p: Program, free: Integers, rest: Integers, part: Array, y_part: Array, z_part: Array, iterations: int
) -> Answer:
    """The whole program's answer, its conditions worked out again."""
    x, y, z = expand(
        p.hessian, p.gradient, p.equations, p.right, p.matrix, p.pins, free, rest, part, y_part, z_part
    )
    primal = max(
        outside(p.equations, p.right, p.right, x),
        outside(p.matrix, p.low, p.high, x),
        beyond(x, p.floor, p.ceiling),
    )
    dual = unbalanced(
        p.hessian, p.gradient, p.equations, p.matrix, p.low, p.high, p.floor, p.ceiling, x, y, z
    )  # fmt: skip
    return Answer(x, primal <= ACCEPTED and dual <= ACCEPTED, primal, dual, iterations)


_DENSE = proxqp.dense.HessianType.Dense
_BACKEND = proxqp.dense.DenseBackend.PrimalDualLDLT
