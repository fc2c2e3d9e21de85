"""A result in numbers for people: how cases ended, the spread of each measure, the worst cases."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import xarray as xr

SHARES = (1, 5, 50, 95, 99)
"""Percentiles that are told."""


@dataclass(frozen=True)
class Worst:
    """A case near the bad end of a measure."""

    case: int
    value: float
    limiting: str


@dataclass(frozen=True)
class Spread:
    """A measure over the settled cases: its percentiles, and its worst cases first to last."""

    unit: str
    better: str
    percentiles: dict[int, float]
    worst: tuple[Worst, ...]


def statuses(data: xr.Dataset) -> dict[str, int]:
    """How many cases ended in which way, the most first."""
    words, counts = np.unique(data["status"].values.astype(str), return_counts=True)
    order = np.argsort(-counts, kind="stable")
    return {str(words[k]): int(counts[k]) for k in order}


def measures(data: xr.Dataset) -> list[str]:
    """The measures in a result."""
    return [str(name) for name in data.data_vars if f"{name}_limiting" in data]


def spread(data: xr.Dataset, measure: str, count: int = 10) -> Spread:
    """Percentiles and the `count` worst settled cases of a measure."""
    column = data[measure]
    settled = np.flatnonzero(data["status"].values == "settled")
    values = column.values[settled]
    better = str(column.attrs.get("better", "high"))
    order = np.argsort(values if better == "high" else -values, kind="stable")[:count]
    limiting = data[f"{measure}_limiting"].values
    cases = data["case"].values
    told = np.percentile(values, SHARES, method="lower") if len(values) else np.full(len(SHARES), np.nan)
    return Spread(
        unit=str(column.attrs.get("units", "")),
        better=better,
        percentiles={share: float(value) for share, value in zip(SHARES, told, strict=True)},
        worst=tuple(
            Worst(int(cases[settled[k]]), float(values[k]), str(limiting[settled[k]])) for k in order
        ),
    )


def largest_residuals(data: xr.Dataset) -> dict[Hashable, float]:
    """The largest of each residual over the settled cases; NaN where none settled."""
    settled = data["status"].values == "settled"
    names = ("equilibrium", "gap_m", "loop_m", "complementarity")
    return {
        name: float(np.max(data[name].values[settled])) if settled.any() else float("nan") for name in names
    }
