"""What a settle is asked to hold: every joint's value, and which passive joints are locked there."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.errors import PostureError
from rover_pin.mechanism.lock import engage
from rover_pin.statics.clearance_goal import posture_for_clearance
from rover_pin.statics.held import BASE

if TYPE_CHECKING:
    from rover_pin.rover import Rover


def held_values(
    rover: Rover,
    posture: str | Mapping[str, float] | None,
    joints: dict[str, float],
    locks: tuple[str, ...],
    gravity: float,
) -> tuple[dict[str, float], tuple[str, ...]]:
    """Every joint's value, and the passive joints that are locked.

    Args:
        rover: the rover.
        posture: as for `settle`.
        joints: further joint values [rad or m].
        locks: passive joints to hold at the posture.
        gravity: m/s2, for a clearance goal.

    Raises:
        PostureError: a value that the rover cannot take.
        MechanismError: a goal that cannot be reached.
    """
    values = _at_zero(rover)
    given = rover.resolve_posture(joints)
    locked = {name for name in given if name not in rover.actuated and name not in _drives(rover)}
    if isinstance(posture, Mapping) and "clearance" in posture:
        if len(posture) > 1:
            raise PostureError(
                "a clearance goal stands alone",
                element="posture",
                value=", ".join(posture),
                cure="give other joints by `joints`",
            )
        base = values | rover.resolve_posture(None) | given
        named = posture_for_clearance(
            rover,
            _metres(posture["clearance"]),
            base,
            tuple(given),
            _engaged(rover, locks, base, locked),
            gravity,
        )
    else:
        named = rover.resolve_posture(posture)
    values |= named | given
    return values, _engaged(rover, locks, values, locked)


def _metres(goal: object) -> float:
    """A clearance goal as a number."""
    try:
        return float(goal)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        raise PostureError(
            "not a finite number", element="clearance", value=goal, cure="give metres"
        ) from None


def _engaged(
    rover: Rover, locks: tuple[str, ...], values: Mapping[str, float], locked: set[str]
) -> tuple[str, ...]:
    engaged = {lock.joint for lock in engage(locks, rover.lockable, values, file=rover.sidecar_path)}
    return tuple(sorted(engaged | locked))


def _at_zero(rover: Rover) -> dict[str, float]:
    """Every joint at 0, or at the limit nearest to it."""
    nearest = np.clip(0.0, rover.lower, rover.upper)
    return dict(zip(rover.joints, nearest[BASE:].tolist(), strict=True))


def _drives(rover: Rover) -> set[str]:
    return {wheel.drive for wheel in rover.wheels if wheel.drive is not None}
