"""Where the middles of wheels and feet are."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pinocchio as pin

if TYPE_CHECKING:
    from rover_pin.numerics import Array
    from rover_pin.rover import Rover


def centres(rover: Rover, configuration: Array) -> Array:
    """(wheels, 3) m, world, at a configuration (nv,)."""
    data = rover.model.createData()
    pin.forwardKinematics(rover.model, data, np.array(configuration))
    return np.array([data.oMi[shape.joint].act(np.array(shape.center)) for shape in rover.shapes])
