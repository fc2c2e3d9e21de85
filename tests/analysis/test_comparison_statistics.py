"""Paired statistics against counting by hand, scipy's own pairing and a known coverage."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.stats import binom, bootstrap

from rover_pin.analysis.comparison.statistics import (
    FEWEST,
    MOST,
    RESAMPLES,
    differences,
    median_interval,
    share_interval,
    wins,
)


def test_the_interval_is_that_of_scipys_paired_bootstrap() -> None:
    draw = np.random.default_rng(3)
    a = draw.normal(size=60)
    b = a + 0.2 + 0.1 * draw.normal(size=60)
    found = median_interval(b - a, seed=11)
    theirs = bootstrap(
        (a, b),
        lambda x, y, axis=-1: np.median(y - x, axis=axis),
        paired=True,
        n_resamples=RESAMPLES,
        method="BCa",
        vectorized=True,
        rng=np.random.default_rng(11),
    ).confidence_interval
    assert found.method == "BCa"
    assert (found.low, found.high) == pytest.approx((theirs.low, theirs.high), abs=1e-12)
    assert median_interval(b - a, seed=11) == found


@pytest.mark.parametrize("count", [40, MOST + 1])
def test_an_interval_holds_a_known_shift_as_often_as_it_says(count: int) -> None:
    draw = np.random.default_rng(5)
    rounds = 60
    inside = 0
    for k in range(rounds):
        found = median_interval(0.7 + draw.standard_t(3, size=count), seed=k)
        inside += found.low <= 0.7 <= found.high
    assert inside >= binom.ppf(0.001, rounds, 0.95)
    assert found.method == ("BCa" if count <= MOST else "order statistics")


def test_order_statistics_cover_by_the_binomial() -> None:
    """Ranks 10 and 30 of 39 leave out 0.34 % on either side; rank 13 and 27 are the first to leave 1.2 %."""
    values = np.arange(1.0, MOST + 2.0)
    found = median_interval(values, seed=0)
    n = len(values)
    outside = binom.cdf(found.low - 1, n, 0.5)
    assert outside <= 0.025 < binom.cdf(found.low, n, 0.5)
    assert found.high == n + 1 - found.low


def test_what_has_no_interval_or_no_width() -> None:
    few = median_interval(np.arange(FEWEST - 1.0), 0)
    assert (math.isnan(few.low), few.method) == (True, "too few")
    same = median_interval(np.full(50, 0.25), 0)
    assert (same.low, same.high, same.method) == (0.25, 0.25, "all alike")
    endless = median_interval(np.array([*np.arange(9.0), np.inf]), 0)
    assert (endless.low, endless.high, endless.method) == (1.0, 8.0, "order statistics")


def test_differences_and_wins_by_hand() -> None:
    a = np.array([1.0, 2.0, 3.0, np.inf, 0.0, 5.0])
    b = np.array([1.5, 2.0 + 1e-9, 2.0, np.inf, 0.0, 4.0])
    moved = differences(a, b)
    assert moved.tolist() == [0.5, 0.0, -1.0, 0.0, 0.0, -1.0]
    assert wins(moved, "high") == (2 / 6, 1 / 6, 3 / 6)
    assert wins(moved, "low") == (1 / 6, 2 / 6, 3 / 6)


def test_a_share_by_wilsons_formula() -> None:
    k, n, z = 7, 40, 1.959963984540054
    p = k / n
    middle = (p + z * z / (2 * n)) / (1 + z * z / n)
    half = z / (1 + z * z / n) * math.sqrt(p * (1 - p) / n + z * z / (4 * n * n))
    assert share_interval(k, n) == pytest.approx((middle - half, middle + half), abs=1e-12)
