"""Postures: joint values by name, checked against the rover."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

from rover_pin.description.stated import refuse_outside
from rover_pin.errors import PostureError, nearest

if TYPE_CHECKING:
    from rover_pin.rover import Rover


def resolve_posture(rover: Rover, posture: str | Mapping[str, float] | None) -> dict[str, float]:
    """Joint values of a posture given by name or as a mapping; `home` may be silent, None means `home`.

    Raises:
        PostureError: an unknown posture or joint, a value that is no number or outside the limits.
    """
    if posture is None:
        posture = "home"
    if isinstance(posture, str):
        if posture in rover.postures:
            return dict(rover.postures[posture])
        if posture == "home":
            return {}
        raise PostureError(
            "no posture of that name",
            file=rover.sidecar_path,
            element="posture",
            value=posture,
            cure=nearest(posture, {"home", *rover.postures}),
        )
    return {name: _checked(rover, name, value) for name, value in posture.items()}


def _checked(rover: Rover, name: str, value: object) -> float:
    if name not in rover.joints:
        raise PostureError(
            "no moving joint of that name",
            element=f"joint {name}",
            value=value,
            cure=nearest(name, rover.joints),
        )
    try:
        number = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        number = math.nan
    if not math.isfinite(number):
        raise PostureError("not a finite number", element=f"joint {name}", value=value, cure="give rad or m")
    column = rover.column[name]
    refuse_outside(name, number, float(rover.lower[column]), float(rover.upper[column]))
    return number
