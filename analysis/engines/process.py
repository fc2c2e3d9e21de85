"""Chunks on worker processes of this machine, each started afresh (spawn)."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool

from rover_pin.analysis.engines import Resources, Work, Worker
from rover_pin.analysis.engines._feeding import feed
from rover_pin.analysis.engines._local import cores, one_thread, refuse_in_worker
from rover_pin.analysis.job import Chunk, Done
from rover_pin.analysis.rows import Columns
from rover_pin.errors import SolverError

_runner: Worker | None = None


class Processes:
    """One worker a core unless told otherwise."""

    takes_scheduler = False

    def workers(self, resources: Resources) -> int:
        """As many as asked for, else the cores this process may use."""
        return cores() if resources.workers is None else resources.workers

    def run(self, job: Work, chunks: Sequence[Chunk], resources: Resources, done: Done) -> None:
        """Carry out the chunks; at an interrupt or an error those under way are finished, no more are begun.

        Raises:
            StudyError: called from a script that guards no main part.
            SolverError: a case failed, or a worker died.
        """
        refuse_in_worker("process")
        count = max(1, min(self.workers(resources), len(chunks)))
        context = multiprocessing.get_context("spawn")
        with one_thread(), ProcessPoolExecutor(count, context, _start, (job,)) as pool:
            try:
                feed(chunks, lambda chunk: pool.submit(_work, chunk), lambda: 2 * count, done)
            except BrokenProcessPool:
                cure = (
                    "in a script, put what runs the study under `if __name__ == '__main__':`; "
                    "else look at the memory it takes; what is finished is kept for --resume"
                )
                raise SolverError("a worker process died", element="engine process", cure=cure) from None


def _start(job: Work) -> None:
    """Make a worker ready: the parent alone answers Ctrl-C, and no worker outlives its parent."""
    global _runner
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_follow_parent, daemon=True).start()
    _runner = job.runner()


def _follow_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def _work(chunk: Chunk) -> Columns:
    if _runner is None:
        raise SolverError("a worker was not made ready", element="engine process")
    return _runner.run(chunk)


ENGINE = Processes()
