"""Masses put on a rover: at a place of its base, or at the origin of one of its links."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pinocchio as pin

from rover_pin.description.recipe import Payload, seat
from rover_pin.description.tree import HUGE
from rover_pin.errors import InputError
from rover_pin.mechanism.frames import find_frame


def put_on(model: pin.Model, root: str, payload: Sequence[Payload]) -> tuple[pin.Model, tuple[Payload, ...]]:
    """A copy of the model with point masses on it, and the masses as plain numbers and links.

    Args:
        model: Pinocchio's model; left as it is.
        root: the URDF's root link, in whose frame places are.
        payload: (kg, (x, y, z) in m), or (kg, name of a link or joint).

    Raises:
        InputError: a mass below zero, something that is no finite number, or no such link or joint.
    """
    loaded = model.copy()
    checked = tuple(_checked(model, kg, place) for kg, place in payload)
    for mass, place in checked:
        link, point = seat(place, root)
        frame = loaded.frames[loaded.getFrameId(link, pin.FrameType.BODY)]
        body = pin.Inertia(mass, np.array(point), np.zeros((3, 3)))
        loaded.appendBodyToJoint(frame.parentJoint, body, frame.placement)
    return loaded, checked


def told(payload: Sequence[Payload]) -> str:
    """Payloads in the words of `--payload`: `5@0,0,0.3; 2@arm`; empty where there are none."""
    return "; ".join(
        f"{kg!r}@{place if isinstance(place, str) else ','.join(map(repr, place))}" for kg, place in payload
    )


def _checked(model: pin.Model, kg: float, place: Any) -> Payload:
    named = isinstance(place, str)
    try:
        numbers = np.array([kg] if named else [kg, *place], dtype=float)
    except (TypeError, ValueError, OverflowError):
        numbers = np.array([np.nan])
    if numbers.shape != (1 if named else 4,) or not np.isfinite(numbers).all() or numbers[0] < 0:
        raise InputError(
            "not a mass at a place",
            element="payload",
            value=f"{kg} at {place}",
            cure="give kg >= 0 and x, y, z in m, or a link's name",
        )
    if np.abs(numbers).max() > HUGE:
        raise InputError(
            "too large to be meant", element="payload", value=f"{kg} at {place}", cure="give kg and m"
        )
    if named:
        return float(kg), _link(model, place)
    mass, x, y, z = map(float, numbers)
    return mass, (x, y, z)


def _link(model: pin.Model, name: str) -> str:
    """The link of that name, or the one a joint of that name moves."""
    found = find_frame(model, name, element="payload")
    if found.type == pin.FrameType.BODY:
        return name
    joint = next(k for k, frame in enumerate(model.frames) if frame.name == name and frame.type == found.type)
    links = [f.name for f in model.frames if f.type == pin.FrameType.BODY and f.parentFrame == joint]
    return str(links[0])
