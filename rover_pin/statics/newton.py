"""Newton on a set of supports taken as touching: the fast way to a stance, and the last step of every way."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.linalg import qr
from scipy.linalg.lapack import dgetrf, dgetrs

from rover_pin.numerics import Array
from rover_pin.statics.problem import Integers, Problem, State

if TYPE_CHECKING:
    from rover_pin.terrain import Terrain

ITERATIONS = 25
STEP = 1e-7
"""Share of the span, or rad: Newton squares its error, so the step that is this small is the last."""

DETERMINED = 1e-6
"""Least over largest pivot above which a system is solved without looking for its null space."""

BALANCE = 1e-6
"""Share of weight times span that may stay out of balance after the last step."""


@dataclass(frozen=True)
class Landing:
    """Where Newton came to rest.

    Attributes:
        z: (n,) where it landed.
        state: the equations one last step before it, at most `STEP` away.
        active: rows of the state taken as touching.
        multipliers: (m,) N of all rows, zero where not active.
        pulls: (k,) multipliers of the loops, zero for redundant rows.
        sign: sign of the determinant of the bordered system, which changes where a branch folds.
    """

    z: Array
    state: State
    active: Integers
    multipliers: Array
    pulls: Array
    sign: float


def independent_rows(rows: Array, tolerance: float = 1e-9) -> Integers:
    """Indices of a largest set of independent rows, by pivoted QR."""
    if rows.shape[0] == 0:
        return np.zeros(0, dtype=np.int64)
    triangle, order = qr(rows.T, mode="r", pivoting=True)
    diagonal = np.abs(np.diag(triangle))
    rank = int(np.sum(diagonal > tolerance * max(diagonal[0], 1e-300))) if diagonal[0] > 0.0 else 0
    return np.sort(np.asarray(order[:rank], dtype=np.int64))


def land(
    problem: Problem,
    z: Array,
    terrain: Terrain,
    active: Integers,
    loops: Integers,
    *,
    window: float = 0.0,
    reach: float = 1.0,
    iterations: int = ITERATIONS,
) -> Landing | None:
    """Newton's method on equilibrium, the active gaps and the loops.

    Where the active supports and loops alone determine the pose, the stiffness does not matter and is not
    computed. Returns None where it does not converge, or moves further than `reach`.

    Args:
        problem: the rover.
        z: (n,) start.
        terrain: what it stands on.
        active: rows of the state to hold at zero.
        loops: independent loop rows.
        window: of the states.
        reach: largest sum of steps, as a share of the wheels' span and in rad.
        iterations: most steps.
    """
    held = len(active) + len(loops)
    if held > problem.n:
        return None
    determinate = held == problem.n
    start, size = z, -1
    touching = active[active < len(problem.rover.shapes)]
    pushed: Array
    forces: Array = np.zeros(held)
    if not determinate:
        state = problem.state(z, terrain, window, only=touching)
        forces = _first_guess(state, active, loops, problem)
    for i in range(iterations):
        if determinate or i > 0:
            state = problem.state(z, terrain, window, only=touching)
        if size >= 0 and len(state.slack) != size:
            return None
        size = len(state.slack)
        rows = _together(state.motion, active, state.closing, loops)
        gaps = _together(state.slack, active, state.closure, loops)
        sides = _together(state.force, active, state.closing, loops)
        try:
            if determinate:
                step, pushed = np.linalg.solve(rows, -gaps), np.zeros(held)
            else:
                full, pulling = _spread(state, active, loops, forces)
                stiffness = problem.stiffness(state, terrain, full, pulling, window)
                step, forces = _elastic_step(problem, state, stiffness, rows, sides, gaps, forces)
                pushed = np.asarray(stiffness @ step, dtype=np.float64)
            largest = float(np.max(np.abs(step) / problem.unit))
            if determinate and largest < STEP:
                forces = np.asarray(np.linalg.solve(sides.T, state.load), dtype=np.float64)
        except np.linalg.LinAlgError:
            return None
        moved = float(np.max(np.abs(z + step - start) / problem.unit))
        if not (moved <= reach and np.all(np.isfinite(forces))):
            return None
        if largest < STEP:
            rest = np.max(np.abs(state.load + pushed - sides.T @ forces) * problem.unit)
            if rest > BALANCE * problem.weight * problem.span:
                return None
            problem.look_at_others(state, terrain, window)
            full, pulling = _spread(state, active, loops, forces)
            sign = float(np.linalg.slogdet(rows)[0]) if determinate else 0.0
            return Landing(z + step, state, active, full, pulling, sign)
        z = z + step
    return None


def _together(supports: Array, active: Integers, closing: Array, loops: Integers) -> Array:
    """Rows of the active supports, then of the loops."""
    chosen = supports[active]
    return np.concatenate([chosen, closing[loops]]) if len(loops) else chosen


def _spread(state: State, active: Integers, loops: Integers, forces: Array) -> tuple[Array, Array]:
    """Multipliers of all one-sided rows and of all loop rows, zero where not held."""
    full, pulling = np.zeros(len(state.slack)), np.zeros(len(state.closure))
    full[active] = forces[: len(active)]
    pulling[loops] = forces[len(active) :]
    return full, pulling


def _first_guess(state: State, active: Integers, loops: Integers, problem: Problem) -> Array:
    """Multipliers that come nearest to balance at the start."""
    sides = np.vstack([state.force[active], state.closing[loops]]).T * problem.unit[:, None]
    return np.asarray(np.linalg.lstsq(sides, state.load * problem.unit, rcond=1e-9)[0], dtype=np.float64)


def _solved(matrix: Array, right: Array) -> Array:
    """Solution of a square system; of least size where a direction is not determined."""
    factors, pivots, _ = dgetrf(matrix)
    sizes = np.abs(factors.diagonal())
    if sizes.min() > DETERMINED * sizes.max():
        found: Array = dgetrs(factors, pivots, right)[0]
        return found
    return np.asarray(np.linalg.lstsq(matrix, right, rcond=1e-8)[0], dtype=np.float64)


def _elastic_step(
    problem: Problem, state: State, stiffness: Array, rows: Array, sides: Array, gaps: Array, forces: Array
) -> tuple[Array, Array]:
    """Step and new multipliers where stiffness matters too.

    A scaled least-squares solve: directions that nothing determines do not move.
    """
    n, held = problem.n, len(gaps)
    matrix = np.zeros((n + held, n + held))
    matrix[:n, :n], matrix[:n, n:], matrix[n:, :n] = stiffness, -sides.T, rows
    right = np.concatenate([sides.T @ forces - state.load, -gaps])
    scale = np.concatenate([problem.unit, np.full(held, problem.weight)])
    weigh = np.concatenate([problem.unit / (problem.weight * problem.span), np.ones(held) / problem.span])
    scaled = matrix * scale[None, :] * weigh[:, None]
    solution = _solved(scaled, right * weigh) * scale
    return solution[:n], forces + solution[n:]
