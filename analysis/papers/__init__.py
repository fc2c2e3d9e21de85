"""Papers: each one's figures beside ours, with a verdict.

A module or folder here with a `PAPER` is a paper of that name. Papers keep their own axes, signs and units
here.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Mapping
from functools import cache
from typing import TYPE_CHECKING

from rover_pin.analysis.papers.chart import Chart, Curve, Mark, Panel
from rover_pin.analysis.papers.finding import (
    IN_SAMPLE,
    NOT_REPRODUCED,
    PARTLY,
    REPRODUCED,
    VERDICTS,
    Finding,
)
from rover_pin.analysis.papers.paper import Paper, Results
from rover_pin.errors import StudyError, nearest

if TYPE_CHECKING:
    from rover_pin.rover import Rover

__all__ = [
    "IN_SAMPLE",
    "NOT_REPRODUCED",
    "PARTLY",
    "REPRODUCED",
    "VERDICTS",
    "Chart",
    "Curve",
    "Finding",
    "Mark",
    "Panel",
    "Paper",
    "Results",
    "paper",
    "papers",
    "reproduce",
]


@cache
def papers() -> Mapping[str, Paper]:
    """Every paper there is, by its key."""
    found = {}
    for module in pkgutil.iter_modules(__path__):
        made = getattr(importlib.import_module(f"{__name__}.{module.name}"), "PAPER", None)
        if isinstance(made, Paper):
            found[made.key] = made
    return dict(sorted(found.items()))


def paper(key: str) -> Paper:
    """The paper of that key.

    Raises:
        StudyError: there is none; names the nearest.
    """
    known = papers()
    if key not in known:
        raise StudyError("no such paper", element="PAPER", value=key, cure=nearest(key, known))
    return known[key]


def reproduce(key: str, robots: Mapping[str, Rover] | None = None) -> Results:
    """Compute a paper's figures.

    Args:
        key: of the paper.
        robots: rovers to compute with in place of the bundled ones of the same names.

    Raises:
        StudyError: no such paper.
        DescriptionError: a robot of the paper is not bundled.
    """
    return paper(key).results(robots)
