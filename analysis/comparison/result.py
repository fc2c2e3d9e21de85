"""What a comparison answers: each design's figures, and every pair's differences on the cases both answer."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rover_pin.analysis.comparison.statistics import (
    LEVEL,
    both,
    differences,
    median_interval,
    share_interval,
    wins,
)
from rover_pin.analysis.summary import statuses
from rover_pin.numerics import Array

if TYPE_CHECKING:
    import xarray as xr

    from rover_pin.analysis.study import Study


@dataclass(frozen=True)
class Spread:
    """A measure of one design over the cases it answers; SI units, NaN where it answers none."""

    median: float
    worst: float
    worst_case: int
    answered: float


@dataclass(frozen=True)
class DesignFigures:
    """One design: how its cases ended, how often it tips with the interval of that share, its measures."""

    label: str
    status: Mapping[str, int]
    tipping: float
    tipping_interval: tuple[float, float]
    measures: Mapping[str, Spread]


@dataclass(frozen=True)
class Difference:
    """A measure of a pair over the cases that both answer.

    Attributes:
        cases: how many both answer.
        median, low, high: of second minus first, SI; the interval's ends.
        method: how the interval was found.
        mean: of second minus first.
        first_better, second_better, equal: shares of those cases.
        winner: the label of the better one where the interval leaves out 0, else empty.
    """

    cases: int
    median: float
    low: float
    high: float
    method: str
    mean: float
    first_better: float
    second_better: float
    equal: float
    winner: str


@dataclass(frozen=True)
class Pair:
    """Two designs.

    Attributes:
        first, second: labels.
        both, neither: how many cases both, or neither, settle in.
        only_first, only_second: numbers of the cases in which one alone settles.
        otherwise_second, otherwise_first: how the other ended in those, counted.
        measures: differences by measure.
    """

    first: str
    second: str
    both: int
    neither: int
    only_first: tuple[int, ...]
    only_second: tuple[int, ...]
    otherwise_second: Mapping[str, int]
    otherwise_first: Mapping[str, int]
    measures: Mapping[str, Difference]


@dataclass(frozen=True)
class Comparison:
    """Designs side by side.

    Attributes:
        datasets: each design's result by its label, as of a Study, with the same cases in the same order.
        studies: each design's study, where there is one.
        units, better: of each measure that all designs have; `high` or `low`.
        left_out: measures that a design cannot have, and why, by label.
        designs, pairs: the figures.
        same: pairs of labels that say the same design in other words.
    """

    datasets: Mapping[str, xr.Dataset]
    studies: Mapping[str, Study]
    units: Mapping[str, str]
    better: Mapping[str, str]
    left_out: Mapping[str, Mapping[str, str]]
    designs: tuple[DesignFigures, ...]
    pairs: tuple[Pair, ...]
    same: tuple[tuple[str, str], ...] = field(default=())

    @property
    def labels(self) -> tuple[str, ...]:
        """What the designs are called, in the order given."""
        return tuple(self.datasets)

    @property
    def cases(self) -> int:
        """How many cases each was asked."""
        return int(next(iter(self.datasets.values())).sizes["case"])

    def as_dict(self) -> dict[str, Any]:
        """Plain values, as `compare --json` prints them."""
        first = next(iter(self.datasets.values()))
        return {
            "terrain": first.attrs["terrain"],
            "cases": self.cases,
            "level": LEVEL,
            "measures": {
                name: {"unit": unit, "better": self.better[name]} for name, unit in self.units.items()
            },
            "left_out": self.left_out,
            "same": self.same,
            "designs": [
                {
                    **asdict(each),
                    "gravity": float(self.datasets[each.label].attrs["gravity"]),
                    "payload": str(self.datasets[each.label].attrs.get("payload", "")),
                }
                for each in self.designs
            ],
            "pairs": [asdict(each) for each in self.pairs],
        }


def figures(
    datasets: Mapping[str, xr.Dataset], measures: Mapping[str, str], seed: int
) -> tuple[tuple[DesignFigures, ...], tuple[Pair, ...]]:
    """The figures of each design and each pair.

    Args:
        datasets: by label.
        measures: which way is better, by name.
        seed: of the bootstrap.
    """
    table = {
        label: {name: np.asarray(data[name].values, dtype=np.float64) for name in measures}
        for label, data in datasets.items()
    }
    settled = {label: data["status"].values.astype(str) for label, data in datasets.items()}
    singles = tuple(
        _single(label, data, table[label], measures, settled[label]) for label, data in datasets.items()
    )
    pairs = tuple(_pair((a, b), table, measures, settled, seed) for a, b in combinations(datasets, 2))
    return singles, pairs


def _single(
    label: str,
    data: xr.Dataset,
    values: Mapping[str, Array],
    measures: Mapping[str, str],
    status: NDArray[np.str_],
) -> DesignFigures:
    tips, count = int(np.count_nonzero(status == "tips")), len(status)
    spreads = {name: _spread(values[name], better) for name, better in measures.items()}
    share = tips / count if count else math.nan
    return DesignFigures(label, statuses(data), share, share_interval(tips, count), spreads)


def _spread(values: Array, better: str) -> Spread:
    there = np.flatnonzero(~np.isnan(values))
    if not len(there):
        return Spread(math.nan, math.nan, -1, 0.0)
    worst = int(there[np.argmin(values[there]) if better == "high" else np.argmax(values[there])])
    return Spread(float(np.median(values[there])), float(values[worst]), worst, len(there) / len(values))


def _pair(
    names: tuple[str, str],
    table: Mapping[str, Mapping[str, Array]],
    measures: Mapping[str, str],
    status: Mapping[str, NDArray[np.str_]],
    seed: int,
) -> Pair:
    first, second = names
    stands = [status[name] == "settled" for name in names]
    alone = [np.flatnonzero(stands[0] & ~stands[1]), np.flatnonzero(stands[1] & ~stands[0])]
    return Pair(
        first,
        second,
        int(np.count_nonzero(stands[0] & stands[1])),
        int(np.count_nonzero(~stands[0] & ~stands[1])),
        tuple(alone[0].tolist()),
        tuple(alone[1].tolist()),
        _counted(status[second][alone[0]]),
        _counted(status[first][alone[1]]),
        {
            name: _difference(table[first][name], table[second][name], better, names, seed)
            for name, better in measures.items()
        },
    )


def _counted(words: NDArray[np.str_]) -> dict[str, int]:
    found, counts = np.unique(words, return_counts=True)
    return {str(word): int(count) for word, count in zip(found, counts, strict=True)}


def _difference(a: Array, b: Array, better: str, names: tuple[str, str], seed: int) -> Difference:
    there = both(a, b)
    moved = differences(a[there], b[there])
    interval = median_interval(moved, seed)
    winner = ""
    if interval.low > 0.0 or interval.high < 0.0:
        winner = names[1] if (interval.low > 0.0) == (better == "high") else names[0]
    with np.errstate(invalid="ignore"):
        mean = float(np.mean(moved)) if len(moved) else math.nan
    median = float(np.median(moved)) if len(moved) else math.nan
    shares = wins(moved, better)
    return Difference(len(moved), median, interval.low, interval.high, interval.method, mean, *shares, winner)
