"""The same steady work by one process and by two at once, each started afresh (spawn)."""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing.synchronize import Barrier
from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.analysis.benchmarks.clock import Spent, spent
from rover_pin.analysis.benchmarks.compiled import ask, make
from rover_pin.analysis.benchmarks.row import COMPILED, Row, rates
from rover_pin.analysis.benchmarks.scene import Scene
from rover_pin.compiled import OPEN

if TYPE_CHECKING:
    from multiprocessing.queues import Queue

PATIENCE_S = 600.0
Told = tuple[int, float, float, float, int]
"""How many worked at once, begin and end on the wall (a clock that processes share), processor's seconds,
cases left open."""


def together(scene: Scene, counts: tuple[int, ...], cases: int, turns: int) -> list[Row]:
    """Steady work by so many processes at once, a row for each of `counts`.

    Every process that works answers the same number of cases, `turns` calls of `cases`. Start-up, compilation
    and the first call are before the clock starts, which all wait for.
    """
    context = multiprocessing.get_context("spawn")
    most = max(counts, default=0)
    if most == 0:
        return []
    barrier, results = context.Barrier(most), context.Queue()
    workers = [
        context.Process(target=_work, args=(scene, counts, rank, cases, turns, barrier, results), daemon=True)
        for rank in range(most)
    ]
    with _started(workers):
        told: list[Told] = [results.get(timeout=PATIENCE_S) for _ in range(sum(counts))]
    return [
        _row(scene, count, cases * turns, [each for each in told if each[0] == count]) for count in counts
    ]


def _row(scene: Scene, processes: int, each: int, told: list[Told]) -> Row:
    _, begin, end, cpu, left = np.array(told).T
    count = processes * each
    time_spent = Spent(float(end.max() - begin.min()), float(cpu.sum()))
    return Row(
        "settle", scene.rover.name, scene.kind, scene.terrain.label, COMPILED,
        processes=processes, to_plain_path=float(left.sum() / count), **rates(count, time_spent),
    )  # fmt: skip


@contextmanager
def _started(workers: list[Any]) -> Iterator[None]:
    for worker in workers:
        worker.start()
    try:
        yield
    finally:
        for worker in workers:
            worker.join(timeout=10.0)
            if worker.is_alive():
                worker.terminate()


def _work(
    scene: Scene,
    counts: tuple[int, ...],
    rank: int,
    cases: int,
    turns: int,
    barrier: Barrier,
    results: Queue[Told],
) -> None:
    """In a process of its own: works where its rank is below the count, else waits for the others."""
    batch, places = make(scene), scene.places(cases)
    ask(batch, places)
    for count in counts:
        barrier.wait(timeout=PATIENCE_S)
        if rank >= count:
            continue
        begin = time.perf_counter()
        left = 0
        with spent() as timer:
            for _ in range(turns):
                left += int(np.sum(ask(batch, places).code == OPEN))
        results.put((count, begin, time.perf_counter(), timer.spent.cpu, left))
