"""A case's answer as a row, rows as columns, columns cut and joined."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rover_pin.analysis.vocabulary import Words, joined_words
from rover_pin.numerics import Array
from rover_pin.stability.margin import Margin
from rover_pin.statics.stance import Stance

Columns = dict[str, NDArray[Any]]
"""Arrays by name, the first axis the case.

Words are codes, and `words/<name>` holds the words themselves; `edges/<measure>` holds the names along the
second axis of `<measure>_edge`.
"""

POSE = ("z_m", "roll_rad", "pitch_rad")
RESIDUALS = ("equilibrium", "gap_m", "loop_m", "complementarity")
EDGES = "edges/"
WORDS = "words/"
BOUNDS = "bounds"
PLAIN = "plain_path"
TENSION = "tension_n"


@dataclass(frozen=True)
class Layout:
    """The names along the wheel, joint and track dimensions, and the measures asked for.

    Attributes:
        wheels: wheels, then feet.
        joints: moving joints.
        measures: asked for.
        tracks: cables around wheels.
        auxiliary: those of `wheels` that are none of the wheels that should carry.
        units: of declared parameters, where the sidecar says.
    """

    wheels: tuple[str, ...]
    joints: tuple[str, ...]
    measures: tuple[str, ...]
    tracks: tuple[str, ...] = ()
    auxiliary: tuple[str, ...] = ()
    units: Mapping[str, str] = field(default_factory=dict)

    @property
    def margins(self) -> tuple[str, ...]:
        """The measures that give a margin (all but the load intervals)."""
        return tuple(name for name in self.measures if name != BOUNDS)

    @property
    def bearing(self) -> list[int]:
        """Which of `wheels` should carry."""
        return [k for k, name in enumerate(self.wheels) if name not in self.auxiliary]


class Rows:
    """Rows being filled, case by case; a row that is never filled in says NaN and no word."""

    def __init__(self, layout: Layout, count: int) -> None:
        self.layout = layout
        self._status = [""] * count
        self._reason = [""] * count
        self._limiting = {name: [""] * count for name in layout.margins}
        self._edges: dict[str, list[Mapping[str, float]]] = {name: [{}] * count for name in layout.margins}
        wide = {"load_n": layout.wheels, "joint_rad": layout.joints}
        if layout.tracks:
            wide[TENSION] = layout.tracks
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
        if self.layout.tracks:
            numbers[TENSION][row] = [stance.tensions[name] for name in self.layout.tracks]
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
        """Everything as arrays; the plain path answered."""
        out: Columns = {**coded("status", Words.of(self._status)), **coded("reason", Words.of(self._reason))}
        out |= {PLAIN: np.ones(len(self._status), dtype=np.int8), **self._numbers}
        for name in self.layout.margins:
            out |= coded(f"{name}_limiting", Words.of(self._limiting[name]))
            names = sorted({edge for edges in self._edges[name] for edge in edges})
            out[EDGES + name] = np.array(names, dtype=np.str_)
            out[f"{name}_edge"] = _table(self._edges[name], names)
        return out


def coded(name: str, words: Words) -> Columns:
    """A column of words."""
    return {name: words.code, WORDS + name: words.known}


def words(columns: Columns, name: str) -> Words:
    """The words of a column."""
    return Words(columns[name], columns[WORDS + name])


def _table(rows: Sequence[Mapping[str, float]], names: Sequence[str]) -> Array:
    """(rows, names), NaN where a row has no such edge."""
    place = {name: k for k, name in enumerate(names)}
    table = np.full((len(rows), len(names)), np.nan)
    for i, row in enumerate(rows):
        for name, value in row.items():
            table[i, place[name]] = value
    return table


def is_list(name: str) -> bool:
    """Whether an array of that name lists names or words, and holds no rows."""
    return name.startswith((EDGES, WORDS))


def count_of(columns: Columns) -> int:
    """The number of rows."""
    return len(columns["status"])


def cut(columns: Columns, rows: slice | NDArray[np.int64]) -> Columns:
    """Some of the rows; names and words stay as they are."""
    return {key: values if is_list(key) else values[rows] for key, values in columns.items()}


def joined(parts: Sequence[Columns]) -> Columns:
    """Parts in the order of their cases as one; edges that only some parts have are NaN in the others."""
    if len(parts) == 1:
        return parts[0]
    out: Columns = {}
    for key in parts[0]:
        if key.startswith(EDGES):
            measure = key.removeprefix(EDGES)
            names = np.unique(np.concatenate([part[key] for part in parts]))
            out[key] = names
            out[f"{measure}_edge"] = np.concatenate([widened(part, measure, names) for part in parts])
        elif WORDS + key in parts[0]:
            out |= coded(key, joined_words([words(part, key) for part in parts]))
        elif not key.startswith(WORDS) and not _is_table(key, parts[0]):
            out[key] = np.concatenate([part[key] for part in parts])
    return out


def compact(columns: Columns) -> Columns:
    """Without words that no row says."""
    out = dict(columns)
    for key in columns:
        if WORDS + key in columns:
            out |= coded(key, Words.picked(columns[key], columns[WORDS + key]))
    return out


def _is_table(key: str, columns: Columns) -> bool:
    return key.endswith("_edge") and EDGES + key.removesuffix("_edge") in columns


def widened(part: Columns, measure: str, names: NDArray[np.str_]) -> Array:
    """(rows, names): a part's edges of one measure along sorted names that hold its own."""
    own: Array = part[f"{measure}_edge"]
    if len(own.T) == len(names):
        return own
    wide = np.full((len(own), len(names)), np.nan)
    wide[:, np.searchsorted(names, part[EDGES + measure])] = own
    return wide
