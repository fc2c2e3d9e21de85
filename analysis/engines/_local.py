"""Worker processes on this machine: how many, with one thread each, and never started by one of their own."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
from collections.abc import Iterator

from rover_pin.errors import StudyError

ONE_THREAD = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
"""Matrices are small: threads below a worker only get in its way."""

GUARD = "put what runs the study under `if __name__ == '__main__':`"


def cores() -> int:
    """The cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def refuse_in_worker(engine: str) -> None:
    """Refuse to start workers in a worker: a script that guards no main part is run again by each.

    Raises:
        StudyError: this process was started by another one's multiprocessing.
    """
    if multiprocessing.parent_process() is not None:
        raise StudyError("a worker process started the study again", element=f"engine {engine}", cure=GUARD)


@contextlib.contextmanager
def one_thread() -> Iterator[None]:
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
