"""A connection to a Dask cluster: one that is there, or one made of processes of this machine."""

from __future__ import annotations

import contextlib
import logging
from collections.abc import Iterator

from distributed import Client, LocalCluster
from distributed import TimeoutError as DaskTimeoutError

from rover_pin.analysis.engines import Resources
from rover_pin.analysis.engines._alike import makings, refuse_answers
from rover_pin.analysis.engines._dask_worker import Deaf
from rover_pin.analysis.engines._local import GUARD, cores, one_thread, refuse_in_worker
from rover_pin.errors import StudyError

CONNECT_SECONDS = 10.0
WORKERS_SECONDS = 60.0
"""How long the first workers may take: on a cluster they start one after the other."""


@contextlib.contextmanager
def connected(address: str, workers: int | None) -> Iterator[Client]:
    """A client of the scheduler at `address`, once `workers` (None: one) are there that can do the work.

    Raises:
        StudyError: nothing answers there, too few workers come, or one of them would give other numbers.
    """
    try:
        client = Client(address, timeout=CONNECT_SECONDS, set_as_default=False)
    except (OSError, DaskTimeoutError, ValueError, TypeError) as error:
        raise StudyError(
            f"no Dask scheduler answers: {_first_line(error)}",
            element="scheduler",
            value=address,
            cure="start one with `dask scheduler` and give the address that it prints, tcp://HOST:8786",
        ) from None
    with client:
        _await_workers(client, address, workers or 1)
        refuse_answers(client.run(makings, on_error="return"))
        yield client


@contextlib.contextmanager
def own_cluster(workers: int) -> Iterator[Client]:
    """A client of a cluster of processes with one thread each on this machine, gone when it is done.

    Raises:
        StudyError: called from a script that guards no main part, or the processes cannot be started.
    """
    refuse_in_worker("dask")
    with one_thread(), contextlib.ExitStack() as stack:
        try:
            cluster = LocalCluster(
                n_workers=workers,
                threads_per_worker=1,
                processes=True,
                dashboard_address="127.0.0.1:0",
                scheduler_kwargs={"dashboard": False},
                memory_limit=None,
                silence_logs=logging.CRITICAL,
            )
        except (OSError, RuntimeError) as error:
            what = f"worker processes do not start: {_first_line(error)}"
            raise StudyError(what, element="engine dask", cure=f"in a script, {GUARD}") from None
        stack.enter_context(cluster)
        client = stack.enter_context(Client(cluster, set_as_default=False, direct_to_workers=True))
        client.register_plugin(Deaf())
        yield client


def cluster(resources: Resources, chunks: int) -> contextlib.AbstractContextManager[Client]:
    """The cluster that the resources name, else one of this machine, with no more workers than chunks."""
    if resources.scheduler is not None:
        return connected(resources.scheduler, resources.workers)
    return own_cluster(min(resources.workers or cores(), chunks))


def _await_workers(client: Client, address: str, wanted: int) -> None:
    """Wait until that many workers are there.

    Raises:
        StudyError: they do not come.
    """
    try:
        client.wait_for_workers(wanted, timeout=WORKERS_SECONDS)
    except DaskTimeoutError:
        there = len(client.nthreads())
        raise StudyError(
            f"has {there} of {wanted} workers after {WORKERS_SECONDS:.0f} s",
            element=f"scheduler {address}",
            cure=f"start workers with `dask worker {address} --nthreads 1`, or ask for fewer",
        ) from None


def _first_line(error: Exception) -> str:
    return (str(error) or type(error).__name__).splitlines()[0]
