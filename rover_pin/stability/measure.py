"""What makes a measure: its name, its formula on a standing rover, and when it applies."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Literal

from rover_pin.numerics import Array
from rover_pin.stability.margin import Margin
from rover_pin.stability.support import SupportPolygon, support_polygon
from rover_pin.statics.friction_problem import FrictionProblem, friction_problem
from rover_pin.statics.stance import Stance

if TYPE_CHECKING:
    from rover_pin.rover import Rover


@dataclass(frozen=True)
class Standing:
    """A settled stance as measures read it; what several of them need is computed once.

    Attributes:
        stance: the stance.
        friction: coefficient everywhere, or None for what the shapes declare.
    """

    stance: Stance
    friction: float | None = None

    @cached_property
    def polygon(self) -> SupportPolygon:
        """The support polygon, or the reason why there is none."""
        return support_polygon(
            [c.point for c in self.stance.contacts], [c.wheel for c in self.stance.contacts]
        )

    @cached_property
    def problem(self) -> FrictionProblem:
        """Contacts, friction and equilibrium, for the measures that ask for friction."""
        return friction_problem(self.stance, self.friction)


def _always(rover: Rover) -> str:
    return ""


@dataclass(frozen=True)
class Measure:
    """A measure of stability.

    Attributes:
        name: what users call it.
        unit: of its value.
        better: whether a higher or a lower value is safer.
        cost_ms: about what it costs a stance with six wheels, beside the shared support polygon (0.05).
        evaluate: gives its margin.
        missing: says what a rover lacks for the measure to apply to it; empty where nothing.
    """

    name: str
    unit: str
    better: Literal["high", "low"]
    cost_ms: float
    evaluate: Callable[[Standing], Margin]
    missing: Callable[[Rover], str] = _always

    @property
    def cheap(self) -> bool:
        """Whether it needs no optimisation."""
        return self.cost_ms < 0.2

    def margin(self, edges: Mapping[str, float], *, note: str = "", **details: float) -> Margin:
        """The margin whose value is the worst of `edges`; closed where there are none."""
        if not edges:
            return self.closed(note or "nothing to measure")
        if any(math.isnan(v) for v in edges.values()):
            return self.closed("the measure has no number here")
        worst = min if self.better == "high" else max
        limiting = worst(edges, key=edges.__getitem__)
        return Margin(self.name, edges[limiting], self.unit, limiting, edges, self.better, note, details)

    def closed(self, note: str) -> Margin:
        """No answer, which counts as the worst one."""
        value = -math.inf if self.better == "high" else math.inf
        return Margin(self.name, value, self.unit, None, {}, self.better, note)

    def on_polygon(
        self, standing: Standing, edges: Callable[[Array, Array], Array], note: str = ""
    ) -> Margin:
        """The margin of a formula on the support polygon's edges.

        Args:
            standing: the rover.
            edges: gives (n,) margins from the edges' starts and ends, (n, 3) each.
            note: for the margin.
        """
        polygon = standing.polygon
        if polygon.reason:
            return self.closed(polygon.reason)
        values = edges(polygon.points, polygon.ends)
        return self.margin(dict(zip(polygon.edges, values.tolist(), strict=True)), note=note)


def ordered(measures: Sequence[Measure]) -> dict[str, Measure]:
    """A table by name, cheap measures first, then by name."""
    return {m.name: m for m in sorted(measures, key=lambda m: (not m.cheap, m.name))}
