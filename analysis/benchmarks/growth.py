"""Cost as it grows: with the number of wheels, the size of the map, the number of cases."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from rover_pin.analysis.benchmarks.agreement import compare
from rover_pin.analysis.benchmarks.compiled import make, time_compiled
from rover_pin.analysis.benchmarks.memory import room_for, study_peak
from rover_pin.analysis.benchmarks.plain import answer_plainly
from rover_pin.analysis.benchmarks.row import COMPILED, Row, rates
from rover_pin.analysis.benchmarks.scene import MODERATE, SIZE_M, SPACING_M, Scene, moderate
from rover_pin.analysis.benchmarks.size import Size
from rover_pin.analysis.benchmarks.wheeled import wheeled_rover
from rover_pin.loader import load
from rover_pin.terrain import Terrain

Tell = Callable[[str], None]
Found = tuple[list[Row], list[str]]
"""Rows, and sentences about what is left out."""

BESIDE_PLAIN = 20
"""Cases compared with the plain path in each row."""


def over_wheels(size: Size, tell: Tell) -> Found:
    """Rovers of 4 wheels and more on moderate ground."""
    rows: list[Row] = []
    left_out: list[str] = []
    with tempfile.TemporaryDirectory() as folder:
        for wheels in size.grow_wheels:
            tell(f"{wheels} wheels")
            row, why = _settles(moderate(wheeled_rover(wheels, Path(folder))), size)
            rows += [replace(row, wheels=wheels)] if row is not None else []
            left_out += [f"compiled, {wheels} wheels: {why}"] if why else []
    return rows, left_out


def over_nodes(size: Size, tell: Tell) -> Found:
    """The default robot on maps of the same roughness and spacing, ever wider."""
    rows: list[Row] = []
    left_out: list[str] = []
    rover = load(default_robot()) if size.grow_nodes else None
    for nodes in size.grow_nodes:
        if rover is None:
            break
        tell(f"map of {nodes} x {nodes} nodes")
        side = (nodes - 1) * SPACING_M
        rms, hurst = 0.05, 0.8
        terrain = Terrain.rough(1, rms * (side / SIZE_M) ** hurst, hurst, size=side, spacing=SPACING_M)
        row, why = _settles(Scene(rover, terrain, MODERATE), size)
        rows += [replace(row, nodes=nodes)] if row is not None else []
        left_out += [f"compiled, {nodes} x {nodes} nodes: {why}"] if why else []
    return rows, left_out


def over_cases(size: Size, tell: Tell) -> Found:
    """Studies of the default robot, each in a process of its own, streamed to a temporary file."""
    rows: list[Row] = []
    left_out: list[str] = []
    for cases in size.grow_cases:
        tell(f"study of {cases} cases")
        if not room_for(cases):
            left_out.append(f"study of {cases} cases: the temporary folder has no room for it")
            continue
        peak = study_peak(default_robot(), cases)
        if peak is None:
            left_out.append(f"study of {cases} cases: its process failed")
            continue
        ground = "rough:1,0.05,0.8"
        row = Row("study", default_robot(), MODERATE, ground, COMPILED, **rates(cases, peak.spent))
        rows.append(replace(row, peak_mb=peak.peak_mb, disk_mb=peak.disk_mb))
    return rows, left_out


def default_robot() -> str:
    """That of the default study."""
    from rover_pin.analysis.study import Study

    return str(Study.default().spec.robot)


def _settles(scene: Scene, size: Size) -> tuple[Row | None, str]:
    """Settles by the compiled path, a few beside the plain path's; or why there are none."""
    batch = make(scene)
    if batch.refusal:
        return None, batch.refusal
    places = scene.places(size.cases)
    timed = time_compiled(batch, places, size.times)
    left, count = len(timed.open), len(places)
    plain = answer_plainly(scene, places.first(BESIDE_PLAIN))
    measured: dict[str, Any] = {
        **rates(count - left, timed.spent),
        "cases": count,
        "to_plain_path": left / count,
        **compare(scene, timed.answers[0], plain).told(),
    }
    return Row("settle", scene.rover.name, scene.kind, scene.terrain.label, COMPILED, **measured), ""
