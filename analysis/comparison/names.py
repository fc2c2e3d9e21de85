"""Short names of designs side by side, and the cases in which one alone settles, in words."""

from __future__ import annotations

import string
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rover_pin.analysis.comparison.result import Pair


def letters(labels: Sequence[str]) -> dict[str, str]:
    """A short name for each design: A to Z, then numbers."""
    names = [*string.ascii_uppercase, *map(str, range(27, len(labels) + 1))]
    return dict(zip(labels, names, strict=False))


def lone(pair: Pair, names: Mapping[str, str], named: int) -> Iterator[str]:
    """Where one of a pair alone settles: how the other ends there, and up to `named` cases."""
    a, b = names[pair.first], names[pair.second]
    for one, other, cases, ended in (
        (a, b, pair.only_first, pair.otherwise_second),
        (b, a, pair.only_second, pair.otherwise_first),
    ):
        if cases:
            how = ", ".join(f"{word} {count}" for word, count in ended.items())
            told = ", ".join(map(str, cases[:named])) + (", ..." if len(cases) > named else "")
            yield f"only {one} settles in {len(cases)} ({other}: {how}): cases {told}"
