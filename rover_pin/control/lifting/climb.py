"""The way up: rocker angles for rising heights, every pose on the way checked."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.control.lifting.checks import checked, refuse, standing_loads
from rover_pin.control.lifting.hoist import Hoist, Pose
from rover_pin.control.lifting.result import Refusal, RefusalStatus
from rover_pin.numerics import Array

if TYPE_CHECKING:
    from rover_pin.statics.stance import Stance

LIFT_OFF = 1e-4
"""m: the first height looked at; clear of what counts as touching."""

_NUDGE = 1e-4  # rad
_CLOSE = 1e-9  # m
_STEPS = 25
_LARGEST = 0.1  # rad, of one Newton step
_FLAT = 1e-3  # m/rad: rockers that lift less than this have no hold on the wheels


@dataclass(frozen=True)
class Climb:
    """A way up that holds.

    Attributes:
        poses: rising.
        stances: of the poses.
        least_load: N, the least of a standing wheel.
        least_wheel: that wheel.
    """

    poses: tuple[Pose, ...]
    stances: tuple[Stance, ...]
    least_load: float
    least_wheel: str


def climb(hoist: Hoist, height: float, step: float, reserve: float) -> Climb | Refusal:
    """Raise the wheels to `height` together.

    Args:
        hoist: the lift.
        height: wanted of every lifted wheel [m].
        step: largest rise between two poses that are looked at [m].
        reserve: N that every standing wheel must carry at least.
    """
    start = hoist.pose(hoist.start, np.array(hoist.present.configuration))
    if start is None:
        return refuse_missing(hoist, 0.0)
    off = raised(hoist, start, np.full(len(hoist.lifted), LIFT_OFF), _gaps(hoist))
    if isinstance(off, Refusal):
        return off
    rise = height - off.heights
    count = max(0, int(np.ceil(float(np.max(rise)) / step - 1e-9)))
    poses: list[Pose] = []
    stances: list[Stance] = []
    reached = 0.0
    for k in range(count + 1):
        goal = off.heights + rise * k / max(count, 1)
        found = _stood(hoist, off if k == 0 else raised(hoist, poses[-1], goal, _heights), goal, reserve)
        if isinstance(found, Refusal):
            return replace(found, height=reached, stances=tuple(stances))
        poses.append(found[0])
        stances.append(found[1])
        reached = float(np.min(goal))
    least, wheel = min((n, name) for each in stances for name, n in standing_loads(hoist, each).items())
    return Climb(tuple(poses), tuple(stances), least, wheel)


def _stood(hoist: Hoist, pose: Pose | Refusal, goal: Array, reserve: float) -> tuple[Pose, Stance] | Refusal:
    """A pose with its stance, where it is one."""
    if isinstance(pose, Refusal):
        return pose
    stance = checked(hoist, pose, float(np.max(goal)), reserve)
    return stance if isinstance(stance, Refusal) else (pose, stance)


def _gaps(hoist: Hoist) -> Callable[[Pose], Array]:
    """Reads the lifted wheels' gaps to the nearest ground."""
    return lambda pose: pose.slack[hoist.lifted]


def _heights(pose: Pose) -> Array:
    """The lifted wheels' heights over the ground below them."""
    return pose.heights


def refuse_missing(hoist: Hoist, goal: float) -> Refusal:
    """No pose in which all the other wheels touch."""
    wheels = ", ".join(hoist.names[row] for row in hoist.standing)
    what = f"at {1e3 * goal:.0f} mm there is no pose in which {wheels} all touch the ground"
    return refuse(hoist, RefusalStatus.OUT_OF_REACH, what)


def raised(hoist: Hoist, pose: Pose, goal: Array, read: Callable[[Pose], Array]) -> Pose | Refusal:
    """The pose where `read` gives `goal` (m,), by Newton on the rockers' angles, slopes by Broyden."""
    top = float(np.max(goal))
    slopes = _slopes(hoist, pose, read)
    if slopes is None:
        return refuse_missing(hoist, top)
    if np.min(np.linalg.svd(slopes, compute_uv=False)) < _FLAT:
        rockers, wheels = " and ".join(hoist.rockers), " and ".join(hoist.question.wheels)
        most = 1e3 * max(float(np.min(pose.heights)), 0.0)
        what = f"turning {rockers} lifts {wheels} no further than {most:.0f} mm"
        return refuse(hoist, RefusalStatus.OUT_OF_REACH, what, hoist.rockers[0], pose=pose)
    for _ in range(_STEPS):
        missing = goal - read(pose)
        if np.max(np.abs(missing)) < _CLOSE:
            return pose
        turn = np.linalg.lstsq(slopes, missing, rcond=1e-9)[0]
        turn *= min(1.0, _LARGEST / float(np.max(np.abs(turn))))
        found = hoist.pose(pose.angles + turn, pose.q)
        if found is None:
            break
        slopes = slopes + np.outer(read(found) - read(pose) - slopes @ turn, turn) / (turn @ turn)
        pose = found
    return refuse_missing(hoist, top)


def _slopes(hoist: Hoist, pose: Pose, read: Callable[[Pose], Array]) -> Array | None:
    """(m, m) rise of each lifted wheel [m] per rad of each rocker, by central differences."""
    columns = []
    for nudge in _NUDGE * np.eye(len(pose.angles)):
        above, below = (hoist.pose(pose.angles + sign * nudge, pose.q) for sign in (1.0, -1.0))
        if above is None or below is None:
            return None
        columns.append((read(above) - read(below)) / (2.0 * _NUDGE))
    return np.array(columns).T
