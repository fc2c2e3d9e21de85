"""What a run's log says beyond its columns: clearance over time, spans of actions and of lifted wheels."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Generic, TypeVar

import numpy as np
import pinocchio as pin

if TYPE_CHECKING:
    from rover_pin.numerics import Array
    from rover_pin.simulation.run import Run

T = TypeVar("T", bound=Hashable)


@dataclass(frozen=True)
class Span(Generic[T]):
    """Neighbouring samples that say the same.

    Attributes:
        word: what they say.
        first: the first of them.
        last: the last of them.
    """

    word: T
    first: int
    last: int


def spans(words: Sequence[T]) -> tuple[Span[T], ...]:
    """Runs of equal words, in order; together they cover every sample once."""
    starts = [i for i in range(len(words)) if i == 0 or words[i] != words[i - 1]]
    ends = [*(start - 1 for start in starts[1:]), len(words) - 1]
    return tuple(Span(words[a], a, b) for a, b in zip(starts, ends, strict=True)) if starts else ()


def clearance(run: Run) -> Array | None:
    """(n,) m: the least height of the belly's points over the terrain below them, negative in the ground.

    As the measure `clearance` of a stance. None where the rover declares no belly points.
    """
    rover = run.rover
    if not rover.belly:
        return None
    data = rover.model.createData()
    places = np.empty((len(run.time), len(rover.belly), 3))
    points = [(belly.joint, np.asarray(belly.point, dtype=np.float64)) for belly in rover.belly]
    for sample, q in enumerate(np.asarray(run.configuration, dtype=np.float64)):
        pin.forwardKinematics(rover.model, data, q)
        for k, (joint, point) in enumerate(points):
            places[sample, k] = data.oMi[joint].act(point)
    heights = places[..., 2] - run.terrain.height(places[..., 0], places[..., 1])
    least: Array = heights.min(axis=1)
    return least
