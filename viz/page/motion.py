"""What the page of motions carries: robots, grounds, and per run its frames, its spans and its curves."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
import pinocchio as pin

from rover_pin.numerics import Array
from rover_pin.simulation.series import spans
from rover_pin.viz.page.curves import PANELS, packed_curves
from rover_pin.viz.page.pack import Pack
from rover_pin.viz.page.path_ground import path_ground
from rover_pin.viz.page.robots import robot
from rover_pin.viz.page.thin import Indices, evenly, held
from rover_pin.viz.scene import span_of

if TYPE_CHECKING:
    from rover_pin.rover import Rover
    from rover_pin.simulation.run import Run

FRAMES = 2000
"""Samples of a run that the picture has."""

S = TypeVar("S")
K = TypeVar("K", bound=Hashable)


def motion_pack(runs: Mapping[str, Run], title: str) -> Pack:
    """Everything the page `motion` shows; runs of like rovers and on the same terrain share what they can.

    Args:
        runs: checked, by the name under which they are chosen.
        title: of the page.
    """
    logs = list(runs.values())
    robots, robot_of = _shared(logs, lambda run: repr(run.rover.recipe))
    grounds, ground_of = _shared(logs, lambda run: (id(run.terrain), robot_of[id(run)]))
    segments: dict[str, bytes] = {}
    abouts = []
    for k, run in enumerate(robots):
        about, segments[f"robot/{k}"] = robot(run.rover, k)
        abouts.append({**about, "sides": wheel_sides(run.rover)})
    fields = []
    for k, first in enumerate(grounds):
        paths = [np.asarray(run.configuration) for run in logs if ground_of[id(run)] == k]
        path = np.concatenate(paths)
        about, lattice = path_ground(first.terrain, path[:, 0], path[:, 1], span_of(first.rover))
        fields.append(about)
        segments.update({f"ground/{k}/{name}": data for name, data in lattice.items()})
    told = []
    for k, (name, run) in enumerate(runs.items()):
        about, parts = _run(run)
        places = {"name": name, "robot": robot_of[id(run)], "ground": ground_of[id(run)]}
        told.append({**places, **about})
        segments.update({f"run/{k}/{part}": data for part, data in parts.items()})
    panels = [
        {"key": key, "title": heading, "unit": unit, "limit": limit}
        for key, (heading, unit, limit) in PANELS.items()
    ]
    header = {"title": title, "robots": abouts, "grounds": fields, "runs": told, "panels": panels}
    return Pack(header, segments)


def _shared(runs: list[Run], key: Callable[[Run], K]) -> tuple[list[Run], dict[int, int]]:
    """The first run of each key, and by id of each run the place of the first one with its key."""
    places: dict[K, int] = {}
    firsts: list[Run] = []
    for run in runs:
        if places.setdefault(key(run), len(firsts)) == len(firsts):
            firsts.append(run)
    return firsts, {id(run): places[key(run)] for run in runs}


def _run(run: Run) -> tuple[dict[str, Any], dict[str, bytes]]:
    """A run's own part.

    Returns:
        What the page needs to know, and by name its bytes: `time` float64 (frames,) s since the first, `q`
        float32 (nv, frames), `loads` float32 (wheels, frames) N, `curves` (see `packed_curves`).
    """
    actions, lifted = spans(run.actions), spans(run.lifted)
    changes = [span.first for span in actions] + [span.first for span in lifted]
    changes += [first - 1 for first in changes]
    kept = evenly(len(run.time), FRAMES, changes)
    time = np.asarray(run.time, dtype=np.float64) - float(run.time[0])
    lines, points = packed_curves(run)
    about = {
        "terrain": run.terrain.label,
        "samples": len(time),
        "frames": len(kept),
        "start": float(run.time[0]),
        "status": run.status,
        "reason": run.reason,
        "columns": run.rover.dof_names,
        "actions": [{"word": span.word, "from": float(time[span.first])} for span in actions],
        "lifted": [{"word": list(span.word), "from": float(time[span.first])} for span in lifted],
        "curves": lines,
    }
    return about, {"time": time[kept].astype("<f8").tobytes(), "q": _frames(run, kept).tobytes(),
                   "loads": _loads(run, kept).tobytes(), "curves": points}  # fmt: skip


def _frames(run: Run, kept: Indices) -> Array:
    """(nv, frames) float32; yaw without jumps of a whole turn, so that the page may go between frames."""
    q = np.array(run.configuration, dtype=np.float64)
    q[:, 3] = np.unwrap(q[:, 3])
    return np.ascontiguousarray(q[kept].T, dtype="<f4")


def _loads(run: Run, kept: Indices) -> Array:
    """(wheels, frames) float32 in the order of shapes, the last known ones; NaN where none is known."""
    nothing = np.full(len(run.time), np.nan)
    loads = [held(np.asarray(run.loads.get(shape.name, nothing)))[kept] for shape in run.rover.shapes]
    return np.ascontiguousarray(loads, dtype="<f4")


def wheel_sides(rover: Rover) -> list[dict[str, Any]]:
    """Per wheel or foot: whether it stands on the left at home, and its place there, 0 the foremost."""
    data = rover.model.createData()
    pin.forwardKinematics(rover.model, data, np.array(rover.neutral))
    base = data.oMi[1].inverse()
    at = [(base * data.oMi[shape.joint]).act(np.asarray(shape.center)) for shape in rover.shapes]
    left = [bool(place[1] > 0) for place in at]
    ahead = [
        sum(1 for other, there in zip(left, at, strict=True) if other == side and there[0] > place[0])
        for side, place in zip(left, at, strict=True)
    ]
    return [{"left": side, "rank": rank} for side, rank in zip(left, ahead, strict=True)]
