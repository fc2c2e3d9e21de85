"""From the paper's tables to a geometry: bounded least squares from many far starts, in two stages.

Table 6 says how the robot stands at rest, so that a geometry need not be solved for a stance at first: the
first stage makes the equations hold at that stance, for lengths drawn anywhere between bounds. The second
stage solves all cases and fits every target.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import least_squares, lsq_linear

from rover_pin.analysis.papers.polibot import targets
from rover_pin.analysis.papers.polibot.planar import LENGTHS, Inputs, Solved, arcs, equations, solve
from rover_pin.numerics import Array

BOUNDS = {
    "d1": (50, 250), "d2": (0, 60), "d3": (0, 80), "d4": (50, 200), "d5": (0, 80), "d6": (80, 250),
    "d7": (50, 200), "d8": (80, 300), "d9": (150, 400), "d10": (80, 250), "d12": (50, 200), "d13": (20, 150),
    "d14": (0, 60), "d15": (0, 100), "alpha1_deg": (40, 120), "alpha2_deg": (40, 120), "alpha3_deg": (15, 80),
    "alpha4_deg": (40, 120), "r1": (60, 100), "r2": (50, 100), "r3": (65, 65), "r4": (50, 80), "r5": (50, 80),
    "r6": (50, 80),
}  # fmt: skip
"""mm, deg: what a robot of these outer dimensions may have, without regard to the tables. Section 5.3 gives
r3 = 65 mm; the sprocket's working radius lies between a pitch radius of 70.3 mm less some, and its outer
100 mm."""

LOWER, UPPER = (np.array([BOUNDS[name][k] for name in LENGTHS], dtype=np.float64) for k in (0, 1))
FREE = np.flatnonzero(UPPER > LOWER)
"""Lengths that are sought."""

WIDE, NARROW = 0.15, 1e-5
"""Largest and least box of a step, of the bounds."""

SHORT = 0.05
"""Weight of a step over the bounds against a miss."""

EVEN, NEARLY = 8, 5.0
"""Where squares end with a target just missed, below the second number, sums of this power even the misses
out."""

SLIGHT = 1e-6
"""rad: by how much a wheel may keep off the belt; on level ground the middle ones just touch it."""

ENOUGH = 0.5
"""Miss at which a target is met well enough, of what it leaves open."""

LOST = 1e3
"""Taken for a target that a geometry has no stance for."""


@dataclass(frozen=True, eq=False)
class Fit:
    """A geometry, and how the targets are met.

    Attributes:
        lengths: (l,) of LENGTHS, mm and deg.
        start: (l,) where the search began.
        misses: (t,) over what each target leaves open; all within 1 where it fits.
        slopes: (t, l) their derivatives by the lengths.
        state: (15, 8) the cases.
        good: whether every case has a stance.
    """

    lengths: Array
    start: Array
    misses: Array
    slopes: Array
    state: Array
    good: bool

    @property
    def within(self) -> bool:
        """Whether all targets are met."""
        return self.good and float(np.max(np.abs(self.misses))) <= 1.0


def evaluated(lengths: Array, start: Array | None = None, guess: Array | None = None) -> Fit:
    """A geometry held against the targets."""
    found = _solved(lengths, guess)
    misses, slopes = targets.misses(found)
    good = bool(np.all(found.good)) and bool(np.all(np.isfinite(misses)))
    with np.errstate(all="ignore"):
        good = good and bool(np.all(arcs(lengths, found.state, targets.inputs()) > -SLIGHT))
    if not good:
        misses, slopes = np.full(len(misses), LOST), np.zeros(slopes.shape)
    began = lengths if start is None else start
    return Fit(np.array(lengths), began, misses, slopes, found.state, good)


def _solved(lengths: Array, guess: Array | None) -> Solved:
    cases = targets.inputs()
    with np.errstate(all="ignore"):
        if guess is not None:
            return solve(lengths, cases, guess)
        rest = _rest(lengths)
        return solve(lengths, cases, np.tile(rest[:, None], (1, cases.count)))


def _rest(lengths: Array) -> Array:
    """(15,) the stance at rest, from Table 6 on."""
    cases = targets.inputs()
    one = _one_case(cases, targets.BASELINE)
    found = solve(lengths, one, targets.first_guess()[:, :1])
    return found.state[:, 0] if bool(found.good[0]) else targets.first_guess()[:, 0]


def _one_case(cases: Inputs, k: int) -> Inputs:
    return replace(cases, mass=cases.mass[[k]], track=cases.track[[k]], front_arm=cases.front_arm[[k]],
                   ground=cases.ground[:, [k]])  # fmt: skip


def starts(count: int, seed: int) -> Array:
    """(n, l) lengths drawn evenly between the bounds."""
    drawn = np.random.default_rng(seed).uniform(size=(count, len(LENGTHS)))
    made: Array = LOWER + drawn * (UPPER - LOWER)
    return made


def search(start: Array) -> Fit:
    """Both stages from one start."""
    return closer(evaluated(_standing(start), start), len(targets.TARGETS))


def worst(fit: Fit, use: int) -> float:
    """The largest miss among the first `use` targets."""
    return float(np.max(np.abs(fit.misses[:use])))


def closer(fit: Fit, use: int, *, held: int | None = None, most: int = 60, enough: float = ENOUGH) -> Fit:
    """The second stage: Gauss and Newton's steps in a box, until the first `use` targets are met.

    Least squares first; where they end with a target just missed, higher powers, which even the misses out.

    Of the steps that do equally well the shortest is taken, so that what nothing fixes stays near where it
    was.

    Args:
        fit: where to begin.
        use: targets that count, from the first on.
        held: index of a length that stays.
        most: steps.
        enough: largest miss at which to stop.
    """
    for power in (2, EVEN):
        radius = WIDE
        for _ in range(most):
            if worst(fit, use) <= enough or radius < NARROW or not fit.good:
                break
            tried = evaluated(_stepped(fit, use, held, radius, power), fit.start, fit.state)
            if _sum(tried, use, power) < _sum(fit, use, power):
                fit, radius = tried, min(WIDE, 2.0 * radius)
            else:
                radius /= 4.0
        if not 1.0 < worst(fit, use) < NEARLY:
            break
    return fit


def _stepped(fit: Fit, use: int, held: int | None, radius: float, power: int) -> Array:
    """Lengths after one step towards the least sum of powers, its weights taken where it begins."""
    open_ = FREE if held is None else FREE[held != FREE]
    span = (UPPER - LOWER)[open_]
    at = (fit.lengths[open_] - LOWER[open_]) / span
    low, high = np.maximum(-at, -radius), np.minimum(1.0 - at, radius)
    low, high = np.minimum(low, -1e-12), np.maximum(high, 1e-12)
    weights = np.maximum(np.abs(fit.misses[:use]), 0.2) ** (power / 2 - 1)
    matrix = np.vstack([weights[:, None] * fit.slopes[:use, open_] * span, SHORT * np.eye(len(open_))])
    side = np.concatenate([-weights * fit.misses[:use], np.zeros(len(open_))])
    found = lsq_linear(matrix, side, bounds=(low, high), method="bvls", tol=1e-12, max_iter=200)
    lengths = fit.lengths.copy()
    lengths[open_] = np.clip(lengths[open_] + found.x * span, LOWER[open_], UPPER[open_])
    return lengths


def _sum(fit: Fit, use: int, power: int) -> float:
    return float(np.sum(np.abs(fit.misses[:use]) ** power)) if fit.good else np.inf


def _standing(start: Array) -> Array:
    """The first stage: lengths and forces with which the stance of Table 6 is at rest."""
    case = _one_case(targets.inputs(), targets.BASELINE)
    first = targets.first_guess()[:, 0]
    low = np.concatenate([LOWER[FREE], np.full(4, targets.LEAST_LOAD), [20.0], np.full(3, -200.0)])
    high = np.concatenate([UPPER[FREE], np.full(4, 400.0), [1000.0], np.full(3, 800.0)])
    scale = np.array([1.0] * 5 + [20.0, 20.0, 20.0, 20.0, 20.0, 20.0] + [1.0] * 4)  # mm, N, N over 100 mm

    def rows(v: Array) -> tuple[Array, Array]:
        moved = v[:, None] + 1e-30j * np.eye(len(v))
        lengths = LOWER[:, None] + 0.0j * moved[:1]
        lengths[FREE] = moved[: len(FREE)]
        state = np.concatenate([first[:7, None] + 0.0j * moved[:1], moved[len(FREE) :]])
        value = equations(state[:, :, None], lengths[:, :, None], case)[:, :, 0]
        return value.real[:, 0] / scale, value.imag / 1e-30 / scale[:, None]

    with np.errstate(all="ignore"):
        found = _least_squares(rows, np.concatenate([start[FREE], first[7:]]), 200, low, high)
    return _whole(found[: len(FREE)])


def _whole(free: Array) -> Array:
    lengths = LOWER.copy()
    lengths[FREE] = free
    return lengths


def _least_squares(
    rows: Callable[[Array], tuple[Array, Array]],
    start: Array,
    most: int,
    low: Array | None = None,
    high: Array | None = None,
) -> Array:
    """scipy's bounded trust region; values that are no numbers count as LOST."""
    low, high = LOWER[FREE] if low is None else low, UPPER[FREE] if high is None else high
    kept: dict[bytes, tuple[Array, Array]] = {}

    def both(v: Array) -> tuple[Array, Array]:
        key = v.tobytes()
        if key not in kept:
            kept.clear()
            value, slope = rows(v)
            kept[key] = np.nan_to_num(value, nan=LOST, posinf=LOST, neginf=-LOST), np.nan_to_num(slope)
        return kept[key]

    inside = np.clip(start, low + 1e-6 * (high - low), high - 1e-6 * (high - low))

    def value_of(v: Array) -> Array:
        return both(v)[0]

    def slope_of(v: Array) -> Array:
        return both(v)[1]

    found = least_squares(
        value_of, inside, jac=slope_of, bounds=(low, high), x_scale=high - low, max_nfev=most
    )
    result: Array = found.x
    return result
