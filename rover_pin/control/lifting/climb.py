"""The way up: rocker angles for rising heights, every pose on the way checked."""

from __future__ import annotations

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
        height: gap wanted of every lifted wheel [m].
        step: largest rise between two poses that are looked at [m].
        reserve: N that every standing wheel must carry at least.
    """
    pose = hoist.pose(hoist.start, np.array(hoist.present.configuration))
    poses: list[Pose] = []
    stances: list[Stance] = []
    reached = 0.0
    for goal in _goals(height, step):
        found = refuse_missing(hoist, goal) if pose is None else raised(hoist, pose, goal)
        stance = found if isinstance(found, Refusal) else checked(hoist, found, goal, reserve)
        if isinstance(found, Refusal) or isinstance(stance, Refusal):
            refusal = found if isinstance(found, Refusal) else stance
            assert isinstance(refusal, Refusal)
            return replace(refusal, height=reached, stances=tuple(stances))
        pose, reached = found, goal
        poses.append(found)
        stances.append(stance)
    least, wheel = min((n, name) for each in stances for name, n in standing_loads(hoist, each).items())
    return Climb(tuple(poses), tuple(stances), least, wheel)


def _goals(height: float, step: float) -> list[float]:
    """Heights to look at: just off the ground, then evenly up to the top."""
    count = max(1, int(np.ceil(height / step - 1e-9)))
    rising = [height * k / count for k in range(1, count + 1)]
    return [LIFT_OFF, *rising] if rising[0] > LIFT_OFF else rising


def refuse_missing(hoist: Hoist, goal: float) -> Refusal:
    """No pose in which all the other wheels touch."""
    wheels = ", ".join(hoist.names[row] for row in hoist.standing)
    what = f"at {1e3 * goal:.0f} mm there is no pose in which {wheels} all touch the ground"
    return refuse(hoist, RefusalStatus.OUT_OF_REACH, what)


def raised(hoist: Hoist, pose: Pose, goal: float) -> Pose | Refusal:
    """The pose with every lifted wheel `goal` over the ground, by Newton on the rockers' angles."""
    try:
        slopes = _slopes(hoist, pose)
    except ArithmeticError:
        return refuse_missing(hoist, goal)
    if np.min(np.linalg.svd(slopes, compute_uv=False)) < _FLAT:
        rockers = " and ".join(hoist.rockers)
        wheels = " and ".join(hoist.question.wheels)
        height = 1e3 * float(np.min(pose.gaps))
        what = f"turning {rockers} lifts {wheels} no further than {height:.0f} mm"
        return refuse(hoist, RefusalStatus.OUT_OF_REACH, what, hoist.rockers[0])
    for _ in range(_STEPS):
        missing = goal - pose.gaps
        if np.max(np.abs(missing)) < _CLOSE:
            return pose
        turn = np.linalg.solve(slopes, missing)
        turn *= min(1.0, _LARGEST / float(np.max(np.abs(turn))))
        found = hoist.pose(pose.angles + turn, pose.q)
        if found is None:
            break
        slopes = slopes + np.outer(found.gaps - pose.gaps - slopes @ turn, turn) / (turn @ turn)  # Broyden
        pose = found
        if np.linalg.matrix_rank(slopes) < len(turn):
            break
    return refuse_missing(hoist, goal)


def _slopes(hoist: Hoist, pose: Pose) -> Array:
    """(m, m) rise of each lifted wheel [m] per rad of each rocker, by central differences.

    Raises:
        ArithmeticError: no pose beside this one.
    """
    columns = []
    for nudge in _NUDGE * np.eye(len(pose.angles)):
        sides = [hoist.pose(pose.angles + sign * nudge, pose.q) for sign in (1.0, -1.0)]
        if sides[0] is None or sides[1] is None:
            raise ArithmeticError
        columns.append((sides[0].gaps - sides[1].gaps) / (2.0 * _NUDGE))
    return np.array(columns).T
