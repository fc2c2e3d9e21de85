"""What the chunks of a study have in common, gathered as they come: the little that must be known of all."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from typing import Any

import numpy as np

from rover_pin.analysis.rows import EDGES, PLAIN, WORDS
from rover_pin.analysis.vocabulary import longest


class Found:
    """Names of edges, lengths of words, how many cases the plain path answered.

    Attributes:
        edges: measure to the names of its edges.
        width: column of words to the bytes that its longest word takes.
        plain: cases that the plain path answered.
        cases: cases in all.
    """

    def __init__(self) -> None:
        self.edges: defaultdict[str, set[str]] = defaultdict(set)
        self.width: defaultdict[str, int] = defaultdict(lambda: 1)
        self.plain = 0
        self.cases = 0

    def add(self, columns: Mapping[str, Any]) -> None:
        """Take in a chunk: its lists of names and words, and which path answered."""
        for key in columns:
            if key.startswith(EDGES):
                self.edges[key.removeprefix(EDGES)] |= {str(name) for name in columns[key]}
            elif key.startswith(WORDS):
                name = key.removeprefix(WORDS)
                self.width[name] = max(self.width[name], longest(columns[key]))
        answered = columns[PLAIN]
        self.plain += int(np.count_nonzero(answered))
        self.cases += len(answered)


def found_in(columns: Mapping[str, Any]) -> Found:
    """What one set of columns holds."""
    found = Found()
    found.add(columns)
    return found
