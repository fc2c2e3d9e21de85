"""A result in numbers for people: how cases ended, the spread of each measure, the worst cases."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Hashable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rover_pin.analysis.ranks import ranked
from rover_pin.numerics import Array

if TYPE_CHECKING:
    import xarray as xr

SHARES = (1, 5, 50, 95, 99)
"""Percentiles that are told."""

BLOCK = 1 << 18
"""Cases that are looked at together."""


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
    counts: Counter[str] = Counter()
    for block in _blocks(data, "status"):
        counts.update(block.tolist())
    return dict(sorted(counts.items(), key=lambda item: (-item[1], item[0])))


def measures(data: xr.Dataset) -> list[str]:
    """The measures in a result."""
    return [str(name) for name in data.data_vars if f"{name}_limiting" in data]


def spread(data: xr.Dataset, measure: str, count: int = 10) -> Spread:
    """Percentiles and the `count` worst settled cases of a measure."""
    column = data[measure]
    better = str(column.attrs.get("better", "high"))
    settled, cases = _worst(data, measure, 1.0 if better == "high" else -1.0, count)
    values = column.isel(case=cases).values
    limiting = data[f"{measure}_limiting"].isel(case=cases).values
    numbers = data["case"].isel(case=cases).values
    return Spread(
        unit=str(column.attrs.get("units", "")),
        better=better,
        percentiles=_percentiles(data, measure, settled),
        worst=tuple(
            Worst(int(case), float(value), str(word))
            for case, value, word in zip(numbers, values, limiting, strict=True)
        ),
    )


def figure_spreads(data: xr.Dataset) -> dict[str, tuple[str, dict[int, float]]]:
    """Unit and percentiles over the settled cases of how the rover stands and carries; tensions by track."""
    tracks = [str(name) for name in data["track"].values] if "tension_n" in data else []
    apart = {f"tension_n/{name}": data["tension_n"].isel(track=k, drop=True) for k, name in enumerate(tracks)}
    names = [name for name in ("pitch_rad", "roll_rad", "touching", "load_spread") if name in data]
    columns = _columns({**{name: data[name] for name in names}, **apart})
    if not statuses(data).get("settled", 0):
        return {}
    return {
        name: (str(columns[name].attrs.get("units", "")), _shares(columns, name)) for name in (*names, *apart)
    }


def _shares(data: xr.Dataset, name: str) -> dict[int, float]:
    return _percentiles(data, name, sum(len(block) for block in _answers(data, name)))


def _columns(columns: dict[str, xr.DataArray]) -> xr.Dataset:
    """A Dataset of some columns; xarray is loaded where it is used."""
    import xarray as xr

    return xr.Dataset(columns)


def largest_residuals(data: xr.Dataset) -> dict[Hashable, float]:
    """The largest of each residual over the settled cases; NaN where none settled."""
    names = ("equilibrium", "gap_m", "loop_m", "complementarity")
    return {
        name: max((float(block.max()) for block in _answers(data, name)), default=math.nan) for name in names
    }


def _worst(data: xr.Dataset, measure: str, sign: float, count: int) -> tuple[int, NDArray[np.int64]]:
    """How many cases have an answer, and which of them are the `count` worst, the first of equals first."""
    settled, start = 0, 0
    values, cases = np.empty(0), np.empty(0, dtype=np.int64)
    for block in _blocks(data, measure):
        there = np.flatnonzero(~np.isnan(block))
        settled += len(there)
        values = np.concatenate([values, sign * block[there]])
        cases = np.concatenate([cases, start + there])
        if len(values) > count:
            near = values <= np.partition(values, count - 1)[count - 1]
            values, cases = values[near], cases[near]
        order = np.argsort(values, kind="stable")[:count]
        values, cases = values[order], cases[order]
        start += len(block)
    return settled, cases


def _percentiles(data: xr.Dataset, measure: str, settled: int) -> dict[int, float]:
    """The greatest value that at most each share of the settled cases lies below, as some case has it."""
    if not settled:
        return dict.fromkeys(SHARES, math.nan)
    ranks = [math.floor((settled - 1) * (share / 100)) for share in SHARES]
    return dict(zip(SHARES, ranked(lambda: _answers(data, measure), ranks), strict=True))


def _answers(data: xr.Dataset, name: str) -> Iterator[Array]:
    """The values of the settled cases, block by block: the others have none."""
    for block in _blocks(data, name):
        there = block[~np.isnan(block)]
        if len(there):
            yield there


def _blocks(data: xr.Dataset, name: str) -> Iterator[NDArray[Any]]:
    """A column in blocks of cases; of a file no more than a block is read at a time."""
    column, count = data[name], data.sizes["case"]
    for start in range(0, count, BLOCK):
        yield column.isel(case=slice(start, start + BLOCK)).values
