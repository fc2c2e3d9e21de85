"""Chunks on worker processes of this machine, each started afresh (spawn)."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import threading
from collections.abc import Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool

from rover_pin.analysis.engines import Resources, Work, Worker
from rover_pin.analysis.job import Chunk, Done
from rover_pin.analysis.rows import Columns
from rover_pin.errors import SolverError, StudyError

ONE_THREAD = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
"""Matrices are small: threads below a worker only get in its way."""

_runner: Worker | None = None


class Processes:
    """One worker a core unless told otherwise."""

    takes_scheduler = False

    def workers(self, resources: Resources) -> int:
        """As many as asked for, else the cores this process may use."""
        if resources.workers is not None:
            return resources.workers
        return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1

    def run(self, job: Work, chunks: Sequence[Chunk], resources: Resources, done: Done) -> None:
        """Carry out the chunks; at an interrupt or an error those under way are finished, no more are begun.

        Raises:
            StudyError: called from a script that guards no main part.
            SolverError: a case failed, or a worker died.
        """
        if multiprocessing.parent_process() is not None:
            cure = "put what runs the study under `if __name__ == '__main__':`"
            raise StudyError("a worker process started the study again", element="engine process", cure=cure)
        count = max(1, min(self.workers(resources), len(chunks)))
        context = multiprocessing.get_context("spawn")
        with _one_thread(), ProcessPoolExecutor(count, context, _start, (job,)) as pool:
            try:
                _feed(pool, list(chunks), 2 * count, done)
            except BrokenProcessPool:
                cure = (
                    "in a script, put what runs the study under `if __name__ == '__main__':`; "
                    "else look at the memory it takes; what is finished is kept for --resume"
                )
                raise SolverError("a worker process died", element="engine process", cure=cure) from None


def _feed(pool: ProcessPoolExecutor, chunks: list[Chunk], ahead: int, done: Done) -> None:
    """Keep at most `ahead` chunks submitted; on the way out cancel those not begun."""
    waiting = iter(chunks)
    running: dict[Future[Columns], Chunk] = {}

    def more() -> None:
        for chunk in waiting:
            running[pool.submit(_work, chunk)] = chunk
            if len(running) >= ahead:
                return

    try:
        more()
        while running:
            finished, _ = wait(running, return_when=FIRST_COMPLETED)
            for future in finished:
                done(running.pop(future), future.result())
            more()
    finally:
        for future in running:
            future.cancel()


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


@contextlib.contextmanager
def _one_thread() -> Iterator[None]:
    """Workers inherit one thread each; this process keeps its own setting."""
    before = {name: os.environ.get(name) for name in ONE_THREAD}
    os.environ.update(dict.fromkeys(ONE_THREAD, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


ENGINE = Processes()
