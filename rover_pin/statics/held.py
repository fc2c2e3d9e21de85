"""What is held and what is free while a rover settles."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from rover_pin.mechanism import Reduction, reduce_coordinates

if TYPE_CHECKING:
    from rover_pin.rover import Rover

BASE = 6
YAW = 3


def held_joints(rover: Rover, locked: tuple[str, ...]) -> tuple[str, ...]:
    """Joints that do not move: actuated ones, the wheels' own (braked) and locked ones, in model order."""
    braked = {wheel.drive for wheel in rover.wheels if wheel.drive is not None}
    held = set(rover.actuated) | braked | set(locked)
    return tuple(joint for joint in rover.joints if joint in held)


def free_coordinates(
    rover: Rover, held: tuple[str, ...], posture: Mapping[str, float], x: float, y: float, yaw: float
) -> Reduction:
    """Coordinates that gravity moves: the base's z, pitch and roll and the joints that are not held.

    Args:
        rover: the rover.
        held: joints that stay at the posture.
        posture: joint values [rad or m]; 0 where silent.
        x: of the base [m].
        y: of the base [m].
        yaw: of the base [rad].

    Raises:
        MechanismError: held values that contradict a coupling.
    """
    values = {0: x, 1: y, YAW: yaw}
    for joint in held:
        values[rover.column[joint]] = float(posture.get(joint, 0.0))
    names = dict(enumerate(rover.dof_names))
    return reduce_coordinates(rover.model.nv, rover.couplings, values, names)
