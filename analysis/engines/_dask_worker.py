"""What a Dask worker keeps and does: the job, sent to it once, and the chunks it is asked for."""

from __future__ import annotations

import pickle
import signal
import threading
from collections.abc import Mapping
from typing import cast

from distributed import Worker, WorkerPlugin, get_worker

from rover_pin.analysis.engines import Worker as ChunkWorker
from rover_pin.analysis.engines._alike import makings, refuse_unlike
from rover_pin.analysis.job import Chunk
from rover_pin.analysis.rows import Columns


class Bench(WorkerPlugin):
    """A job at a worker. The scheduler hands it to every worker, to those too that join while it is done."""

    def __init__(self, pickled: bytes, here: Mapping[str, str]) -> None:
        """From the pickled job, and the makings of the process that asks for it."""
        self._pickled = pickled
        self._here = here
        self._address = ""
        self._runner: ChunkWorker | None = None

    def setup(self, worker: Worker) -> None:
        """Take up a place at a worker; the job is unpacked with the first chunk."""
        self._address = worker.address
        self._lock = threading.Lock()

    def run(self, chunk: Chunk) -> Columns:
        """The rows of a chunk; one at a time, however many threads the worker has.

        Raises:
            StudyError: this worker would give other numbers.
            SolverError: a case failed in a way that no status describes.
        """
        with self._lock:
            if self._runner is None:
                refuse_unlike(makings(), self._here, self._address)
                self._runner = pickle.loads(self._pickled).runner()
                self._pickled = b""
            return self._runner.run(chunk)


class Deaf(WorkerPlugin):
    """At a worker of this machine: the parent alone answers Ctrl-C, which a terminal sends to all."""

    def setup(self, worker: Worker) -> None:
        """Called in the worker's main thread, where alone signals can be set."""
        if threading.current_thread() is threading.main_thread():
            signal.signal(signal.SIGINT, signal.SIG_IGN)


def work(bench: str, chunk: Chunk) -> Columns:
    """The rows of a chunk, at the worker that this is called in.

    Args:
        bench: the name under which it keeps the job.
        chunk: which cases.
    """
    kept = cast(Bench, get_worker().plugins[bench])
    return kept.run(chunk)
