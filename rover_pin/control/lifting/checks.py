"""What a pose on the way up is checked for: limits, penetration, loads, and that it is a stance."""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.control.lifting.hoist import Hoist, Pose
from rover_pin.control.lifting.result import Refusal, RefusalStatus
from rover_pin.statics.loads import TOUCHING
from rover_pin.statics.stance import Stance, Status

if TYPE_CHECKING:
    from collections.abc import Mapping

_ZERO = 1e-8
"""Share of the weight within which a load counts as zero."""


_STAYS = 1e-5
"""m or rad: a pose that the statics moves further is none in which the rover stays."""


def refuse(
    hoist: Hoist,
    status: RefusalStatus,
    reason: str,
    limiting: str | None = None,
    load: float | None = None,
    pose: Pose | None = None,
) -> Refusal:
    """A refusal of this lift, at a pose."""
    angles = {} if pose is None else dict(zip(hoist.rockers, pose.angles.tolist(), strict=True))
    return Refusal(hoist.question.wheels, status, reason, limiting, load, MappingProxyType(angles))


def checked(hoist: Hoist, pose: Pose, goal: float, reserve: float) -> Stance | Refusal:
    """The stance of a pose, or why it is none that is wanted.

    Args:
        hoist: the lift.
        pose: with the wheels up.
        goal: their height, for words [m].
        reserve: N that every standing wheel must carry at least.
    """
    found = _limits(hoist, pose, goal) or _contact(hoist, pose, goal)
    found = found or _loads(hoist, pose, pose.loads, goal, reserve)
    if found is not None:
        return found
    stance = hoist.stance(pose)
    if not stance.settled:
        grounded = stance.status is Status.GROUNDED
        status = RefusalStatus.GROUNDED if grounded else RefusalStatus.NO_STANCE
        reason = f"{_when(hoist, goal)} {stance.reason}"
        return refuse(hoist, status, reason, stance.limiting, pose=pose)
    if np.max(np.abs(stance.configuration - pose.q)) > _STAYS:
        what = f"{_when(hoist, goal)} the rover does not stay: it balances on the other wheels and would move"
        return refuse(hoist, RefusalStatus.NO_STANCE, what, pose=pose)
    return _loads(hoist, pose, standing_loads(hoist, stance), goal, reserve) or stance


def standing_loads(hoist: Hoist, stance: Stance) -> dict[str, float]:
    """Loads of the wheels that stand [N]."""
    return {name: stance.loads[name] for name in (hoist.names[row] for row in hoist.standing)}


def _when(hoist: Hoist, goal: float) -> str:
    wheels = " and ".join(hoist.question.wheels)
    height = f"{1e3 * goal:.0f} mm up" if goal >= 5e-4 else "just off the ground"
    return f"with {wheels} {height}"


def _limits(hoist: Hoist, pose: Pose, goal: float) -> Refusal | None:
    """A joint beyond its limit; the rockers are looked at first, then what moves with them."""
    rover = hoist.question.rover
    for joint in (*hoist.rockers, *rover.joints):
        column = rover.column[joint]
        value, low, high = (float(each[column]) for each in (pose.q, rover.lower, rover.upper))
        if not low - 1e-9 <= value <= high + 1e-9:
            limit = low if value < low else high
            unit = "rad" if rover.turning[column] else "m"
            what = f"{_when(hoist, goal)} {joint} would have to be at {value:.4g} {unit}, beyond its limit"
            return refuse(hoist, RefusalStatus.LIMIT, f"{what} {limit:.4g} {unit}", joint, pose=pose)
    return None


def _contact(hoist: Hoist, pose: Pose, goal: float) -> Refusal | None:
    """A wheel that should stand and does not (supports too many for any pose), or one in the ground."""
    worst = int(hoist.standing[np.argmax(np.abs(pose.slack[hoist.standing]))])
    off = float(pose.slack[worst])
    if abs(off) > TOUCHING:
        name, where = hoist.names[worst], "off the ground" if off > 0.0 else "in it"
        what = f"{_when(hoist, goal)} the other wheels cannot all stand: {name} would be"
        reason = f"{what} {1e3 * abs(off):.3g} mm {where}"
        return refuse(hoist, RefusalStatus.OUT_OF_REACH, reason, name, pose=pose)
    deepest = int(np.argmin(pose.slack))
    if pose.slack[deepest] < -TOUCHING:
        name = hoist.names[deepest]
        what = f"{_when(hoist, goal)} {name} would be {-1e3 * pose.slack[deepest]:.3g} mm in the ground"
        return refuse(hoist, RefusalStatus.GROUNDED, what, name, pose=pose)
    return None


def _loads(
    hoist: Hoist, pose: Pose, loads: Mapping[str, float], goal: float, reserve: float
) -> Refusal | None:
    """A standing wheel that would be held down, or carries less than the reserve."""
    if not loads:
        return None
    name = min(loads, key=lambda wheel: loads[wheel])
    load, zero = loads[name], _ZERO * pose.problem.weight
    if load < -zero:
        what = f"{_when(hoist, goal)} {name} would have to carry {load:.3g} N"
        return refuse(hoist, RefusalStatus.NEGATIVE_LOAD, what, name, load, pose)
    if load < reserve - zero:
        what = f"{_when(hoist, goal)} {name} would carry {load:.3g} N, less than the {reserve:g} N wanted"
        return refuse(hoist, RefusalStatus.RESERVE, what, name, load, pose)
    return None
