"""A case's answer as a row, and rows as columns of numbers and words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rover_pin.numerics import Array
from rover_pin.stability.margin import Margin
from rover_pin.statics.stance import Stance

Columns = dict[str, NDArray[np.generic]]
"""Arrays by name, the first axis the case; `edges/<measure>` holds the names of that measure's edges."""

POSE = ("z_m", "roll_rad", "pitch_rad")
RESIDUALS = ("equilibrium", "gap_m", "loop_m", "complementarity")
EDGES = "edges/"
BOUNDS = "bounds"


@dataclass(frozen=True)
class Layout:
    """The names along the wheel and joint dimensions, and the measures asked for."""

    wheels: tuple[str, ...]
    joints: tuple[str, ...]
    measures: tuple[str, ...]

    @property
    def margins(self) -> tuple[str, ...]:
        """The measures that give a margin (all but the load intervals)."""
        return tuple(name for name in self.measures if name != BOUNDS)


class Rows:
    """Rows being filled; a row that is never filled in says NaN and no word."""

    def __init__(self, layout: Layout, count: int) -> None:
        self.layout = layout
        self._status = [""] * count
        self._reason = [""] * count
        self._limiting = {name: [""] * count for name in layout.margins}
        self._edges: dict[str, list[Mapping[str, float]]] = {name: [{}] * count for name in layout.margins}
        wide = {"load_n": layout.wheels, "joint_rad": layout.joints}
        if BOUNDS in layout.measures:
            wide |= {"load_low_n": layout.wheels, "load_high_n": layout.wheels}
        narrow = (*POSE, *RESIDUALS, "redundant", *layout.margins)
        self._numbers = {name: np.full(count, np.nan) for name in narrow}
        self._numbers |= {name: np.full((count, len(labels)), np.nan) for name, labels in wide.items()}

    def failed(self, row: int, status: str, reason: str) -> None:
        """A case without an answer."""
        self._status[row] = status
        self._reason[row] = reason

    def stance(self, row: int, stance: Stance) -> None:
        """How the rover stands; numbers only where it settled."""
        self.failed(row, str(stance.status), stance.reason)
        if not stance.settled:
            return
        numbers = self._numbers
        numbers["z_m"][row] = stance.position[2]
        numbers["roll_rad"][row], numbers["pitch_rad"][row] = stance.rpy[0], stance.rpy[1]
        numbers["joint_rad"][row] = [stance.joints[name] for name in self.layout.joints]
        numbers["load_n"][row] = [stance.loads[name] for name in self.layout.wheels]
        numbers["redundant"][row] = stance.redundant
        for name in RESIDUALS:
            numbers[name][row] = stance.residuals[name]

    def margins(self, row: int, margins: Mapping[str, Margin]) -> None:
        """The measures of a settled stance."""
        for name, margin in margins.items():
            self._numbers[name][row] = margin.value
            self._limiting[name][row] = margin.limiting or ""
            self._edges[name][row] = margin.edges

    def bounds(self, row: int, bounds: Mapping[str, tuple[float, float]]) -> None:
        """The interval of each wheel's load, N; a wheel that does not touch carries nothing."""
        for k, wheel in enumerate(self.layout.wheels):
            low, high = bounds.get(wheel, (0.0, 0.0))
            self._numbers["load_low_n"][row, k], self._numbers["load_high_n"][row, k] = low, high

    def columns(self) -> Columns:
        """Everything as arrays."""
        out: Columns = {"status": _words(self._status), "reason": _words(self._reason), **self._numbers}
        for name in self.layout.margins:
            out[f"{name}_limiting"] = _words(self._limiting[name])
            names = sorted({edge for edges in self._edges[name] for edge in edges})
            out[EDGES + name] = _words(names)
            out[f"{name}_edge"] = _table(self._edges[name], names)
        return out


def _words(words: Sequence[str]) -> NDArray[np.str_]:
    return np.array(words, dtype=np.str_)


def _table(rows: Sequence[Mapping[str, float]], names: Sequence[str]) -> Array:
    """(rows, names), NaN where a row has no such edge."""
    place = {name: k for k, name in enumerate(names)}
    table = np.full((len(rows), len(names)), np.nan)
    for i, row in enumerate(rows):
        for name, value in row.items():
            table[i, place[name]] = value
    return table


def joined(parts: Sequence[Columns]) -> Columns:
    """Parts in the order of their cases as one; edges that only some parts have are NaN in the others."""
    out: Columns = {}
    for key in parts[0]:
        if key.startswith(EDGES):
            measure = key.removeprefix(EDGES)
            names = sorted({str(name) for part in parts for name in part[key]})
            out[key] = _words(names)
            out[f"{measure}_edge"] = np.concatenate([_widened(part, measure, names) for part in parts])
        elif not (key.endswith("_edge") and EDGES + key.removesuffix("_edge") in parts[0]):
            out[key] = np.concatenate([part[key] for part in parts])
    return out


def _widened(part: Columns, measure: str, names: Sequence[str]) -> Array:
    """A part's edges of one measure along all names."""
    own = part[f"{measure}_edge"]
    wide = np.full((len(own), len(names)), np.nan)
    place = {name: k for k, name in enumerate(names)}
    wide[:, [place[str(name)] for name in part[EDGES + measure]]] = own
    return wide
