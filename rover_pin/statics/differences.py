"""Stiffness by central differences: for contacts on creases, which no second derivative describes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rover_pin.numerics import Array

if TYPE_CHECKING:
    from rover_pin.statics.problem import Problem, State
    from rover_pin.terrain import Terrain

STEP = 1e-6
"""Share of the span, or rad."""


def stiffness_by_differences(
    problem: Problem, reference: State, terrain: Terrain, multipliers: Array, pulls: Array, window: float
) -> Array:
    """(n, n) as `Problem.stiffness`, its arguments as there."""
    matrix = np.zeros((problem.n, problem.n))
    for j in range(problem.n):
        step = STEP * problem.unit[j]
        sides = []
        for sign in (1.0, -1.0):
            shifted = reference.z.copy()
            shifted[j] += sign * step
            state = problem.state(shifted, terrain, window)
            force = _matched(reference, state)
            sides.append(state.load - force.T @ multipliers - state.closing.T @ pulls)
        matrix[:, j] = (sides[0] - sides[1]) / (2.0 * step)
    return matrix


def _matched(reference: State, state: State) -> Array:
    """Force rows of `state` in the order of `reference`: each contact by the nearest one of its shape."""
    if np.array_equal(reference.owners, state.owners):
        return state.force
    rows = []
    for owner, contact in zip(reference.owners, reference.contacts, strict=True):
        same = np.flatnonzero(state.owners == owner)
        away = np.linalg.norm(state.contacts[same, 1:4] - contact[1:4], axis=1)
        rows.append(state.force[same[int(np.argmin(away))]])
    stacked = np.array(rows).reshape(len(reference.owners), -1)
    return np.vstack([stacked, state.force[len(state.owners) :]])
