"""From level ground to the terrain: the stance followed along h0 + s (h - h0), s from 0 to 1."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.numerics import Array
from rover_pin.statics.adapt import JUMP, NOT_NEGATIVE, adapted, stands
from rover_pin.statics.ground import (
    Footing,
    failed,
    let_go,
    support_name,
    supports,
    tipped,
)
from rover_pin.statics.loads import share_loads
from rover_pin.statics.newton import Landing, land
from rover_pin.statics.problem import THOROUGH, Integers, Problem
from rover_pin.statics.stance import Status
from rover_pin.statics.verdict import free_motions, steadiness, undetermined_joints

if TYPE_CHECKING:
    from rover_pin.terrain import Terrain

FALL = 0.05
"""Share of the span, and rad: a rover that lost a support and moved this far without a rest falls."""

WINDOW = 0.02
"""m: other places of a wheel that may come to touch within a step."""

NEAR = 2e-3
"""m or rad: supports this near may take over within a least step."""

FIRST_STEP = 0.25
LEAST_STEP = 1.0 / 256.0


def straight(problem: Problem, footing: Footing, z: Array, terrain: Terrain) -> Footing | None:
    """Newton straight to the terrain on the supports that carry on level ground.

    Taken only where those supports still carry, nothing else touches, and the branch did not fold on the way;
    else None, and the stance is followed.
    """
    landing = land(problem, z, terrain, footing.active, footing.loops, reach=JUMP * 2.0, iterations=9)
    if landing is not None and stands(problem, landing, footing.sign):
        return replace(footing, z=landing.z)
    if not problem.elastics:
        return None
    active = footing.active
    if landing is None or landing.sign != footing.sign:  # without what binds between bodies
        active = active[active < len(problem.rover.shapes)]
        landing = land(problem, z, terrain, active, footing.loops, reach=JUMP * 2.0, iterations=9)
    if landing is None:
        return None
    found = adapted(problem, z, terrain, active, footing.loops, landing)
    if found is None:
        return None
    return replace(footing, z=found.landing.z, active=found.active, sign=found.landing.sign)


def follow(
    problem: Problem, footing: Footing, z: Array, terrain: Terrain, level: float, *, steps: int | None = None
) -> Footing:
    """Raise the terrain from its level h0 to what it is, and the rover with it.

    A step that Newton cannot take on the same supports is shortened; at the least step the rover is let go
    and comes to rest on other supports, tips, or is lost. A far jump without any support letting go is the
    end of the branch: it tips.

    Args:
        problem: the rover, at its place.
        footing: the stance on level ground.
        z: (n,) its coordinates at height h0.
        terrain: the terrain.
        level: h0, m.
        steps: fixed number of steps instead of adapted ones.
    """
    s, step = 0.0, FIRST_STEP if steps is None else 1.0 / steps
    least = LEAST_STEP if steps is None else step
    current = replace(footing, z=z)
    count = 0
    while s < 1.0:
        count += 1
        if count > 4000:
            return failed(
                current.z, Status.NO_CONVERGENCE, None, "the stance could not be followed to the end"
            )
        target = 1.0 if s + step > 1.0 - 1e-12 else s + step
        raised = terrain if target == 1.0 else terrain.blended(level, target)
        landing = land(problem, current.z, raised, current.active, current.loops, window=THOROUGH, reach=JUMP)
        if landing is not None and stands(problem, landing, current.sign):
            current = replace(current, z=landing.z)
            s = target
            if steps is None:
                step = min(2.0 * step, FIRST_STEP)
            continue
        if step > least:
            step = max(step / 4.0, least)
            continue
        before = terrain.blended(level, s)
        following = _let_go(problem, current, before, raised, landing)
        if following.status is not Status.SETTLED:
            return following
        current, s = following, target
    return current


def _let_go(
    problem: Problem, current: Footing, before: Terrain, terrain: Terrain, landing: Landing | None
) -> Footing:
    """Supports change, or the branch ends: find out by letting the rover fall.

    A joint that nothing determined before may swing as far as it likes: that is no end of a branch.
    """
    lost = None
    if landing is not None and np.min(landing.multipliers, initial=0.0) < NOT_NEGATIVE * problem.weight:
        lost = support_name(problem, landing.state, int(np.argmin(landing.multipliers)))
    exchanged = _exchange(problem, current, terrain)
    if exchanged is not None:
        return exchanged
    found = let_go(problem, current.z, terrain, WINDOW, lost)
    fell = float(np.max(np.abs(found.z - current.z) / problem.unit)) > FALL
    if found.status is Status.NO_CONVERGENCE and lost is not None and fell:
        return tipped(problem, found.z, lost)
    if found.status is not Status.SETTLED:
        if found.limiting is None and found.status is Status.TIPS:
            return tipped(problem, found.z, _most_moved(problem, current.z, found.z))
        return found
    moved = np.abs(found.z - current.z) / problem.unit
    if np.max(moved) > JUMP:
        moved[_undetermined(problem, current, before)] = 0.0
    if np.max(moved) > JUMP:
        return tipped(problem, found.z, lost or _most_moved(problem, current.z, found.z))
    return found


def _exchange(problem: Problem, current: Footing, terrain: Terrain) -> Footing | None:
    """Another set of the supports that touch, or are about to, on which the rover stands just as well."""
    state = problem.state(current.z, terrain, THOROUGH)
    near = np.flatnonzero(state.slack < NEAR)
    if len(near) + len(current.loops) < problem.n:
        return None
    active = supports(problem, state, near, np.arange(len(state.slack)))
    landing = land(problem, current.z, terrain, active, current.loops, window=THOROUGH, reach=JUMP)
    if landing is None or not stands(problem, landing, landing.sign):
        return None
    return replace(current, z=landing.z, active=active, sign=landing.sign)


def _undetermined(problem: Problem, current: Footing, terrain: Terrain) -> Integers:
    """Free coordinates that nothing determines at a stance."""
    if len(current.active) + len(current.loops) >= problem.n:
        return np.zeros(0, dtype=np.int64)
    state = problem.state(current.z, terrain, window=1e-5)
    loads = share_loads(problem, state)
    motions = free_motions(state, loads, problem)
    if not motions.shape[1]:
        return np.zeros(0, dtype=np.int64)
    names = undetermined_joints(problem, motions, steadiness(problem, state, loads, terrain, motions))
    columns = {problem.rover.column[name] for name in names}
    return np.array([i for i, c in enumerate(problem.reduction.columns) if c in columns], dtype=np.int64)


def _most_moved(problem: Problem, before: Array, after: Array) -> str | None:
    """The passive joint that moved most, or None where only the base did."""
    moved = np.abs(after - before) / problem.unit
    moved[:3] = 0.0
    if not np.any(moved > 1e-3):
        return None
    column = problem.reduction.columns[int(np.argmax(moved))]
    return problem.rover.dof_names[column]
