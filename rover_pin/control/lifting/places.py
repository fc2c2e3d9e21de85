"""Where parts of a standing rover are: its belly, the ends of a side."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pinocchio as pin

if TYPE_CHECKING:
    from rover_pin.control.layout import Side
    from rover_pin.statics.stance import Stance


def clearance_of(stance: Stance) -> float | None:
    """Of the lowest belly point over the terrain below it [m]; None without belly points."""
    data = _placed(stance)
    points = [data.oMi[p.joint].act(np.array(p.point)) for p in stance.rover.belly]
    return min((float(p[2]) - float(stance.terrain.height(p[0], p[1])) for p in points), default=None)


def side_span(stance: Stance, side: Side) -> float:
    """Distance between the centres of a side's front and rear wheel [m]."""
    data = _placed(stance)
    wheels = {wheel.name: wheel for wheel in stance.rover.wheels}
    ends = (wheels[side.wheels[0]], wheels[side.wheels[-1]])
    front, rear = (data.oMi[wheel.joint].act(np.array(wheel.center)) for wheel in ends)
    return math.dist(front, rear)


def _placed(stance: Stance) -> Any:
    """Pinocchio's data with every joint placed."""
    data = stance.rover.model.createData()
    pin.forwardKinematics(stance.rover.model, data, np.array(stance.configuration))
    return data
