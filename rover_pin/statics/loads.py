"""Loads at a pose that stands: the multipliers of every touching support."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from rover_pin.numerics import Array
from rover_pin.statics.newton import independent_rows
from rover_pin.statics.problem import Integers, Problem, State

TOUCHING = 1e-6
"""m: a place this near is a contact."""

NEGATIVE = -1e-12
"""Share of the weight: a multiplier below this asks for another share-out."""

STOPPED = 1e-8
"""m or rad: a stop this near carries."""


@dataclass(frozen=True)
class Loads:
    """Multipliers of a state's supports.

    Attributes:
        touching: rows of the state that touch or stand on their stop.
        multipliers: (m,) N of all rows of the state, zero elsewhere.
        pulls: (k,) multipliers of the loops.
        redundant: how many more supports there are than equilibrium determines.
        unbalanced: largest generalised force that no support carries, over weight and span.
    """

    touching: Integers
    multipliers: Array
    pulls: Array
    redundant: int
    unbalanced: float


def share_loads(problem: Problem, state: State) -> Loads:
    """N >= 0 that carry the load; where they are not unique, the least sum of squares over contacts.

    Rows that scale differently (forces, moments) are weighed by the wheels' span.
    """
    contacts = len(state.owners)
    near = np.full(len(state.slack), STOPPED)
    near[:contacts] = TOUCHING
    touching: Integers = np.flatnonzero(state.slack <= near)
    loops = independent_rows(state.closing)
    one_sided = np.ones(len(touching) + len(loops), dtype=bool)
    one_sided[len(touching) :] = False
    counted = np.zeros(len(one_sided), dtype=bool)
    counted[: int(np.sum(touching < contacts))] = True
    weigh = problem.unit / (problem.weight * problem.span)
    sides = np.vstack([state.force[touching], state.closing[loops]]).T * weigh[:, None] * problem.weight
    load = state.load * weigh
    least, _, rank, _ = np.linalg.lstsq(sides, load, rcond=1e-9)
    redundant = sides.shape[1] - int(rank)
    found = np.asarray(least, dtype=np.float64)
    if redundant or np.min(found[one_sided], initial=0.0) < NEGATIVE:
        found = _solve(sides, load, counted, one_sided, redundant)
    small = one_sided & (found < 0.0) & (found > -1e-9)
    found[small] = 0.0
    multipliers = np.zeros(len(state.slack))
    multipliers[touching] = found[: len(touching)] * problem.weight
    pulls = np.zeros(len(state.closure))
    pulls[loops] = found[len(touching) :] * problem.weight
    unbalanced = float(np.max(np.abs(load - sides @ found))) if len(load) else 0.0
    return Loads(touching, multipliers, pulls, redundant, unbalanced)


def _solve(
    sides: Array, load: Array, counted: NDArray[np.bool_], one_sided: NDArray[np.bool_], redundant: int
) -> Array:
    """Least squares of the counted unknowns subject to balance, one-sided ones not negative."""
    used = np.ones(sides.shape[1], dtype=bool)
    found = _balanced(sides, load, counted, used, redundant)
    if np.min(found[one_sided], initial=0.0) < NEGATIVE:
        used = ~one_sided | (_proposal(sides, load, counted, one_sided) > 1e-12)
        found = _balanced(sides, load, counted, used, redundant)
    return found


def _balanced(
    sides: Array, load: Array, counted: NDArray[np.bool_], used: NDArray[np.bool_], redundant: int
) -> Array:
    """min |x[counted]|^2 / 2 with sides x = load and x = 0 where not used: its KKT system."""
    n = len(load)
    chosen = sides[:, used]
    found = np.zeros(sides.shape[1])
    if redundant == 0:
        found[used] = np.linalg.lstsq(chosen, load, rcond=None)[0]
        return found
    size = chosen.shape[1]
    matrix = np.block([[np.diag(counted[used].astype(float)), chosen.T], [chosen, np.zeros((n, n))]])
    right = np.concatenate([np.zeros(size), load])
    found[used] = np.linalg.lstsq(matrix, right, rcond=1e-12)[0][:size]
    return found


def _proposal(sides: Array, load: Array, counted: NDArray[np.bool_], one_sided: NDArray[np.bool_]) -> Array:
    """Which unknowns are positive: non-negative least squares with balance weighed far above size."""
    both = ~one_sided
    matrix = np.vstack([1e6 * sides, np.diag(counted.astype(float))])
    signed = np.hstack([matrix, -matrix[:, both]])
    right = np.concatenate([1e6 * load, np.zeros(len(counted))])
    found: Array = nnls(signed, right)[0][: len(counted)]
    return found
