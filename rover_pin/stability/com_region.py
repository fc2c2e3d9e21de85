"""The margin of the centre of mass within the places that some limits allow it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.numerics import Array
from rover_pin.stability.margin import Margin
from rover_pin.stability.outline import EIGHTHS, Outline
from rover_pin.statics.com_reach import ComReach, Reached

if TYPE_CHECKING:
    from rover_pin.rover import Rover
    from rover_pin.stability.measure import Measure
    from rover_pin.statics.stance import Stance

_WHY = {
    "unbounded": "in some direction nothing limits where the centre of mass may be",
    "failed": "the solver found no answer it could prove",
}


def held_level(rover: Rover) -> str:
    """Why a rover's centre of mass has no region; empty where nothing but the ground holds its attitude."""
    held = [loop.name for loop in rover.loops if loop.type == "level"]
    return f"{held[0]} holds {rover.name} level wherever its centre of mass is" if held else ""


class _NoAnswerError(Exception):
    """A direction without an answer; it ends the search."""


def region_margin(measure: Measure, stance: Stance, reach: ComReach, nowhere: str) -> Margin:
    """Signed distance [m] of the centre of mass from the edge of its region, and the same for each eighth.

    Args:
        measure: whose margin it is.
        stance: the rover.
        reach: how far the centre of mass may be along a direction.
        nowhere: the note where no place is allowed.
    """
    asked: list[tuple[float, Reached]] = []

    def along(direction: Array) -> tuple[float, Array]:
        found = reach.toward(direction)
        if found.outcome != "solved":
            raise _NoAnswerError(nowhere if found.outcome == "infeasible" else _WHY[found.outcome])
        asked.append((math.atan2(direction[1], direction[0]), found))
        return found.value, found.place

    outline = Outline(along, float(stance.rpy[2]), reach.unit)
    try:
        if not outline.trace():
            return measure.closed(_WHY["failed"])
    except _NoAnswerError as error:
        return measure.closed(str(error))
    if outline.narrow:
        return measure.closed(f"the region is a {outline.narrow}")
    values, where = outline.least()
    worst = int(np.argmin(values))
    nearest = min(asked, key=lambda each: abs(math.remainder(each[0] - where[worst], math.tau)))[1]
    margin = measure.margin(
        dict(zip(EIGHTHS, values.tolist(), strict=True)),
        note="; ".join(reach.limits(nearest)),
        area_m2=outline.area,
        area_at_most_m2=outline.area_at_most,
        toward_rad=math.remainder(float(where[worst]) - float(stance.rpy[2]), math.tau),
    )
    corners = outline.corners() + stance.com[:2]
    return replace(margin, outline=tuple((float(x), float(y)) for x, y in corners))
