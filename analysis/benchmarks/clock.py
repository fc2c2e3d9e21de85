"""Time by two clocks: on the wall, and of this thread on its processor."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TypeVar

T = TypeVar("T")


@dataclass(frozen=True)
class Spent:
    """Seconds on the wall and of this thread's processor."""

    wall: float
    cpu: float

    def __add__(self, other: Spent) -> Spent:
        """Both."""
        return Spent(self.wall + other.wall, self.cpu + other.cpu)


NOTHING = Spent(0.0, 0.0)


class Timer:
    """Holds the time after its block."""

    spent: Spent = NOTHING


@contextmanager
def spent() -> Iterator[Timer]:
    """Times a block."""
    timer = Timer()
    wall, cpu = time.perf_counter(), time.thread_time()
    yield timer
    timer.spent = Spent(time.perf_counter() - wall, time.thread_time() - cpu)


def least(work: Callable[[], T], times: int) -> tuple[T, Spent]:
    """The last result, and the least time by each clock: what another process takes away is not ours."""
    found: list[Spent] = []
    for _ in range(times):
        with spent() as timer:
            result = work()
        found.append(timer.spent)
    return result, Spent(min(t.wall for t in found), min(t.cpu for t in found))
