"""Letting go: the overdamped way down from any start to a stance that stays, or to the reason there is none.

Motion is slow and damped, D z' = forces, with D a multiple of the inertia matrix, so that a light joint falls
as fast as a heavy one. Each implicit step is a linear complementarity problem in the multipliers of all
one-sided rows; a long step lands on the equilibrium of the linearised rover. Only stances that stay put are
found: the motion leaves the others.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.numerics import Array
from rover_pin.statics.lcp import lemke
from rover_pin.statics.newton import independent_rows
from rover_pin.statics.problem import Problem, State

if TYPE_CHECKING:
    from rover_pin.terrain import Terrain

STEPS = 400
DAMPING = 1e-3
TRUST = 0.1
UPRIGHT = np.radians(80.0)
FAR = 2.0 * np.pi


@dataclass(frozen=True)
class Rest:
    """Where the motion ended.

    Attributes:
        state: the equations there.
        multipliers: (m,) N >= 0 of the state's rows.
        pulls: (k,) of the loops.
        end: `rest`, `over` (tilt beyond 80 deg), `away` (a coordinate without bound), `lost` (no convergence).
        column: for `away`, the free coordinate that left.
    """

    state: State
    multipliers: Array
    pulls: Array
    end: str
    column: int = -1


def relax(problem: Problem, z: Array, terrain: Terrain, *, window: float, steps: int = STEPS) -> Rest:
    """Follow the damped motion from z until nothing moves.

    Args:
        problem: the rover.
        z: (n,) start; gaps and loops may be open, they are closed on the way.
        terrain: what it falls on.
        window: m; contacts of a shape within this of its least gap are rows too.
        steps: most steps.
    """
    start = z
    trust = TRUST
    kept = np.inf
    multipliers = np.zeros(0)
    pulls = np.zeros(problem.size_of_closure)
    state = problem.state(z, terrain, window)
    for count in range(steps):
        if len(multipliers) != len(state.slack):
            multipliers = np.zeros(len(state.slack))
        answer = _step(problem, state, terrain, multipliers, pulls, window)
        if answer is None:
            return Rest(state, multipliers, pulls, "lost")
        step, multipliers, pulls = answer
        size = float(np.max(np.abs(step) / problem.unit)) if len(step) else 0.0
        if size < 1e-10:
            return Rest(state, multipliers, pulls, "rest")
        if count and count % 40 == 0:
            if size > 0.5 * kept:
                trust *= 0.25
            kept = size
        z = state.z + step * min(1.0, trust / size)
        if problem.tilt(z) > UPRIGHT:
            return Rest(problem.state(z, terrain, window), multipliers, pulls, "over")
        travelled = np.abs(z - start) / problem.unit
        travelled[:3] = 0.0
        if np.max(travelled) > FAR:
            return Rest(state, multipliers, pulls, "away", int(np.argmax(travelled)))
        state = problem.state(z, terrain, window)
    return Rest(state, np.zeros(len(state.slack)), pulls, "lost")


def _step(
    problem: Problem, state: State, terrain: Terrain, multipliers: Array, pulls: Array, window: float
) -> tuple[Array, Array, Array] | None:
    """One implicit step: dz, N, loops' multipliers; None where the complementarity problem has no answer."""
    n = problem.n
    damping = DAMPING * problem.gravity / problem.span * problem.mass_matrix(state.at)
    damping += 1e-9 * np.diag(problem.weight * problem.span / problem.unit**2)
    matrix = damping
    if problem.elastics or np.count_nonzero(state.slack < 1e-3) + len(state.closure) < n:
        stiffness = problem.stiffness(state.z, terrain, multipliers, pulls, window)
        values, vectors = np.linalg.eigh((stiffness + stiffness.T) / 2.0)
        matrix = damping + (vectors * np.clip(values, 0.0, None)) @ vectors.T
    loops = independent_rows(state.closing)
    closing = state.closing[loops]
    size = len(loops)
    bordered = np.block([[matrix, -closing.T], [closing, np.zeros((size, size))]])
    right = np.zeros((n + size, 1 + len(state.slack)))
    right[:n, 0] = -state.load
    right[n:, 0] = -state.closure[loops]
    right[:n, 1:] = state.force.T
    try:
        response = np.linalg.solve(bordered, right)
    except np.linalg.LinAlgError:
        return None
    if not np.all(np.isfinite(response)):
        return None
    freely, by_force = response[:, 0], response[:, 1:]
    lcp = state.motion @ by_force[:n]
    lcp[np.diag_indices_from(lcp)] += 1e-12 * max(float(np.trace(lcp)), 1e-300)
    found, solved = lemke(lcp, state.slack + state.motion @ freely[:n], 50 + 20 * len(state.slack))
    if not solved:
        return None
    whole = freely + by_force @ found
    pulled = np.zeros(len(state.closure))
    pulled[loops] = whole[n:]
    return whole[:n], found, pulled
