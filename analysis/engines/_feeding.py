"""Chunks handed out a few at a time and taken in as they come: memory does not grow with their number."""

from __future__ import annotations

import contextlib
import functools
import time
from collections.abc import Callable, Iterable
from queue import SimpleQueue
from typing import Any, Protocol

from rover_pin.analysis.job import Chunk, Done
from rover_pin.analysis.rows import Columns

LAST_SECONDS = 2.0
"""How long, on the way out, what is finished is waited for: it may lie at a worker that went too."""


class Promise(Protocol):
    """What an executor gives for work handed to it; a Future of the standard library or of Dask."""

    def add_done_callback(self, fn: Callable[[Any], object], /) -> object:
        """Call `fn` once it has ended, in whatever way."""
        ...

    def result(self, timeout: float | None = None) -> Columns:
        """The chunk's rows, or what the work raised; TimeoutError where they are not here in time [s]."""
        ...

    def cancel(self) -> object:
        """Do not begin it."""
        ...


def feed(
    chunks: Iterable[Chunk], begin: Callable[[Chunk], Promise], ahead: Callable[[], int], done: Done
) -> None:
    """Carry out chunks with at most `ahead()` of them handed out, asked anew each time: workers come and go.

    On the way out by an error or an interrupt those not begun are cancelled, and those already finished are
    handed to `done` all the same.
    """
    waiting = iter(chunks)
    running: dict[Chunk, Promise] = {}
    finished: SimpleQueue[Chunk] = SimpleQueue()

    def hand_out() -> None:
        while len(running) < ahead() and (chunk := next(waiting, None)) is not None:
            running[chunk] = promise = begin(chunk)
            promise.add_done_callback(functools.partial(_put, finished, chunk))

    try:
        hand_out()
        while running:
            chunk = finished.get()
            done(chunk, running.pop(chunk).result())
            hand_out()
    finally:
        end = time.monotonic() + LAST_SECONDS
        while not finished.empty():
            chunk = finished.get()
            with contextlib.suppress(Exception):
                done(chunk, running.pop(chunk).result(max(0.0, end - time.monotonic())))
        for promise in running.values():
            promise.cancel()


def _put(finished: SimpleQueue[Chunk], chunk: Chunk, _: object) -> None:
    finished.put(chunk)
