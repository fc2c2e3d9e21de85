"""The measures a study can ask for: every registered margin, and the wheels' load intervals."""

from __future__ import annotations

import sys

from rover_pin.analysis.rows import BOUNDS
from rover_pin.stability.registry import MEASURES


def known_measures() -> list[str]:
    """Names of all measures."""
    return [*MEASURES, BOUNDS]


def title(name: str) -> str:
    """What a measure is, in the words of its module."""
    words = sys.modules[MEASURES[name].evaluate.__module__].__doc__ or name
    return words.strip().splitlines()[0].rstrip(".")
