"""A rover in motion as the statics ask for it: place, driven joints, engaged clutches."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rover_pin.control.actions.action import Grip
    from rover_pin.kinematics.instant import Instant


def held_joints(at: Instant, grip: Grip) -> dict[str, float]:
    """Driven joints but the wheels' drives, which do not matter to a wheel at rest, and engaged clutches."""
    rover = at.rover
    drives = {wheel.drive for wheel in rover.wheels}
    held = {name: float(at.q[rover.column[name]]) for name in rover.actuated if name not in drives}
    held |= {name: float(value) for name, value in grip.clutches.items()}
    column, lower, upper = rover.column, rover.lower, rover.upper
    return {
        name: min(max(value, float(lower[column[name]])), float(upper[column[name]]))
        for name, value in held.items()
    }


def place_of(at: Instant) -> tuple[float, float, float]:
    """x, y [m] and yaw [rad, within half a turn] of the root link."""
    return float(at.q[0]), float(at.q[1]), math.remainder(float(at.q[3]), 2.0 * math.pi)
