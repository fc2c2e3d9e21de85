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

from rover_pin.numerics import Array, null_space
from rover_pin.statics.lcp import lemke
from rover_pin.statics.newton import independent_rows
from rover_pin.statics.problem import Problem, State

if TYPE_CHECKING:
    from rover_pin.terrain import Terrain

STEPS = 400
DAMPING = 1e-3
LEAST_DAMPING = 1e-6
MOST_DAMPING = 100.0
"""Shares of the damping at which a body falls its own span in a step under its weight.

Steady motion is given longer steps; a reversal, shorter and stiffer ones.
"""
TRUST = 0.1
RESTING = 1e-7
"""Share of the span, or rad: what moves less rests, and Newton takes the last step."""
UPRIGHT = np.radians(80.0)
SOFTNESS = 1e-12
"""Give of a support, as a share of the give of the whole rover, which shares loads that are redundant."""
FAR = 2.0 * np.pi


@dataclass(frozen=True)
class Rest:
    """Where the motion ended.

    Attributes:
        state: the equations there.
        multipliers: (m,) N >= 0 of the state's rows.
        pulls: (k,) of the loops.
        end: `rest`, `over` (tilt beyond 80 deg), `away` (a coordinate without bound), `lost` (unsolved).
        column: for `away`, the free coordinate that left.
    """

    state: State
    multipliers: Array
    pulls: Array
    end: str
    column: int = -1


def relax(
    problem: Problem,
    z: Array,
    terrain: Terrain,
    *,
    window: float,
    steps: int = STEPS,
    resting: float = RESTING,
    far: float = FAR,
) -> Rest:
    """Follow the damped motion from z until nothing moves.

    Args:
        problem: the rover.
        z: (n,) start; gaps and loops may be open, they are closed on the way.
        terrain: what it falls on.
        window: m; contacts of a shape within this of its least gap are rows too.
        steps: most steps.
        resting: share of the span, or rad; a step below this is rest.
        far: shares of the span, or rad; a joint that moves further is lost.
    """
    start = z
    trust, damping = TRUST, DAMPING
    last = np.zeros(problem.n)
    multipliers = np.zeros(0)
    pulls = np.zeros(problem.size_of_closure)
    state = problem.state(z, terrain, window)
    for _ in range(steps):
        if len(multipliers) != len(state.slack):
            multipliers = np.zeros(len(state.slack))
        answer = _step(problem, state, terrain, multipliers, pulls, window, damping)
        if answer is None:
            if damping >= MOST_DAMPING:
                return Rest(state, multipliers, pulls, "lost")
            damping = min(100.0 * damping, MOST_DAMPING)
            continue
        step, multipliers, pulls = answer
        size = float(np.max(np.abs(step) / problem.unit)) if len(step) else 0.0
        if size < resting:
            return Rest(state, multipliers, pulls, "rest")
        move = step * min(1.0, trust / size)
        turned = float((move / problem.unit) @ (last / problem.unit))
        if turned < 0.0:
            trust, damping = max(0.5 * trust, 1e-3 * TRUST), max(damping, min(4.0 * damping, DAMPING))
        elif size > 2.0 * TRUST:
            damping = min(damping * size / TRUST, MOST_DAMPING)
        elif turned > 0.0:
            trust, damping = min(1.5 * trust, TRUST), max(0.25 * damping, LEAST_DAMPING)
        last = move
        z = state.z + move
        if problem.tilt(z) > UPRIGHT:
            return Rest(problem.state(z, terrain, window), multipliers, pulls, "over")
        travelled = np.abs(z - start) / problem.unit
        travelled[:3] = 0.0
        if np.max(travelled) > far:
            return Rest(state, multipliers, pulls, "away", int(np.argmax(travelled)))
        state = problem.state(z, terrain, window)
    if len(multipliers) != len(state.slack):
        multipliers = np.zeros(len(state.slack))
    return Rest(state, multipliers, pulls, "lost")


def _step(
    problem: Problem,
    state: State,
    terrain: Terrain,
    multipliers: Array,
    pulls: Array,
    window: float,
    drag: float,
) -> tuple[Array, Array, Array] | None:
    """One implicit step: dz, N, loops' multipliers; None where the complementarity problem has no answer."""
    n = problem.n
    damping = drag * problem.gravity / problem.span * problem.mass_matrix(state.at)
    damping += 1e-9 * np.diag(problem.weight * problem.span / problem.unit**2)
    matrix = damping
    if problem.elastics or np.count_nonzero(state.slack < 1e-3) + len(state.closure) < n:
        matrix = damping + _resistance(problem, state, terrain, multipliers, pulls, window)
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
    scale = 1.0 / np.sqrt(np.maximum(np.abs(np.diag(lcp)), 1e-300))
    lcp = lcp * np.outer(scale, scale)
    lcp[np.diag_indices_from(lcp)] += SOFTNESS
    found, solved = lemke(lcp, scale * (state.slack + state.motion @ freely[:n]), 50 + 20 * len(state.slack))
    if not solved:
        return None
    found = found * scale
    whole = freely + by_force @ found
    pulled = np.zeros(len(state.closure))
    pulled[loops] = whole[n:]
    return whole[:n], found, pulled


def _resistance(
    problem: Problem, state: State, terrain: Terrain, multipliers: Array, pulls: Array, window: float
) -> Array:
    """(n, n) stiffness along the motions that the carrying supports leave free; what pushes on is left out.

    The weight on its supports makes the whole matrix indefinite; only its part along free motions says
    whether a motion is resisted.
    """
    unit = problem.unit
    rows = np.vstack([state.motion[multipliers > 0.0], state.closing]) * unit
    free = null_space(rows) if len(rows) else np.eye(problem.n)
    if free.shape[1] == 0:
        return np.zeros((problem.n, problem.n))
    stiffness = problem.stiffness(state, terrain, multipliers, pulls, window) * np.outer(unit, unit)
    along = free.T @ (stiffness + stiffness.T) @ free / 2.0
    values, vectors = np.linalg.eigh(along)
    held: Array = free @ (vectors * np.clip(values, 0.0, None)) @ vectors.T @ free.T / np.outer(unit, unit)
    return held
