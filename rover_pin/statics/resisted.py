"""A stance against a motion resistance: the share of load that every contact pulls with, found by itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from rover_pin.statics.adapt import JUMP, adapted, stands
from rover_pin.statics.ground import Footing, failed
from rover_pin.statics.loads import share_loads
from rover_pin.statics.newton import land
from rover_pin.statics.problem import Problem
from rover_pin.statics.resistance import Resistance
from rover_pin.statics.stance import Status
from rover_pin.terrain import Terrain

ROUNDS = 40
SETTLED = 1e-13
"""Change of the ratio below which it is found."""


def against(problem: Problem, footing: Footing, terrain: Terrain, force: float) -> tuple[Problem, Footing]:
    """The stance of a rover that moves slowly against a force, from the one at rest.

    The ratio k of tangential to vertical forces is what balances the force along the heading; on level ground
    it is the force over the weight. Loads and k are found in turns.

    Args:
        problem: the rover, at its place.
        footing: how it stands there at rest.
        terrain: what it stands on.
        force: N, against the heading.

    Returns:
        The problem with the resistance on it, and the footing.

    Raises:
        InputError: a track that no wheel drives.
    """
    yaw = float(problem.reduction.offset[3])
    resistance = Resistance(problem.rover, force, yaw, abs(force) / problem.weight)
    resistance.check()
    for _ in range(ROUNDS):
        problem = problem.resisted(resistance)
        moved = _land(problem, footing, terrain)
        if moved is None:
            reason = f"no stance was found against a motion resistance of {force:g} N"
            return problem, failed(footing.z, Status.NO_CONVERGENCE, None, reason)
        footing = moved
        ratio = _ratio(problem, resistance, footing, terrain)
        if ratio is None:
            reason = f"no contact can pull against a motion resistance of {force:g} N"
            return problem, failed(footing.z, Status.NO_CONVERGENCE, None, reason)
        if abs(ratio - resistance.ratio) <= SETTLED * max(ratio, 1.0):
            return problem, footing
        resistance = replace(resistance, ratio=ratio)
    reason = f"the tractions against a motion resistance of {force:g} N do not settle"
    return problem, failed(footing.z, Status.NO_CONVERGENCE, None, reason)


def _land(problem: Problem, footing: Footing, terrain: Terrain) -> Footing | None:
    landing = land(problem, footing.z, terrain, footing.active, footing.loops, reach=JUMP)
    if landing is None:
        return None
    if stands(problem, landing, landing.sign):
        return replace(footing, z=landing.z, sign=landing.sign)
    found = adapted(problem, footing.z, terrain, footing.active, footing.loops, landing)
    if found is None:
        return None
    return replace(footing, z=found.landing.z, active=found.active, sign=found.landing.sign)


def _ratio(problem: Problem, resistance: Resistance, footing: Footing, terrain: Terrain) -> float | None:
    """k that balances the resistance with the loads of a pose; None where nothing pulls along the heading."""
    state = problem.state(footing.z, terrain, 1e-5)
    loads = share_loads(problem, state)
    count = len(state.owners)
    tangents = resistance.tangents(state.at, state.owners, state.contacts[:, 4:7])
    along = float(np.sum(loads.multipliers[:count] * (tangents @ resistance.heading)))
    return abs(resistance.force) / along if along > 1e-9 * problem.weight else None
