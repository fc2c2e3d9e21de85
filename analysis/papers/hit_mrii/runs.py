"""The tasks run: kinematic and quasi-static, with the thresholds of the robot's `control.yaml`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from multiprocessing import get_context
from os import cpu_count
from typing import TYPE_CHECKING

from rover_pin.analysis.papers.hit_mrii import tasks
from rover_pin.analysis.papers.hit_mrii.tasks import Task
from rover_pin.control.plan import load_plan
from rover_pin.simulation.quasi_static import Setting, simulate
from rover_pin.statics.settle import settle
from rover_pin.terrain import Terrain

if TYPE_CHECKING:
    from rover_pin.rover import Rover
    from rover_pin.simulation.run import Run

CYCLE = 0.05
"""s; the paper's is 0.01. Tests hold what the longer one changes."""

SAMPLE = 1.0
"""s between samples."""


def all_tasks() -> tuple[Task, ...]:
    """Every task that is run, in the paper's order."""
    single = (tasks.task_1(), tasks.task_2(), tasks.task_3(), tasks.task_4(), tasks.task_5(), tasks.task_6())
    return (
        *single, tasks.task_7(), tasks.task_10(), *tasks.lifts(), *tasks.task_14(), *tasks.task_15(),
    )  # fmt: skip


def run_task(rover: Rover, task: Task, *, cycle: float = CYCLE, sample: float = SAMPLE) -> Run:
    """One task.

    Args:
        rover: the robot.
        task: what it does.
        cycle: s.
        sample: s between samples of the log.
    """
    plan = load_plan(rover)
    terrain = task.terrain()
    start = settle(rover, terrain, x=task.x, posture={"clearance": task.clearance})
    modes = task.modes(plan.layout, plan.speeds)
    setting = Setting(plan.layout, plan.thresholds, dt=cycle, every=sample)
    return simulate(rover, terrain, start, modes, setting)[0]


def run_all(rover: Rover, keys: Sequence[str] = ()) -> Mapping[str, Run]:
    """Tasks by key, on as many processes as there are cores.

    Args:
        rover: the robot.
        keys: which; all where silent.
    """
    wanted = [task.key for task in all_tasks() if not keys or task.key in keys]
    workers = min(len(wanted), cpu_count() or 1)
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        times = CYCLE, SAMPLE
        found = pool.map(_run_by_key, [rover] * len(wanted), wanted, [times] * len(wanted))
        flat = Terrain.flat()  # one rover and one level ground, whichever process they came from
        return {
            key: replace(run, rover=rover, terrain=flat if run.terrain.label == flat.label else run.terrain)
            for key, run in zip(wanted, found, strict=True)
        }


def _run_by_key(rover: Rover, key: str, times: tuple[float, float]) -> Run:
    """In a worker: a task is found by its key, as its scripts do not travel."""
    task = next(task for task in all_tasks() if task.key == key)
    return run_task(rover, task, cycle=times[0], sample=times[1])
