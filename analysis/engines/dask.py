"""Chunks on the workers of a Dask cluster: a scheduler's, or processes of this machine."""

from __future__ import annotations

import contextlib
import importlib.util
import pickle
import time
import uuid
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from rover_pin.analysis.engines import Resources, Work
from rover_pin.analysis.engines._alike import makings
from rover_pin.analysis.engines._feeding import feed
from rover_pin.analysis.engines._local import cores
from rover_pin.analysis.job import Chunk, Done
from rover_pin.analysis.rows import Columns
from rover_pin.errors import RoverPinError, SolverError, StudyError

if TYPE_CHECKING:
    from distributed import Client, Future

AHEAD = 3
"""Chunks handed out for each worker: one in work, one at hand, one on its way."""
COUNT_SECONDS = 1.0
"""How often workers are counted, for those that came or went."""
KEPT = "what is finished is kept for --resume"


class Dask:
    """The workers of a scheduler; without one, one process a core unless told otherwise."""

    takes_scheduler = True

    def workers(self, resources: Resources) -> int:
        """Those of the scheduler, else as many as asked for, else the cores this process may use.

        Raises:
            StudyError: Dask is not installed, the scheduler does not answer, or its workers cannot be used.
        """
        _need_distributed()
        if resources.scheduler is None:
            return resources.workers or cores()
        from rover_pin.analysis.engines._dask_cluster import connected

        with connected(resources.scheduler, resources.workers) as client:
            return max(1, len(client.nthreads()))

    def run(self, job: Work, chunks: Sequence[Chunk], resources: Resources, done: Done) -> None:
        """Carry out the chunks; those of a worker that dies are done by another.

        Raises:
            StudyError: the cluster cannot be had, or a worker would give other numbers.
            SolverError: a case failed, a chunk killed its workers, or the scheduler was lost.
        """
        _need_distributed()
        if not chunks:
            return
        from rover_pin.analysis.engines._dask_cluster import cluster

        with cluster(resources, len(chunks)) as client, _Crew(client, job) as crew:
            feed(chunks, crew.begin, crew.ahead, done)


class _Crew:
    """The workers of a cluster, each with the job at hand for as long as this is entered."""

    def __init__(self, client: Client, job: Work) -> None:
        from rover_pin.analysis.engines._dask_worker import Bench, work

        self._client = client
        self._work = work
        self._bench = Bench(pickle.dumps(job, protocol=5), makings())
        self._name = f"rover_pin-{uuid.uuid4().hex[:12]}"
        self._counted = (-COUNT_SECONDS, 1)

    def __enter__(self) -> _Crew:
        """Send the job to every worker."""
        self._client.register_plugin(self._bench, name=self._name)
        return self

    def __exit__(self, *_: object) -> None:
        """Have the workers forget it, where there is still someone to tell."""
        with contextlib.suppress(Exception):
            self._client.unregister_worker_plugin(self._name)

    def begin(self, chunk: Chunk) -> _Promise:
        """Hand out a chunk."""
        key = (self._name, *chunk)
        return _Promise(self._client.submit(self._work, self._name, chunk, key=key, pure=False), chunk)

    def ahead(self) -> int:
        """How many chunks may be handed out, by the workers there are now."""
        now = time.monotonic()
        if now - self._counted[0] >= COUNT_SECONDS:
            self._counted = (now, max(1, len(self._client.nthreads())))
        return AHEAD * self._counted[1]


class _Promise:
    """A chunk in Dask's hands; its failures in our words."""

    def __init__(self, future: Future[Columns], chunk: Chunk) -> None:
        self._future = future
        self._cases = f"cases {chunk[0]} to {chunk[1] - 1}"

    def add_done_callback(self, fn: Callable[[object], object], /) -> None:
        """Call `fn` once it has ended, in whatever way."""
        self._future.add_done_callback(fn)

    def cancel(self) -> None:
        """Do not begin it, or let its rows go."""
        self._future.cancel()

    def result(self, timeout: float | None = None) -> Columns:
        """The rows.

        Raises:
            RoverPinError: what the work raised.
            SolverError: it killed its workers, or the scheduler was lost.
        """
        from concurrent.futures import CancelledError

        from distributed.scheduler import KilledWorker

        try:
            return self._future.result(timeout)
        except RoverPinError:
            raise
        except KilledWorker as error:
            what = f"workers died of them, the last at {error.last_worker.address}"
            raise SolverError(
                what, element=self._cases, cure=f"look at the memory it takes; {KEPT}"
            ) from None
        except (CancelledError, OSError):
            raise SolverError("the scheduler was lost", element="engine dask", cure=KEPT) from None
        except Exception as error:
            what = f"failed: {type(error).__name__}: {error}"
            raise SolverError(what, element=self._cases, cure=KEPT) from error


def _need_distributed() -> None:
    """Refuse where Dask is not installed.

    Raises:
        StudyError: it is not.
    """
    if importlib.util.find_spec("distributed") is None:
        what, cure = "needs the package distributed", "pip install 'rover-pin[dask]'"
        raise StudyError(what, element="engine dask", cure=cure)


ENGINE = Dask()
