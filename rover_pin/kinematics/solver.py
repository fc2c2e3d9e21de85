"""ProxQP on the program of a step: capped, and believed only after its conditions were worked out again.

Every program is set up anew: warm starts have sent the solver on long ways where matrices change, and the
same instant must give the same answer, but for rounding, whatever was solved before.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from proxsuite import proxqp

from rover_pin.kinematics.instant import Integers
from rover_pin.kinematics.kernels import finished, reduce
from rover_pin.kinematics.program import Program, refuse
from rover_pin.numerics import Array

PRECISION = 1e-9
ACCEPTED = 1e-7
"""m/s or rad/s that rows may be missed by; share of the gradient's size that stationarity may."""


@dataclass(frozen=True)
class Manner:
    """How the solver is called.

    Attributes:
        weight: times the cost. Its precision is absolute: at 1 it leaves vague what damping alone decides, at
            1000 it fails where tasks ask for a thousand times what limits allow.
        softness: of equations in the first step. With the solver's own default, 1e-3, wishes of unlike
            weights take ten steps and more; with ten thousand times less most programs take one.
        scaled: whether the solver brings the rows to one scale first.
        guess: where it starts.
        steps: most outer iterations, and inner ones of each. What can be solved takes 40 in all, seldom more;
            without a cap infeasible steps have taken ten thousand.
    """

    weight: float
    softness: float
    scaled: bool
    guess: Any
    steps: tuple[int, int]


USUAL = Manner(1e2, 1e-7, False, proxqp.InitialGuess.EQUALITY_CONSTRAINED_INITIAL_GUESS, (40, 6))
PATIENT = (
    Manner(1e3, 1e-7, True, proxqp.InitialGuess.EQUALITY_CONSTRAINED_INITIAL_GUESS, (40, 6)),
    Manner(1.0, 1e-3, True, proxqp.InitialGuess.NO_INITIAL_GUESS, (200, 100)),
)
"""Tried in turn where the usual one fails."""

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
    return _attempt(program, USUAL)


def solve_patiently(program: Program) -> Answer:
    """The same in manners that bear more: for what is not known to be infeasible."""
    for manner in PATIENT:
        answer = _attempt(program, manner)
        if answer.solved:
            break
    return answer


def _attempt(program: Program, manner: Manner) -> Answer:
    """Solve for the coordinates that no equation pins."""
    p = program
    good, free, rest, *parts = reduce(
        p.hessian, p.gradient, p.equations, p.right, p.matrix, p.low, p.high, p.floor, p.ceiling, p.pins, OPEN
    )
    if not good:
        refuse(p)
    if not len(free):
        return _checked(p, free, rest, (np.zeros(0), np.zeros(len(rest)), np.zeros(len(p.low))), 1.0, 0)
    qp = proxqp.dense.QP(len(free), len(rest), len(p.low), True, _DENSE, _BACKEND)
    settings = qp.settings
    settings.initial_guess = manner.guess
    settings.max_iter, settings.max_iter_in = manner.steps
    settings.eps_abs = PRECISION
    settings.eps_rel = 0.0
    settings.default_mu_eq = manner.softness
    weight = manner.weight
    parts[0] *= weight
    parts[1] *= weight
    qp.init(*parts, compute_preconditioner=manner.scaled)
    qp.solve()
    found = qp.results
    return _checked(p, free, rest, (found.x, found.y, found.z), weight, int(found.info.iter))


def _checked(
    p: Program, free: Integers, rest: Integers, found: tuple[Array, Array, Array], weight: float, steps: int
) -> Answer:
    """The whole program's answer, its conditions worked out again."""
    x, primal, dual = finished(
        p.hessian, p.gradient, p.equations, p.right, p.matrix, p.low, p.high, p.floor, p.ceiling, p.pins,
        free, rest, *found, weight,
    )  # fmt: skip
    return Answer(x, primal <= ACCEPTED and dual <= ACCEPTED, primal, dual, steps)


_DENSE = proxqp.dense.HessianType.Dense
_BACKEND = proxqp.dense.DenseBackend.PrimalDualLDLT
