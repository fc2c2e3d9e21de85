"""A point foot: a foot of no radius."""

from __future__ import annotations

from numpy.typing import ArrayLike

from rover_pin.contact.checks import point as checked
from rover_pin.contact.sphere import Foot

__all__ = ["Foot", "point_foot"]


def point_foot(name: str, link: str, joint: int, center: ArrayLike, friction: float = 0.6) -> Foot:
    """A bare point that touches; arguments as for `Foot`.

    Raises:
        InputError: a value that is no foot.
    """
    return Foot(name, link, joint, checked(name, "center", center), 0.0, friction)
