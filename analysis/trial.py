"""The first cases tried: how long a case takes and how many bytes, so that chunks and disk can be sized."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

from rover_pin.analysis.job import Runner
from rover_pin.analysis.rows import Columns, count_of

CHUNK_SECONDS = 0.75
LARGEST_CHUNK = 100_000
TRIAL_SECONDS = 0.25
LARGEST_TRIAL = 50_000


@dataclass(frozen=True)
class Trial:
    """The last and longest of some runs of the first cases.

    Attributes:
        columns: its rows.
        seconds: of a case.
    """

    columns: Columns
    seconds: float

    @property
    def part_bytes(self) -> float:
        """Bytes of a case in a part."""
        return sum(values.nbytes for values in self.columns.values()) / count_of(self.columns)

    def chunk(self, count: int, workers: int) -> int:
        """Cases that take about three quarters of a second, or so many less that all workers end together."""
        timely = min(math.ceil(CHUNK_SECONDS / max(self.seconds, 1e-9)), LARGEST_CHUNK)
        rounds = math.ceil(count / (workers * timely))
        return math.ceil(count / (workers * rounds))


def trial(runner: Runner, count: int, chunk: int | None = None) -> Trial:
    """Run more and more of the first cases until that takes a quarter of a second.

    Args:
        runner: of the job.
        count: of cases in all.
        chunk: the most cases to try; None where the trial may say.
    """
    most = min(count, LARGEST_TRIAL, LARGEST_CHUNK if chunk is None else chunk)
    runner.run((0, 1))  # warm: models built, formulas loaded
    size = min(most, 4)
    while True:
        start = time.perf_counter()
        columns = runner.run((0, size))
        taken = max(time.perf_counter() - start, 1e-6)
        if size == most or taken > TRIAL_SECONDS:
            return Trial(columns, taken / size)
        size = min(most, 8 * size, math.ceil(1.5 * size * TRIAL_SECONDS / taken))
