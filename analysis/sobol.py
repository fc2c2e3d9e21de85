"""Scrambled Sobol points over what varies; what is fixed takes no dimension."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.analysis.chance import Chance
from rover_pin.analysis.quantities import Quantity, Span
from rover_pin.numerics import Array

if TYPE_CHECKING:
    from scipy.stats import qmc


class Sobol:
    """Points of one sequence. It is only ever forwarded (some ns a point); a step back starts it anew."""

    def __init__(self, columns: Mapping[str, Quantity], seed: int) -> None:
        self._asked = dict(columns)
        self._varying = [name for name, asked in columns.items() if asked.varies]
        self._seed = seed
        self._sequence: qmc.Sobol | None = None

    def columns(self, start: int, stop: int) -> dict[str, Array]:
        """Every quantity of the points from `start` to before `stop`."""
        return spread_all(self._asked, self._points(start, stop))

    def _points(self, start: int, stop: int) -> Array:
        """(stop - start, dimensions) in [0, 1)."""
        if not self._varying or start == stop:
            return np.empty((stop - start, len(self._varying)))
        sequence = self._at(start)
        if start > 0:
            return np.asarray(sequence.random(stop - start))
        # Alone, the first point is a power of two, so that scipy does not warn of an odd number of points.
        first = sequence.random(1)
        return np.concatenate([first, sequence.random(stop - 1)]) if stop > 1 else np.asarray(first)

    def _at(self, start: int) -> qmc.Sobol:
        """The sequence, its next point the one at `start`."""
        from scipy.stats import qmc

        sequence = self._sequence
        if sequence is None or sequence.num_generated > start:
            generator = np.random.default_rng([self._seed])
            sequence = self._sequence = qmc.Sobol(len(self._varying), scramble=True, seed=generator)
        if sequence.num_generated < start:
            sequence.fast_forward(start - sequence.num_generated)
        return sequence


def spread_all(columns: Mapping[str, Quantity], points: Array) -> dict[str, Array]:
    """Every quantity from (n, dimensions) numbers in [0, 1): one dimension for each that varies, in order."""
    varying = [name for name, asked in columns.items() if asked.varies]
    place = dict(zip(varying, points.T, strict=True))
    still = np.zeros(len(points))
    return {name: spread(asked, place.get(name, still)) for name, asked in columns.items()}


def spread(asked: Quantity, unit: Array) -> Array:
    """Numbers in [0, 1) spread over a quantity."""
    if isinstance(asked, Span):
        return asked.low + (asked.high - asked.low) * unit
    if isinstance(asked, Chance):
        return asked.spread(unit)
    values = np.asarray(asked.values)
    return values[np.minimum((unit * len(values)).astype(np.int64), len(values) - 1)]
