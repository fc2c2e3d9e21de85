"""Ways, times and how well the tasks run: kinematic and quasi-static."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.analysis.papers.finding import NOT_REPRODUCED, Finding, claimed, compared

if TYPE_CHECKING:
    from rover_pin.simulation.run import Run

WHERE = "tasks, as simulated"
SPIN = ("turn the wheels", "turn the wheels back")


def mileage(run: Run) -> float:
    """Way of the root link over the ground [m]."""
    steps = np.diff(run.configuration[:, :2], axis=0)
    return float(np.sum(np.linalg.norm(steps, axis=1)))


def findings(runs: Mapping[str, Run]) -> list[Finding]:
    """Rows on motion."""
    rows = [_ran(key, run) for key, run in runs.items() if key != "7"]
    standing = {key: run for key, run in runs.items() if key in ("3", "4", "5", "10")}
    drift = max(float(np.max(run.drift)) for run in standing.values() if run.drift is not None)
    rows += [
        claimed("sliding of wheels while the chassis is raised, lowered, creeps", "mm", "close to zero",
                1e3 * drift, drift < 1e-4, where=WHERE,
                why="largest of any wheel over whole runs, from places"),
        *_task_14(runs),
        *_task_15(runs),
    ]  # fmt: skip
    return rows


def _ran(key: str, run: Run) -> Finding:
    apart = float(np.nanmax(run.apart)) if run.apart is not None else np.nan
    residual = float(np.nanmax(run.residual)) if run.residual is not None else np.nan
    ok = run.status == "done" and apart < 1e-5 and residual < 1e-6
    words = (
        f"{len(run.time)} stances agree with the statics within {apart:.1g} (m, rad),"
        f" residuals within {residual:.1g}; {run.time[-1]:.0f} s"
    )
    words += "" if ok else f"; {run.reason}"
    return claimed(f"Task {key}", "", "done", run.status, ok, where=WHERE, why=words)


def _task_14(runs: Mapping[str, Run]) -> list[Finding]:
    printed = {
        "WRM": (4634.0, 401.0),
        "WCM": (3166.0, 358.0),
        "RCLM": (2800.0, 249.0),
        "SWLM": (2800.0, 859.0),
    }
    why = {
        "WRM": "its path is not printed; ours keeps wheels off the obstacle, by arcs of 1.3 m",
        "WCM": "its path is not printed; ours goes square around it and keeps wheels off it",
        "RCLM": "2600 mm with the wheelbase of 1550 mm that the arms allow; 2800 mm needs one of 1750 mm",
        "SWLM": "rolled back and forth between lifts; the paper's sequence is not printed",
    }
    rows = []
    for mode, (way, time) in printed.items():
        run = runs[f"14 {mode}"]
        rows.append(compared(f"Task 14, {mode}: way", "mm", way, 1e3 * mileage(run), within=20.0,
                             where="Table 6", why=why[mode]))  # fmt: skip
        rows.append(compared(f"Task 14, {mode}: time", "s", time, float(run.time[-1]), within=5.0,
                             where="Table 6", why="no soil here"))  # fmt: skip
    quickest = sorted(printed, key=lambda mode: float(runs[f"14 {mode}"].time[-1]))
    rows.append(
        claimed("Task 14: modes from the quickest", "", "RCLM, WCM, WRM, SWLM", ", ".join(quickest),
                quickest == ["RCLM", "WCM", "WRM", "SWLM"], where="Table 6", why="by simulated time")
    )  # fmt: skip
    rows.append(Finding("Task 14: energy", "kJ", "97, 77, 49, 36", None, NOT_REPRODUCED,
                        "rolling losses in soil, not this model", "Table 6"))  # fmt: skip
    return rows


def _task_15(runs: Mapping[str, Run]) -> list[Finding]:
    rows = []
    for rate in ("0.02", "0.03"):
        run = runs[f"15 {rate}"]
        driving = [i for i, action in enumerate(run.actions) if action not in SPIN]
        angles = np.abs(run.configuration[driving, run.rover.column["LF_st"]])
        steady = bool(np.all(np.diff(angles) > -1e-9))
        rows.append(
            claimed(f"Task 15 at {rate} rad/s: steering angle as the wheelbase grows", "deg",
                    "stable increase", f"{np.degrees(angles[0]):.1f} to {np.degrees(angles[-1]):.1f}", steady,
                    where="Fig. 25", why="left front, about a centre 1.5 m to the left (ours)")
        )  # fmt: skip
    rows.append(
        Finding("Task 15: largest change of yaw rate, motion constraint 8", "", 0.4, None, NOT_REPRODUCED,
                "fluctuations of the real drives on soil", "Fig. 25")
    )  # fmt: skip
    return rows
