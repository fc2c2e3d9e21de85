"""What the paper measured of soil: not this model's, row by row with the reason."""

from __future__ import annotations

from rover_pin.analysis.papers.finding import NOT_REPRODUCED, Finding

WHERE = "soil: slip, traction, power, energy, sinkage"
REASON = "soil physics: a rigid, frictional ground has no such figure"

STATED: tuple[tuple[str, str, float | str], ...] = (
    ("slip ratio, Task 1, very loose and loose soil", "", "0.3 to 0.65, 0.0 to 0.4"),
    ("slip ratio, Task 2", "", "around 0.4"),
    ("slip ratio, Task 4, creeping", "", "0.95 to 0.45"),
    ("slip ratio, Task 5, creeping up", "", 0.93),
    ("slip ratio, Task 8 at constant speeds", "", "0.18 to 0.32"),
    ("slip ratio, Task 9, rolling and crabbing, mean", "", "0.41, 0.31"),
    ("slip ratio, Task 11, creeping", "", 0.44),
    ("slip ratio, Task 12, right front lifted", "", "0.01 to 0.24"),
    ("traction efficiency, Task 8, middle wheels", "", "0.61 to 1.02"),
    ("traction efficiency, Task 10, middle wheels", "", "0.13 to 0.31"),
    ("traction coefficient, Task 12 at 150 mm, right rear", "", 27.5),
    ("power, Task 8, 5 to 25 mm/s", "kW", "0.051 to 0.064"),
    ("power, Task 11, rolling at last", "kW", 0.099),
    ("energy, Task 8", "kJ", "11.3, 12.2, 14, 13, 11"),
    ("energy, Task 10, raised by 200 and 400 mm", "kJ", "13.5, 27.5"),
    ("energy, Task 12, right front at 100, 150, 200 mm", "kJ", "39.6, 43.9, 41.5"),
    ("energy, Task 13, front, middle, rear", "kJ", "41.6, 23.6, 20.1"),
    ("turning in place: yaw rate over the commanded", "", "about one fifth"),
)


def findings() -> list[Finding]:
    """One row a statement."""
    return [Finding(what, unit, paper, None, NOT_REPRODUCED, REASON, WHERE) for what, unit, paper in STATED]
