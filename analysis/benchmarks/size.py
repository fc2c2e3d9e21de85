"""How much of everything is measured."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Size:
    """Numbers of cases.

    Attributes:
        cases: by the compiled path, in one turn.
        turns: how often two processes go over them.
        times: turns of which the quickest counts.
        plain: by the plain path.
        alone: cases asked of the compiled path one by one, for the slowest.
        open_alone: cases that it left open, asked of the plain path one by one.
        resting: poses in which a simulator has to come to rest.
        processes: numbers of processes to compare.
        grow_cases: cases of a study.
        grow_wheels: wheels of a rover.
        grow_nodes: nodes along the side of a map.
    """

    cases: int
    turns: int
    times: int
    plain: int
    alone: int
    open_alone: int
    resting: int
    processes: tuple[int, ...] = (1, 2)
    grow_cases: tuple[int, ...] = ()
    grow_wheels: tuple[int, ...] = ()
    grow_nodes: tuple[int, ...] = ()


QUICK = Size(cases=10_000, turns=10, times=2, plain=30, alone=500, open_alone=20, resting=3)
FULL = Size(
    cases=100_000,
    turns=10,
    times=3,
    plain=300,
    alone=2000,
    open_alone=500,
    resting=20,
    grow_cases=(100, 1000, 10_000, 100_000, 1_000_000, 10_000_000),
    grow_wheels=(4, 6, 8, 12),
    grow_nodes=(64, 128, 256, 512, 1024, 2048, 4096),
)
