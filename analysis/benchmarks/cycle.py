"""How long a control cycle takes: model, rows, program, checks, motion constraints, supervisor.

`python -m rover_pin.analysis.benchmarks.cycle [ROBOT] [CYCLES]` prints it for a robot with a `control.yaml`.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.control.controller import Controller
from rover_pin.control.modes import Mode, chassis_lifting, crabbing, creeping, rolling
from rover_pin.control.motion_constraints import motion_constraints
from rover_pin.control.plan import Plan, load_plan
from rover_pin.control.supervisor import AT_REST, Supervisor
from rover_pin.kinematics.advance import advance
from rover_pin.numerics import Array
from rover_pin.statics.settle import settle
from rover_pin.terrain import Terrain

if TYPE_CHECKING:
    from rover_pin.rover import Rover

WARM = 100
"""Cycles before the clock counts."""


@dataclass(frozen=True)
class Cycles:
    """What was measured.

    Attributes:
        seconds: (n,) of each cycle, wall.
        solved: cycles whose program was solved.
        named: cycles that were infeasible, with the rows that fight.
        lost: cycles that were neither.
        resting: cycles without a program, between actions.
    """

    seconds: Array
    solved: int
    named: int
    lost: int
    resting: int

    def __str__(self) -> str:
        """Two lines."""
        ms = 1e3 * self.seconds
        return (
            f"{len(ms)} cycles: median {np.median(ms):.3f} ms, 99 % within {np.quantile(ms, 0.99):.3f} ms,"
            f" slowest {np.max(ms):.2f} ms\n"
            f"solved {self.solved}, infeasible and named {self.named}, neither {self.lost},"
            f" without a program {self.resting}"
        )


def time_cycles(rover: Rover, cycles: int = 10000, plan: Plan | None = None) -> Cycles:
    """Run modes on level ground, loads measured, every motion constraint of the mode watched.

    Args:
        rover: a rover with sides.
        cycles: how many are timed.
        plan: its sides, speeds and thresholds; the file beside it where silent.

    Raises:
        InputError: no `control.yaml`.
    """
    given = load_plan(rover) if plan is None else plan
    terrain = Terrain.flat()
    supervisor = Supervisor(time.monotonic, lambda _: False, 1.0)
    constraints = motion_constraints(rover, given.layout)
    controller = Controller(rover, terrain, given.layout, constraints, given.thresholds, supervisor)
    stance = settle(rover, terrain, posture={"clearance": 0.3})
    at, loads = controller.inverse.at(stance), dict(stance.loads)
    ahead, seconds = _modes(given), np.empty(cycles)
    solved = named = lost = resting = 0
    for i in range(-WARM, cycles):
        if supervisor.order.state in AT_REST:
            controller.begin(next(ahead), at.q)
        q = np.array(at.q)
        begun = time.perf_counter()
        cycle = controller.cycle(q, loads=loads)
        taken = time.perf_counter() - begun
        if i >= 0:
            seconds[i] = taken
            found = cycle.solution
            solved += found is not None and found.solved
            named += found is not None and not found.solved and bool(found.fighting)
            lost += found is not None and not found.solved and not found.fighting
            resting += found is None
        at = advance(at, cycle.velocity, controller.dt)
    return Cycles(seconds, solved, named, lost, resting)


def _modes(plan: Plan) -> Iterator[Mode]:
    """Raise, roll, lower, crab, creep, again and again."""
    layout, speeds = plan.layout, plan.speeds
    while True:
        yield chassis_lifting(layout, speeds, 0.33)
        yield rolling(layout, speeds, 0.2, 0.3)
        yield chassis_lifting(layout, speeds, 0.28)
        yield crabbing(layout, speeds, 0.1)
        yield creeping(layout, speeds, 0.28, 0.3, 1)


def main(words: list[str]) -> None:
    """Print the figures."""
    from rover_pin.loader import load

    robot = words[0] if words else "hit_mrii"
    count = int(words[1]) if len(words) > 1 else 10000
    sys.stdout.write(f"{robot}: {time_cycles(load(robot), count)}\n")


if __name__ == "__main__":
    main(sys.argv[1:])
