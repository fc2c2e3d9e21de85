"""The compiled path over many places, timed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rover_pin.analysis.benchmarks.clock import Spent, least, spent
from rover_pin.analysis.benchmarks.scene import Places, Scene
from rover_pin.compiled import OPEN, Answers, Batch

CHUNK = 20_000
"""Cases a call: what a study's worker is given, no more memory than that."""

WARM = 200


@dataclass(frozen=True)
class Timed:
    """Answers of all places, and the least time of several turns over them."""

    answers: list[Answers]
    spent: Spent

    @property
    def open(self) -> NDArray[np.int64]:
        """Cases left to the plain path."""
        return np.flatnonzero(np.concatenate([each.code == OPEN for each in self.answers]))


def make(scene: Scene, measures: tuple[str, ...] = ()) -> Batch:
    """A Batch that is compiled and warm."""
    batch = Batch(scene.rover, scene.terrain, measures=measures)
    ask(batch, scene.places(WARM))
    return batch


def ask(batch: Batch, places: Places) -> Answers:
    """One call."""
    return batch.answer(places.x, places.y, places.yaw)


def time_compiled(batch: Batch, places: Places, times: int = 3) -> Timed:
    """All places in calls of `CHUNK`."""
    parts = [slice(k, k + CHUNK) for k in range(0, len(places), CHUNK)]
    chunks = [Places(places.x[part], places.y[part], places.yaw[part]) for part in parts]
    answers, time = least(lambda: [ask(batch, chunk) for chunk in chunks], times)
    return Timed(answers, time)


def slowest_ms(batch: Batch, places: Places, cases: NDArray[np.int64]) -> float:
    """The slowest of these cases asked alone, ms of the processor; the call about it included.

    The ten slowest are asked thrice more and the least counts: a core that was taken away is not the case's.
    """

    def one(i: int) -> float:
        with spent() as timer:
            ask(batch, Places(places.x[i : i + 1], places.y[i : i + 1], places.yaw[i : i + 1]))
        return timer.spent.cpu

    first = np.array([one(int(i)) for i in cases])
    again = [min(float(first[k]), *(one(int(cases[k])) for _ in range(3))) for k in np.argsort(first)[-10:]]
    return 1e3 * max(again)
