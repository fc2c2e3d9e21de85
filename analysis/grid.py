"""Every combination of what varies; the last quantity varies fastest."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rover_pin.analysis.chance import Chance
from rover_pin.analysis.quantities import Choice, Quantity, Span
from rover_pin.analysis.spec import MOST_CASES, CasesSpec
from rover_pin.errors import StudyError, nearest
from rover_pin.numerics import Array

CIRCLE_DEG = 360.0
EACH = {0: 1, 1: 41, 2: 21}
"""Ticks of each range where the study does not say, by the number of ranges: enough for a line or a map."""


@dataclass(frozen=True)
class Axis:
    """One quantity cut into ticks, which are worked out only where they are asked for."""

    asked: Choice | Span
    count: int
    whole_circle: bool

    def ticks(self, index: NDArray[np.int64]) -> Array:
        """The ticks of those numbers; a whole circle does not repeat its first heading."""
        asked = self.asked
        if isinstance(asked, Choice):
            return np.asarray(asked.values)[index]
        if self.count == 1:
            return np.full(len(index), 0.5 * (asked.low + asked.high))
        step = (asked.high - asked.low) / (self.count if self.whole_circle else self.count - 1)
        values: Array = np.asarray(index * step + asked.low, dtype=np.float64)
        if not self.whole_circle:
            values[index == self.count - 1] = asked.high
        return values


class Grid:
    """The axes of a grid and their combinations."""

    def __init__(self, columns: Mapping[str, Quantity], spec: CasesSpec) -> None:
        """Cut each range.

        Raises:
            StudyError: counts that are missing or not wanted, or too many cases.
        """
        counts = _counts(columns, spec)
        self._axes = {name: _axis(name, asked, counts.get(name, 1)) for name, asked in columns.items()}
        self.count = math.prod(axis.count for axis in self._axes.values())
        if self.count > MOST_CASES:
            cure = f"at most {MOST_CASES}"
            raise StudyError("has too many cases", element="cases.grid", value=self.count, cure=cure)

    def columns(self, start: int, stop: int) -> dict[str, Array]:
        """Every quantity of the combinations from `start` to before `stop`."""
        shape = tuple(axis.count for axis in self._axes.values())
        places = np.unravel_index(np.arange(start, stop), shape)
        return {
            name: axis.ticks(place) for (name, axis), place in zip(self._axes.items(), places, strict=True)
        }


def _axis(name: str, asked: Quantity, count: int) -> Axis:
    if isinstance(asked, Chance):
        cure = "draw it: cases: {sampler: sobol, n: 10000}, random or saltelli; or give a range"
        raise StudyError(
            "a grid cannot cut a distribution", element=f"vary.{name}", value=asked.kind, cure=cure
        )
    if isinstance(asked, Choice):
        return Axis(asked, len(asked.values), False)
    whole = name == "yaw_deg" and math.isclose(asked.high - asked.low, CIRCLE_DEG)
    return Axis(asked, count if asked.varies else 1, whole)


def _counts(columns: Mapping[str, Quantity], spec: CasesSpec) -> dict[str, int]:
    """How many ticks each range gets."""
    ranges = [name for name, asked in columns.items() if isinstance(asked, Span) and asked.varies]
    if spec.grid is None:
        if spec.n is None and len(ranges) in EACH:
            return dict.fromkeys(ranges, EACH[len(ranges)])
        if spec.n is None:
            cure = f"write cases: {{grid: {{{', '.join(f'{name}: 10' for name in ranges)}}}}}"
            raise StudyError("a grid needs a count for each range, or n", element="cases", cure=cure)
        choices = math.prod(len(asked.values) for asked in columns.values() if isinstance(asked, Choice))
        each = _root(spec.n // choices, len(ranges))
        return dict.fromkeys(ranges, each)
    for name in spec.grid:
        if name not in ranges:
            what = "counts a quantity that is no range" if name in columns else "counts an unknown quantity"
            raise StudyError(what, element=f"cases.grid.{name}", cure=nearest(name, ranges))
    for name in ranges:
        if name not in spec.grid:
            raise StudyError("has no count", element=f"cases.grid.{name}", cure=f"add {name}: 10")
    return dict(spec.grid)


def _root(n: int, power: int) -> int:
    """The largest k >= 1 with k**power <= n."""
    if power == 0:
        return 1
    k: int = max(1, round(float(n) ** (1.0 / power)))
    while k > 1 and k**power > n:
        k -= 1
    return k
