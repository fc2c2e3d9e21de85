"""How much and how little each wheel can carry."""

from __future__ import annotations

import numpy as np

from rover_pin.errors import SolverError
from rover_pin.numerics import Array
from rover_pin.statics.cone_program import ConeProgram
from rover_pin.statics.friction_problem import FrictionProblem, friction_problem
from rover_pin.statics.least_torque import friction_cones
from rover_pin.statics.stance import Stance

Interval = tuple[float, float]


def load_bounds(stance: Stance, friction: float | None = None) -> dict[str, Interval]:
    """Least and largest load of each wheel over all forces that hold the stance within friction.

    A wheel's load is the sum of its contacts' forces against gravity, as in `stance.loads`. Friction is the
    exact cone, the passive joints' equilibrium is included, free wheels carry no rolling force. A load
    that wheels can raise without bound by bracing against each other is inf. Where friction cannot hold
    the rover at all there is no load, and both ends are NaN.

    Args:
        stance: a settled stance.
        friction: coefficient at every contact; None takes what each shape declares.

    Returns:
        per wheel or foot of the rover that touches, (least, largest) N.

    Raises:
        InputError: the stance is not settled, or the friction is not above 0.
        SolverError: a program had no answer that could be proven.

    Cost: two cone programs a wheel, 4 ms with six wheels.
    """
    return problem_bounds(friction_problem(stance, friction))


def problem_bounds(problem: FrictionProblem) -> dict[str, Interval]:
    """The load intervals of a problem; see `load_bounds`."""
    wheels = list(dict.fromkeys(c.wheel for c in problem.contacts))
    space = problem.space
    if not wheels or not space.consistent:
        return dict.fromkeys(wheels, (float("nan"), float("nan")))
    d = space.basis.shape[1]
    cones, offset = friction_cones(space, problem.friction)
    pushing = space.pushing()
    program = ConeProgram(
        cost=np.zeros(d),
        at_least=space.basis[pushing],
        base=space.particular[pushing],
        cones=cones,
        offset=offset,
    )
    bounds: dict[str, Interval] = {}
    for wheel in wheels:
        upward = np.zeros(space.particular.size)
        for i, contact in enumerate(problem.contacts):
            if contact.wheel == wheel:
                upward[3 * i : 3 * i + 3] = problem.frames[i, :, 2]
        cost, constant = upward @ space.basis, float(upward @ space.particular)
        least = _extreme(program, cost, constant)
        largest = -_extreme(program, -cost, -constant)
        bounds[wheel] = (float(least * problem.weight), float(largest * problem.weight))
    return bounds


def _extreme(program: ConeProgram, cost: Array, constant: float) -> float:
    """The least cost, -inf where there is none, NaN where nothing is feasible."""
    program.set_cost(cost)
    answer = program.solve()
    if answer.outcome == "unbounded":
        return -float("inf")
    if answer.outcome == "infeasible":
        return float("nan")
    if answer.outcome == "failed":
        raise SolverError("no proven answer for a load's bound", problem=program.__dict__)
    return answer.value + constant
