"""Holding torque: the least that the strongest motor must give."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rover_pin.stability.margin import Margin
from rover_pin.stability.measure import Measure, Standing
from rover_pin.statics.distribute import smallest_torque

if TYPE_CHECKING:
    from rover_pin.rover import Rover


def evaluate(standing: Standing) -> Margin:
    """The least possible largest torque of a driven wheel at rest, within friction [N m].

    Edges: each driven wheel's |torque| in the forces that attain it. Inf where friction cannot hold the
    rover. Details: `friction` (largest ratio those forces use).

    Cost: 1.7 ms a stance with six wheels, 0.8 beside `friction`.
    """
    problem = standing.problem
    driven = [w for w in dict.fromkeys(c.wheel for c in problem.contacts) if w in problem.driven]
    if not driven:
        return MEASURE.closed("no driven wheel touches the ground")
    forces = smallest_torque(problem)
    if not forces.feasible:
        return MEASURE.closed(forces.reason)
    return MEASURE.margin({w: abs(forces.torques[w]) for w in driven}, friction=forces.friction)


def missing(rover: Rover) -> str:
    """What the rover lacks, or nothing."""
    driven = any(wheel.drive is not None and not wheel.free for wheel in rover.wheels)
    return "" if driven else f"no wheel of {rover.name} is driven"


MEASURE = Measure("torque", "N m", "low", 1.7, evaluate, missing)
