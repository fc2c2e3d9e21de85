"""Paired statistics: the median of differences with its interval, shares of wins, a share's interval."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rover_pin.numerics import Array

LEVEL = 0.95
EQUAL = 1e-7
"""Two answers nearer to each other than this share of their size are equal: solving leaves as much."""

RESAMPLES = 5000
MOST = 3000
"""Pairs up to which the interval is bootstrapped; beyond, order statistics say the same and sooner."""

FEWEST = 6
"""Pairs below which not even all of them on one side say much: 2 / 2^6 is less than a twentieth."""


@dataclass(frozen=True)
class Interval:
    """An interval that holds the true value with probability `LEVEL`, and how it was found."""

    low: float
    high: float
    method: str


def differences(a: Array, b: Array) -> Array:
    """(n,) b - a; exactly 0 where they are equal to `EQUAL`."""
    with np.errstate(invalid="ignore"):
        moved = b - a
        same = (a == b) | (np.abs(moved) <= EQUAL * np.maximum(np.abs(a), np.abs(b)))
    return np.where(same, 0.0, moved)


def median_interval(values: Array, seed: int) -> Interval:
    """The interval of the median of paired differences (n,).

    Up to `MOST` pairs by the bias-corrected and accelerated bootstrap of whole pairs (Efron 1987; scipy):
    resampling the differences is resampling the pairs. Beyond, and where the bootstrap has no answer, from
    order statistics: the ranks that a binomial of one half gives, which hold for any distribution.
    """
    if len(values) < FEWEST:
        return Interval(math.nan, math.nan, "too few")
    if np.ptp(values) == 0.0:
        return Interval(float(values[0]), float(values[0]), "all alike")
    if len(values) <= MOST and np.isfinite(values).all():
        found = _bootstrap(values, seed)
        if math.isfinite(found[0]) and math.isfinite(found[1]):
            return Interval(*found, "BCa")
    return Interval(*_order_statistics(values), "order statistics")


def _bootstrap(values: Array, seed: int) -> tuple[float, float]:
    from scipy.stats import bootstrap

    batch = max(1, 2_000_000 // len(values))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a degenerate resampling is told by NaN
        found = bootstrap(
            (values,),
            np.median,
            n_resamples=RESAMPLES,
            batch=batch,
            confidence_level=LEVEL,
            method="BCa",
            vectorized=True,
            rng=np.random.default_rng(seed),
        ).confidence_interval
    return float(found.low), float(found.high)


def _order_statistics(values: Array) -> tuple[float, float]:
    """Ranks k and n - k + 1 with at most half of what the level leaves outside of either."""
    from scipy.stats import binom

    ordered = np.sort(values)
    rank = max(int(binom.ppf((1.0 - LEVEL) / 2.0, len(values), 0.5)), 1)
    return float(ordered[rank - 1]), float(ordered[len(values) - rank])


def share_interval(count: int, total: int) -> tuple[float, float]:
    """Wilson's interval of a share."""
    if not total:
        return math.nan, math.nan
    from scipy.stats import binomtest

    found = binomtest(count, total).proportion_ci(LEVEL, method="wilson")
    return float(found.low), float(found.high)


def wins(difference: Array, better: str) -> tuple[float, float, float]:
    """Shares of the pairs in which the first, the second, and neither is better."""
    if not len(difference):
        return math.nan, math.nan, math.nan
    gain = difference if better == "high" else -difference
    first, second = (float(np.mean(each)) for each in (gain < 0.0, gain > 0.0))
    return first, second, float(np.mean(gain == 0.0))


def both(a: Array, b: Array) -> NDArray[np.bool_]:
    """(n,) where both have an answer."""
    return ~(np.isnan(a) | np.isnan(b))
