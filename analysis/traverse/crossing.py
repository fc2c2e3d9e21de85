"""Paths that go up a step: one straight across, and whether another does."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.analysis.traverse.centres import centres
from rover_pin.errors import InputError

if TYPE_CHECKING:
    from rover_pin.analysis.traverse.path import Place
    from rover_pin.numerics import Array
    from rover_pin.rover import Rover


def across(rover: Rover, edge: float, riser: float, angle: float = 0.0) -> Array:
    """(2, 2) m: along +x at y = 0, every wheel clear before the riser first and past the edge last."""
    ahead = _ahead(rover, angle)
    reach = max(s.ring + s.tread for s in rover.shapes)
    room = 1.2 * reach + 0.25 * rover.wheel_span
    return np.array([[edge - riser - max(ahead) - room, 0.0], [edge - min(ahead) + room, 0.0]])


def _ahead(rover: Rover, yaw: float) -> list[float]:
    """m: how far along +x each wheel's centre lies from the root link's origin, joints at zero."""
    turn = np.array([math.cos(yaw), -math.sin(yaw)])
    return [float(turn @ centre[:2]) for centre in centres(rover, rover.neutral)]


def check_crossing(rover: Rover, along: Sequence[Place], edge: float, riser: float) -> None:
    """Refuse a path that does not bring every wheel from before the riser onto the step.

    Raises:
        InputError: says where the wheels are at its end that is wrong.
    """
    first, last = along[0], along[-1]
    front = first.x + max(_ahead(rover, first.yaw))
    back = last.x + min(_ahead(rover, last.yaw))
    if front > edge - riser:
        where, wrong = "starts", f"its foremost wheel is at x = {front:.3g} m"
    elif back < edge:
        where, wrong = "ends", f"its rearmost wheel is at x = {back:.3g} m"
    else:
        return
    raise InputError(
        f"does not go up the step: where it {where}, {wrong}",
        element="path",
        value=f"the riser is at x = {edge - riser:g} to {edge:g} m",
        cure="start with every wheel before it and end with every wheel past it, or leave the path out",
    )
