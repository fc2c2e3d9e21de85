"""Masses put on a rover's base."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pinocchio as pin

from rover_pin.description.recipe import Payload
from rover_pin.errors import InputError


def put_on_base(
    model: pin.Model, root: str, payload: Sequence[Payload]
) -> tuple[pin.Model, tuple[Payload, ...]]:
    """A copy of the model with point masses on its base, and the masses as plain numbers.

    Args:
        model: Pinocchio's model; left as it is.
        root: the URDF's root link, in whose frame the places are.
        payload: (kg, (x, y, z) in m).

    Raises:
        InputError: a mass below zero, or something that is no finite number.
    """
    loaded = model.copy()
    frame = loaded.frames[loaded.getFrameId(root, pin.FrameType.BODY)]
    checked: list[Payload] = []
    for kg, place in payload:
        numbers = np.array([kg, *place], dtype=float)
        if numbers.shape != (4,) or not np.isfinite(numbers).all() or numbers[0] < 0:
            raise InputError(
                "not a mass at a place",
                element="payload",
                value=f"{kg} at {place}",
                cure="give kg >= 0 and x, y, z in m",
            )
        mass, x, y, z = map(float, numbers)
        body = pin.Inertia(mass, np.array([x, y, z]), np.zeros((3, 3)))
        loaded.appendBodyToJoint(frame.parentJoint, body, frame.placement)
        checked.append((mass, (x, y, z)))
    return loaded, tuple(checked)
