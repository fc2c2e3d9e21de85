"""The benchmark: every bundled robot, two grounds, every method, the same places, answers compared."""

from __future__ import annotations

import platform
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from rover_pin.analysis.benchmarks.growth import over_cases, over_nodes, over_wheels
from rover_pin.analysis.benchmarks.methods import SceneBench
from rover_pin.analysis.benchmarks.mujoco_peer import version as mujoco_version
from rover_pin.analysis.benchmarks.row import Row
from rover_pin.analysis.benchmarks.scene import MODERATE, Scene, moderate, rough
from rover_pin.analysis.benchmarks.size import FULL, QUICK, Size
from rover_pin.analysis.benchmarks.two_processes import together
from rover_pin.analysis.provenance import versions
from rover_pin.loader import load

if TYPE_CHECKING:
    from rover_pin.rover import Rover

Progress = Callable[[str], None]
"""Called with what is measured next."""


@dataclass
class Report:
    """What was measured, what was not and why, and on what.

    Attributes:
        rows: in the order they were measured.
        left_out: sentences.
        machine: what the numbers hang on, by name.
    """

    rows: list[Row] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)
    machine: dict[str, str] = field(default_factory=dict)


def bench(
    robots: Sequence[Rover] | None = None,
    *,
    quick: bool = False,
    size: Size | None = None,
    progress: Progress | None = None,
) -> Report:
    """Measure how many cases a second each method answers on this machine.

    Args:
        robots: what stands; None for every bundled robot.
        quick: fewer cases, nothing that grows.
        size: how much of each; None for what `quick` says.
        progress: called with what is measured next.
    """
    amount = size or (QUICK if quick else FULL)
    tell = progress or _silent
    report = Report(machine=_machine())
    peer = mujoco_version()
    if peer is None:
        report.left_out.append("mujoco: it is not installed (pip install mujoco)")
    for rover in _bundled() if robots is None else robots:
        for scene in (moderate(rover), rough(rover)):
            _scene(report, scene, amount, peer is not None, tell)
    if quick:
        report.left_out.append("growth with cases, wheels and maps, and memory: only without --quick")
        return report
    for part in (over_wheels, over_nodes, over_cases):
        rows, left_out = part(amount, tell)
        report.rows += rows
        report.left_out += left_out
    return report


def _bundled() -> list[Rover]:
    from rover_pin.description.catalogue import robots

    return [load(entry.name) for entry in robots()]


def _scene(report: Report, scene: Scene, amount: Size, peer: bool, tell: Progress) -> None:
    """Everything on one ground."""
    where = f"{scene.rover.name}, {scene.kind}"
    measured = SceneBench(scene, amount)
    if measured.batch.refusal:
        report.left_out.append(f"compiled, {where}: {measured.batch.refusal}")
    else:
        tell(f"{where}: compiled")
        report.rows += measured.compiled_rows()
        tell(f"{where}: slowest case")
        report.rows.append(measured.slowest_row())
        if scene.kind == MODERATE and amount.processes:
            tell(f"{where}: {' and '.join(map(str, amount.processes))} processes")
            report.rows += together(scene, amount.processes, amount.cases, amount.turns)
    tell(f"{where}: plain")
    report.rows += measured.plain_rows()
    if peer:
        tell(f"{where}: mujoco")
        row, why = measured.mujoco_row()
        report.rows += [row] if row is not None else []
        report.left_out += [f"mujoco, {where}: {why}"] if why else []


def _machine() -> dict[str, str]:
    """Processor and versions."""
    return {
        "processor": _processor(),
        "system": platform.system(),
        **versions(),
        "mujoco": mujoco_version() or "",
    }


def _processor() -> str:
    """Its name, as the system tells it."""
    try:
        told = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        names = [line.partition(":")[2].strip() for line in told if line.startswith("model name")]
    except OSError:
        names = []
    return names[0] if names else platform.processor() or platform.machine()


def _silent(what: str) -> None:
    return None
