"""One line of the benchmark."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from rover_pin.analysis.benchmarks.clock import Spent

COMPILED, PLAIN, MUJOCO = "compiled", "plain", "mujoco"


@dataclass(frozen=True)
class Row:
    """What was done by which method, how often a second, and how near the plain path its answers are.

    Attributes:
        work: `settle` (pose, loads, residuals), `row` (settle and every cheap measure), `slowest case`.
        robot: its name.
        terrain: `moderate` or `rough`.
        ground: the terrain as one writes it.
        method: `compiled`, `plain`, `mujoco`.
        processes: at once.
        cases: answered in the time.
        per_second: cases a second on the wall.
        per_cpu_second: cases a second of the thread's processor; of all threads' where there are several.
        to_plain_path: share of the cases that the compiled path leaves to the plain one.
        per_second_with_plain: as `per_second`, the plain path's time for that share included.
        agreement: unit -> largest difference from the plain path.
        compared: cases in which both stand, which `agreement` is over.
        other_status: cases compared in which only one of the two stands, or both fail differently.
        unsettled: cases that did not come to rest; they are not timed.
        slowest_ms: of a single case, of the processor.
        peak_mb: largest memory of the process.
        disk_mb: size of the result on disk.
        wheels: of the robot, where that varies.
        nodes: along a side of the map, where that varies.
    """

    work: str
    robot: str
    terrain: str
    ground: str
    method: str
    cases: int
    processes: int = 1
    per_second: float | None = None
    per_cpu_second: float | None = None
    to_plain_path: float | None = None
    agreement: Mapping[str, float] | None = None
    per_second_with_plain: float | None = None
    compared: int | None = None
    other_status: int | None = None
    unsettled: int | None = None
    slowest_ms: float | None = None
    peak_mb: float | None = None
    disk_mb: float | None = None
    wheels: int | None = None
    nodes: int | None = None

    def as_object(self) -> dict[str, Any]:
        """For JSON: the keys that every row has, and of the others those that were measured."""
        always = (
            "work", "robot", "terrain", "ground", "method", "processes", "per_second", "per_cpu_second",
            "cases", "to_plain_path", "agreement",
        )  # fmt: skip
        values = asdict(self)
        return {name: values[name] for name in always} | {
            name: value for name, value in values.items() if name not in always and value is not None
        }


def rates(cases: int, time: Spent) -> dict[str, Any]:
    """`cases`, `per_second` and `per_cpu_second`."""
    return {
        "cases": cases,
        "per_second": cases / time.wall if time.wall > 0 else None,
        "per_cpu_second": cases / time.cpu if time.cpu > 0 else None,
    }
