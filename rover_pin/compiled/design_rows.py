"""Numbers of a description that may depend on parameters: read once, filled in for many designs."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rover_pin.description.trace import TOKEN, Ref, Trace, UntraceableError
from rover_pin.description.trace_values import Values, each
from rover_pin.numerics import Array

Flags = NDArray[np.bool_]
Entry = float | Ref
Row = tuple[Entry, ...]
"""Numbers of one attribute: constants, and nodes of the trace."""

Stated = Mapping[tuple[str | int, ...], Entry]
"""Numbers of the sidecar that are formulas of parameters that vary, by where they stand in it."""

_SIGNED = re.compile(rf"([+-]?)({TOKEN.pattern})")


def read_row(text: str, trace: Trace, element: str) -> Row:
    """The numbers of an attribute's text.

    Raises:
        UntraceableError: a token that is only part of a number, or no number at all.
    """
    row: list[float | Ref] = []
    for part in text.split():
        found = _SIGNED.fullmatch(part)
        if found:
            number = trace.of(int(found.group(3)))
            if found.group(1):
                number.trace.guard("ge", lambda a, b: a >= b, number, 0)  # "--1" is no number
            row.append(Ref((-number).index if found.group(1) == "-" else number.index))
            continue
        try:
            row.append(float(part))
        except ValueError:
            raise UntraceableError(
                "a number is put together from pieces of text", element=element, value=_shown(part, trace)
            ) from None
    return tuple(row)


def stated_row(stated: Stated, nominal: Sequence[float], *path: str | int) -> Row:
    """A list of numbers of the sidecar; nominal those that no formula makes vary."""
    return tuple(stated.get((*path, k), float(value)) for k, value in enumerate(nominal))


def refs(rows: Iterable[Row]) -> set[int]:
    """Nodes that rows are made of."""
    return {entry.index for row in rows for entry in row if isinstance(entry, Ref)}


def _shown(text: str, trace: Trace) -> str:
    return TOKEN.sub(lambda found: f"[{trace.of(int(found.group(1))).trace_of()}]", text)


@dataclass
class Sheet:
    """Rows filled in for n designs, and which designs are still in order.

    Arrays have a leading axis of n, or of one where no design differs.

    Attributes:
        values: the trace's nodes.
        stated: the sidecar's formulas.
        valid: (n,).
    """

    values: Values
    stated: Stated = field(default_factory=dict)
    valid: Flags = field(init=False)

    def __post_init__(self) -> None:
        """Begin with the designs that go the trace's way."""
        self.valid = self.values.valid.copy()

    def row(self, row: Row) -> Array:
        """(n, k), or (1, k) of constants."""
        if not refs([row]):
            return np.array([row], dtype=np.float64).reshape(1, len(row))
        filled = np.empty((self.values.count, len(row)))
        for i, entry in enumerate(row):
            filled[:, i] = self.values.numbers[entry.index] if isinstance(entry, Ref) else entry
        return filled

    def number(self, nominal: float, *path: str | int) -> Array:
        """(n,) or (1,): a number of the sidecar, nominal unless it is a formula there."""
        return self.row((self.stated.get(path, float(nominal)),))[:, 0]

    def numbers(self, nominal: Sequence[float], *path: str | int) -> Array:
        """(n, k) or (1, k): a list of numbers of the sidecar."""
        return self.row(stated_row(self.stated, nominal, *path))

    def require(self, good: Flags) -> None:
        """Leave to the loader designs that are not good: (n,) or (1,)."""
        self.valid &= good

    def each(self, function: Callable[..., Any], *columns: Array) -> Array:
        """A function called number by number on (n,) or (1,) columns; bits as alone."""
        count = max(len(column) for column in columns)
        return each(function, *(np.broadcast_to(c, (count,)) for c in columns), count=count)[0]

    def stack(self, parts: Sequence[Array], *shape: int) -> Array:
        """(n, len(parts), ...) from arrays of (n, ...) or (1, ...)."""
        stacked = np.empty((self.values.count, len(parts), *shape))
        for i, part in enumerate(parts):
            stacked[:, i] = part
        return stacked
