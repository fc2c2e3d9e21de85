"""A study of many cases in a process of its own: how long, and how much memory and disk at the most."""

from __future__ import annotations

import multiprocessing
import shutil
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from rover_pin.analysis.benchmarks.clock import Spent, spent

if TYPE_CHECKING:
    from multiprocessing.connection import Connection

BYTES_A_CASE = 600
"""On disk, parts and result together, generously."""


@dataclass(frozen=True)
class Peak:
    """What a study took: seconds, memory and disk at the most."""

    spent: Spent
    peak_mb: float
    disk_mb: float


def room_for(cases: int) -> bool:
    """Whether the temporary folder can take the study's files."""
    return shutil.disk_usage(tempfile.gettempdir()).free > cases * BYTES_A_CASE


def study_peak(robot: str, cases: int) -> Peak | None:
    """A study of one measure, streamed to a file in a temporary folder; None where its process fails."""
    context = multiprocessing.get_context("spawn")
    mine, theirs = context.Pipe(duplex=False)
    with tempfile.TemporaryDirectory() as folder:
        child = context.Process(target=_study, args=(robot, cases, folder, theirs), daemon=True)
        child.start()
        theirs.close()
        try:
            found: Peak = mine.recv()
        except EOFError:
            return None
        finally:
            child.join()
    return found


def _study(robot: str, cases: int, folder: str, told: Connection) -> None:
    """In a process of its own."""
    from rover_pin.analysis.study import Study

    ground = {"rough": {"seed": 1, "rms": 0.05, "hurst": 0.8, "size": 20, "spacing": 0.05}}
    everywhere = {"x": "map", "y": "map", "yaw_deg": [0, 360]}
    out = Path(folder) / "study.nc"
    study = Study(robot, ground, cases={"n": cases}, vary=everywhere, measures=["tip"])
    with spent() as timer:
        study.run(engine="serial", out=out)
    told.send(Peak(timer.spent, _own_peak_mb(), out.stat().st_size / 1e6))


def _own_peak_mb() -> float:
    """The most memory that this process held; getrusage would count what its parent held at the fork, too."""
    import resource

    status = Path("/proc/self/status")
    if status.is_file():
        line = next(text for text in status.read_text().splitlines() if text.startswith("VmHWM"))
        return int(line.split()[1]) * 1024 / 1e6
    largest = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return largest / (1e6 if sys.platform == "darwin" else 1e6 / 1024)
