"""Forces with one ratio of rolling to normal force at every driven or braked wheel."""

from __future__ import annotations

from typing import Literal

import numpy as np

from rover_pin.numerics import Array
from rover_pin.statics.cone_program import ConeProgram
from rover_pin.statics.force_space import ForceSpace

_STEPS = 100
_CLOSE = 1e-9


def traction_ratio(
    space: ForceSpace, rolls: Array, normals: Array
) -> tuple[Literal["found", "infeasible", "failed"], float, Array]:
    """Equilibrium with rolling_i = k normal_i, lateral forces free, normals not negative.

    Where that leaves a choice (lateral forces nearly always, k where wheels are steered apart) it takes
    the least sum of squares of all contact forces. The product k normal_i is linearised about the last
    iterate and the quadratic program solved again until it stays: Newton's method on the
    equilibrium where that determines k (3 to 6 steps), slower where k is a choice.

    Args:
        space: the forces in equilibrium, units of the weight.
        rolls: (k,) bool; contacts that have a rolling direction and can use it.
        normals: (k,) normal forces to start from, units of the weight.

    Returns:
        how it ended; k [-]; forces (3k + o,) in units of the weight.

    Cost: 3 to 6 quadratic programs of 0.3 ms with six wheels.
    """
    count = space.contacts
    nothing = np.full(space.particular.size, np.nan)
    if not space.consistent or count == 0:
        return "infeasible", np.nan, nothing
    d = space.basis.shape[1]
    rolling, normal = 3 * np.flatnonzero(rolls) + 1, 3 * np.flatnonzero(rolls)
    quadratic = np.zeros((d + 1, d + 1))
    forces = space.basis[: 3 * count]
    quadratic[:d, :d] = forces.T @ forces
    cost = np.append(forces.T @ space.particular[: 3 * count], 0.0)
    pushing = space.pushing()
    at_least = np.hstack([space.basis[pushing], np.zeros((len(pushing), 1))])
    if not rolls.any():
        quadratic[d, d] = 1.0

    ratio, solution, last = 0.0, nothing, normals[rolls]
    for _ in range(_STEPS):
        slopes = space.basis[rolling] - ratio * space.basis[normal]
        level = ratio * space.particular[normal] - space.particular[rolling] - ratio * last
        answer = ConeProgram(
            cost=cost,
            quadratic=quadratic,
            equal=np.column_stack([slopes, -last]),
            level=level,
            at_least=at_least,
            base=space.particular[pushing],
        ).solve()
        if answer.outcome != "solved":
            return ("infeasible" if answer.outcome == "infeasible" else "failed"), np.nan, nothing
        before, solution = solution, space.particular + space.basis @ answer.x[:d]
        ratio, last = float(answer.x[d]), solution[normal]
        gap = float(np.max(np.abs(solution[rolling] - ratio * last), initial=0.0))
        moved = float(np.max(np.abs(solution - before)))
        if gap <= _CLOSE and (moved <= _CLOSE or not rolls.any()):
            return "found", ratio, solution
    return "failed", np.nan, nothing
