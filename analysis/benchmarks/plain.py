"""The plain path over places, one by one, timed: `rover_pin.settle`, and the measures of who stands."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rover_pin.analysis.benchmarks.clock import NOTHING, Spent, spent
from rover_pin.analysis.benchmarks.scene import Places, Scene
from rover_pin.errors import OffMapError, SolverError
from rover_pin.stability.report import stability
from rover_pin.statics.settle import settle
from rover_pin.statics.stance import Stance, Status


@dataclass(frozen=True)
class Answered:
    """A case by the plain path.

    Attributes:
        status: the word.
        stance: how it stands; None where the place is off the map or no stance came out.
        values: measure -> value, where it is settled and measures were asked for.
        spent: what it took.
    """

    status: str
    stance: Stance | None
    values: Mapping[str, float]
    spent: Spent


def answer_plainly(scene: Scene, places: Places, measures: tuple[str, ...] = ()) -> list[Answered]:
    """Every place in turn."""
    return [_answer(scene, places, i, measures) for i in range(len(places))]


def total(answered: list[Answered]) -> Spent:
    """What they took together."""
    return sum((each.spent for each in answered), NOTHING)


def slowest_ms(answered: list[Answered]) -> float:
    """Of the processor, ms; NaN where there are none."""
    return 1e3 * max((each.spent.cpu for each in answered), default=np.nan)


def _answer(scene: Scene, places: Places, i: int, measures: tuple[str, ...]) -> Answered:
    x, y, yaw = float(places.x[i]), float(places.y[i]), float(places.yaw[i])
    stance, values, status = None, {}, ""
    with spent() as timer:
        try:
            stance = settle(scene.rover, scene.terrain, x=x, y=y, yaw=yaw)
            if stance.settled and measures:
                values = {name: margin.value for name, margin in stability(stance, measures).items()}
        except OffMapError:
            status = str(Status.OFF_MAP)
        except SolverError:
            status = str(Status.NO_CONVERGENCE)
    return Answered(status if stance is None else str(stance.status), stance, values, timer.spent)
