"""One measure's answer for one stance."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal


@dataclass(frozen=True)
class Margin:
    """How far a stance is from a limit.

    Attributes:
        measure: its name.
        value: the margin, the worst of its edges; negative past the limit where the measure is signed.
            A measure that has no answer fails closed: -inf where high is better, inf where low is.
        unit: of value and edges.
        limiting: the edge (wheel, contact, belly point) that limits; None where there is no answer.
        edges: every edge's own margin.
        better: `high` or `low`.
        note: what a reader must know besides; empty where nothing.
        details: further numbers, the unit in the name.
        outline: corners (x, y) of the measure's region, world [m], counterclockwise; empty where it has none.
    """

    measure: str
    value: float
    unit: str
    limiting: str | None
    edges: Mapping[str, float]
    better: Literal["high", "low"]
    note: str = ""
    details: Mapping[str, float] = field(default_factory=dict)
    outline: tuple[tuple[float, float], ...] = ()

    @property
    def answered(self) -> bool:
        """Whether there is an answer; where not, `note` says why."""
        return math.isfinite(self.value)
