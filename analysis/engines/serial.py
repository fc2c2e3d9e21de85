"""One chunk after the other in this process."""

from __future__ import annotations

from collections.abc import Sequence

from rover_pin.analysis.engines import Resources, Work
from rover_pin.analysis.job import Chunk, Done


class Serial:
    """No other process; `workers` is ignored."""

    takes_scheduler = False

    def workers(self, resources: Resources) -> int:
        """One."""
        return 1

    def run(self, job: Work, chunks: Sequence[Chunk], resources: Resources, done: Done) -> None:
        """Carry out the chunks."""
        runner = job.runner()
        for chunk in chunks:
            done(chunk, runner.run(chunk))


ENGINE = Serial()
