"""Words of many cases as small numbers into a short list of the words that occur."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Words:
    """One word a case.

    Attributes:
        code: (n,) unsigned, index into `known`.
        known: (k,) str, sorted, each of them said by some case.
    """

    code: NDArray[np.unsignedinteger[Any]]
    known: NDArray[np.str_]

    @classmethod
    def of(cls, words: Sequence[str] | NDArray[np.str_]) -> Words:
        """From the words themselves."""
        known, code = np.unique(np.asarray(words, dtype=np.str_), return_inverse=True)
        return cls(_small(code, len(known)), known)

    @classmethod
    def picked(cls, code: NDArray[Any], known: Sequence[str] | NDArray[np.str_]) -> Words:
        """From numbers into any list of words: repeated ones and ones nobody says are welcome."""
        said = np.bincount(code, minlength=len(known)) > 0
        names = np.asarray(known, dtype=np.str_)
        sorted_names, place = np.unique(names[said], return_inverse=True)
        new = np.zeros(len(known), dtype=np.int64)
        new[said] = place
        return cls(_small(new[code], len(sorted_names)), tight(sorted_names))

    def spelled(self) -> NDArray[np.str_]:
        """(n,) the words."""
        return self.known[self.code] if len(self.known) else np.empty(len(self.code), dtype="U1")

    def letters(self, width: int) -> NDArray[np.bytes_]:
        """(n, width) single bytes of UTF-8, filled up with nothing."""
        kind = f"S{width}"
        if not len(self.known):
            return np.zeros((len(self.code), width), dtype="S1")
        spelled = np.char.encode(self.known, "utf-8").astype(kind)[self.code]
        letters: NDArray[np.bytes_] = spelled.view("S1").reshape(len(self.code), width)
        return letters


def joined_words(parts: Sequence[Words]) -> Words:
    """Parts one after the other."""
    known = np.unique(np.concatenate([part.known for part in parts]))
    codes = [np.searchsorted(known, part.known)[part.code] for part in parts]
    return Words(_small(np.concatenate(codes), len(known)), known)


def tight(known: NDArray[np.str_]) -> NDArray[np.str_]:
    """The same words in an array no wider than the longest of them."""
    return np.array(known.tolist(), dtype=np.str_)


def longest(known: NDArray[np.str_]) -> int:
    """Bytes of UTF-8 that the longest word takes; at least 1, so that there is a place for it."""
    return max((len(str(word).encode()) for word in known), default=0) or 1


def _small(code: NDArray[Any], count: int) -> NDArray[np.unsignedinteger[Any]]:
    """Codes in the smallest type that holds them."""
    return code.astype(np.min_scalar_type(max(count - 1, 0)))
