"""Contact forces with friction, by a stated rule: with traction allowed the loads are not unique."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

import numpy as np

from rover_pin.errors import InputError, nearest
from rover_pin.numerics import Array
from rover_pin.statics.forces import Forces, ForceStatus, forces_of, no_forces
from rover_pin.statics.friction_problem import FrictionProblem, friction_problem
from rover_pin.statics.least_friction import least_friction
from rover_pin.statics.least_torque import least_torque
from rover_pin.statics.stance import Stance
from rover_pin.statics.traction_ratio import traction_ratio

_UNBALANCED = "no contact forces of any size balance the weight"


def vertical(problem: FrictionProblem) -> Forces:
    """Every force against gravity: the stance's own loads. No solve; 0.8 ms with six wheels."""
    loads = np.array([c.load for c in problem.contacts])
    return forces_of(problem, "vertical", loads[:, None] * problem.frames[:, :, 2])


def ratio(problem: FrictionProblem) -> Forces:
    """One k of rolling to normal force at all wheels that are not free; about 2 ms with six wheels."""
    rolls = np.array([bool(c.rolling.any()) and not c.free for c in problem.contacts], dtype=bool)
    normals = np.array([c.load for c in problem.contacts]) * problem.frames[:, 0, 2] / problem.weight
    outcome, k, forces = traction_ratio(problem.space, rolls, normals)
    if outcome != "found":
        return _none(problem, "ratio", outcome, "no single ratio of rolling to normal force holds the rover")
    return forces_of(problem, "ratio", _newtons(problem, forces), k=k)


def smallest_friction(problem: FrictionProblem) -> Forces:
    """The forces whose largest |tangential| / normal is least; 3 ms with six wheels.

    Where the contacts' frictions differ, what is made least is the excess over them:
    |tangential_i| <= (friction_i + e) normal_i. Within 1e-7 of the exact cone's answer.
    """
    found = least_friction(problem.space, problem.friction, start=_vertical_excess(problem))
    if found.outcome != "found":
        reason = _UNBALANCED if not problem.space.consistent else "no friction holds the rover"
        return _none(problem, "least_friction", found.outcome, reason)
    return forces_of(problem, "least_friction", _newtons(problem, found.forces))


def smallest_torque(problem: FrictionProblem) -> Forces:
    """The forces within friction whose largest torque of a driven wheel is least; 1.7 ms with six wheels."""
    wheels = sorted({c.wheel for c in problem.contacts} & problem.driven)
    levers = np.array(
        [[c.radius if c.wheel == wheel else 0.0 for c in problem.contacts] for wheel in wheels], dtype=float
    ).reshape(len(wheels), len(problem.contacts))
    outcome, _, forces = least_torque(problem.space, problem.friction, levers)
    if outcome != "found":
        return _none(problem, "least_torque", outcome, "no forces within the friction hold the rover")
    return forces_of(problem, "least_torque", _newtons(problem, forces))


RULES: dict[str, Callable[[FrictionProblem], Forces]] = {
    "vertical": vertical,
    "ratio": ratio,
    "least_friction": smallest_friction,
    "least_torque": smallest_torque,
}


def distribute(stance: Stance, friction: float | None = None, rule: str = "vertical") -> Forces:
    """Contact forces that hold a stance, by a rule, the passive joints' equilibrium included.

    Normal forces never pull, a wheel marked `free` carries no rolling force, and friction is the exact
    cone |tangential| <= friction normal.

    Rules:
        vertical: every force against gravity; the stance's own loads.
        ratio: rolling = k normal along each wheel's rolling direction with one k, lateral forces free,
            least sum of squares where that leaves a choice.
        least_friction: the largest |tangential| / normal is least (Thueer et al. 2006).
        least_torque: within friction, the largest torque of a driven wheel is least (Noble and Issac 2019).

    Args:
        stance: a settled stance.
        friction: coefficient at every contact; None takes what each shape declares.
        rule: one of the above.

    Returns:
        forces, with a status that says whether friction holds them.

    Raises:
        InputError: the stance is not settled, the friction is not above 0, or the rule is unknown.
    """
    if rule not in RULES:
        raise InputError("no such rule", element="rule", value=rule, cure=nearest(str(rule), RULES))
    return RULES[rule](friction_problem(stance, friction))


def _newtons(problem: FrictionProblem, forces: Array) -> Array:
    return forces[: 3 * len(problem.contacts)].reshape(-1, 3) * problem.weight


def _vertical_excess(problem: FrictionProblem) -> float:
    """What friction vertical forces ask for beyond what there is: where the search starts."""
    upward = problem.frames[:, :, 2]
    loaded = np.array([c.load > 0.0 for c in problem.contacts], dtype=bool) & (upward[:, 0] > 1e-3)
    if not loaded.any():
        return 0.0
    asked = np.hypot(upward[:, 1], upward[:, 2]) / np.where(loaded, upward[:, 0], 1.0)
    return float(np.max((asked - problem.friction)[loaded]))


def _none(
    problem: FrictionProblem, rule: str, outcome: Literal["infeasible", "failed", "found"], why: str
) -> Forces:
    if outcome == "failed":
        return no_forces(
            problem, rule, ForceStatus.NO_CONVERGENCE, "the solver found no answer it could prove"
        )
    return no_forces(problem, rule, ForceStatus.INFEASIBLE, why if problem.space.consistent else _UNBALANCED)
