"""The k-th smallest of many numbers that are read in blocks: exact, in constant memory.

Radix selection: floats map to unsigned integers of the same order, and their digits are counted from the
highest down. Each pass over the numbers settles 16 of 64 bits of every number that is looked for.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from rover_pin.numerics import Array

DIGIT = 16
_SIGN = np.uint64(1 << 63)


def ranked(blocks: Callable[[], Iterable[Array]], ranks: Sequence[int]) -> list[float]:
    """The numbers of these ranks, 0 the smallest; `blocks` gives all numbers each time it is called."""
    prefixes = [0] * len(ranks)
    left = list(ranks)
    for shift in range(64 - DIGIT, -1, -DIGIT):
        counts = {prefix: np.zeros(1 << DIGIT, dtype=np.int64) for prefix in prefixes}
        for block in blocks():
            keys = _keys(block)
            for prefix, count in counts.items():
                same = keys if shift == 64 - DIGIT else keys[keys >> np.uint64(shift + DIGIT) == prefix]
                digits = (same >> np.uint64(shift)).astype(np.int64) & ((1 << DIGIT) - 1)
                count += np.bincount(digits, minlength=1 << DIGIT)
        for k, prefix in enumerate(prefixes):
            below = np.cumsum(counts[prefix])
            digit = int(np.searchsorted(below, left[k], side="right"))
            left[k] -= int(below[digit - 1]) if digit else 0
            prefixes[k] = prefix << DIGIT | digit
    return [_number(prefix) for prefix in prefixes]


def _keys(values: Array) -> NDArray[np.uint64]:
    """Unsigned integers in the order of the floats: all bits turned where negative, else the sign."""
    bits = np.ascontiguousarray(values).view(np.uint64)
    return np.where(bits & _SIGN, ~bits, bits | _SIGN)


def _number(key: int) -> float:
    bits = np.array([key], dtype=np.uint64)
    turned = np.where(bits & _SIGN, bits ^ _SIGN, ~bits)
    return float(turned.view(np.float64)[0])
