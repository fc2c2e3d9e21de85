"""Wheel loads: how evenly they are shared."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from rover_pin.stability.margin import Margin
from rover_pin.stability.measure import Measure, Standing

if TYPE_CHECKING:
    from rover_pin.rover import Rover


def evaluate(standing: Standing) -> Margin:
    """The least wheel's load over the mean load [-]: 1 where all are equal, 0 where a wheel carries nothing.

    The edges are each wheel's share of the mean. Details: `range_n` (largest less least, N), `max_over_mean`,
    `std_over_mean` (of the whole set), `mean_n`. Wheels that do not touch count as zero; auxiliary
    ones are left out.
    """
    idle = {wheel.name for wheel in standing.stance.rover.wheels if wheel.auxiliary}
    loads = {name: load for name, load in standing.stance.loads.items() if name not in idle}
    mean = math.fsum(loads.values()) / len(loads) if loads else 0.0
    if mean <= 0.0:
        return MEASURE.closed("no wheel carries anything")
    least, largest = min(loads.values()), max(loads.values())
    spread = math.sqrt(math.fsum((load - mean) ** 2 for load in loads.values()) / len(loads))
    more = standing.stance.redundant
    return MEASURE.margin(
        {name: load / mean for name, load in loads.items()},
        note=f"{more} more supports than equilibrium determines: loads of least squares" if more else "",
        range_n=largest - least,
        max_over_mean=largest / mean,
        std_over_mean=spread / mean,
        mean_n=mean,
    )


def missing(rover: Rover) -> str:
    """What the rover lacks, or nothing."""
    return "" if rover.bearing else f"every wheel of {rover.name} is auxiliary: none should carry"


MEASURE = Measure("loads", "-", "high", 0.01, evaluate, missing)
