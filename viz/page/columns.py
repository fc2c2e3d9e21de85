"""Columns as a page carries them: 16 bits a number where that is enough, byte planes, words by number.

A page's values are rounded; each column says by how much. The study's netCDF file is the record.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

NOTHING, PLUS, MINUS = 65535, 65534, 65533  # codes for NaN, +inf, -inf
LAST = 65532
TAIL = 50.0  # a range so many times that of the inner 98 % is a heavy tail


@dataclass(frozen=True)
class Column:
    """One column.

    Attributes:
        kind: `u16` (low + step code), `f32`, or `words` (code into `words`).
        data: its bytes, all low bytes first, then the next (byte planes pack better).
        low: m, N, ...: value of code 0.
        step: between codes.
        rounding: largest difference of a finite value from what was given.
        words: the words, for kind `words`.
    """

    kind: str
    data: bytes
    low: float = 0.0
    step: float = 0.0
    rounding: float = 0.0
    words: tuple[str, ...] = ()

    def about(self) -> dict[str, Any]:
        """What the page needs to read the bytes."""
        return {
            "kind": self.kind,
            "low": self.low,
            "step": self.step,
            "rounding": self.rounding,
            "words": list(self.words),
        }


def planes(values: NDArray[Any]) -> bytes:
    """The bytes of little-endian values, plane by plane."""
    little = np.ascontiguousarray(values).astype(values.dtype.newbyteorder("<"), copy=False)
    return little.view(np.uint8).reshape(len(little), -1).T.tobytes()


def unplaned(data: bytes, dtype: str) -> NDArray[Any]:
    """The values of byte planes; the inverse of `planes`."""
    size = np.dtype(dtype).itemsize
    return np.ascontiguousarray(np.frombuffer(data, np.uint8).reshape(size, -1).T).view(f"<{dtype}").ravel()


def numbers(values: ArrayLike) -> Column:
    """A column of numbers; 16 bits a value unless a heavy tail would cost the rest its digits."""
    given = np.asarray(values, dtype=np.float64)
    finite = given[np.isfinite(given)]
    if not len(finite):
        low = reach = 0.0
    else:
        low, reach = float(finite.min()), float(np.ptp(finite))
        inner = float(np.subtract(*np.percentile(finite, [99, 1])))
        if reach > TAIL * max(inner, 1e-300):
            return _wide(given, finite)
    step = reach / LAST if reach > 0 else 1.0
    with np.errstate(invalid="ignore"):
        codes = np.where(np.isfinite(given), np.rint((given - low) / step), 0).astype(np.uint16)
    codes[np.isnan(given)] = NOTHING
    codes[np.isposinf(given)] = PLUS
    codes[np.isneginf(given)] = MINUS
    return Column("u16", planes(codes), low, step, 0.5 * step if reach > 0 else 0.0)


def _wide(given: NDArray[np.float64], finite: NDArray[np.float64]) -> Column:
    kept = finite.astype(np.float32).astype(np.float64)
    return Column(
        "f32", planes(given.astype(np.float32)), rounding=float(np.abs(kept - finite).max(initial=0.0))
    )


def words(values: Iterable[Any]) -> Column:
    """A column of words by their number in a list, in order of appearance; past 65532 the rest are `...`."""
    known: dict[str, int] = {}
    codes = [min(known.setdefault(str(value), len(known)), LAST) for value in values]
    listed = list(known)
    if len(listed) > LAST + 1:
        listed = [*listed[:LAST], "..."]
    return Column("words", planes(np.array(codes, dtype=np.uint16)), words=tuple(listed))


def decoded(about: dict[str, Any], data: bytes) -> NDArray[Any]:
    """What a page reads from a column: the inverse of `numbers` and `words`, to `rounding`."""
    if about["kind"] == "f32":
        return unplaned(data, "f4").astype(np.float64)
    codes = unplaned(data, "u2")
    if about["kind"] == "words":
        listed: NDArray[Any] = np.array(about["words"], dtype=object)[codes]
        return listed
    values: NDArray[Any] = about["low"] + about["step"] * codes.astype(np.float64)
    values[codes == NOTHING], values[codes == PLUS], values[codes == MINUS] = np.nan, np.inf, -np.inf
    return values
