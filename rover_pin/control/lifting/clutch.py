"""Engaging a clutch: only on a joint that stands still."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping

from rover_pin.errors import InputError, nearest

STILL = 1e-3
"""rad/s (or m/s) below which a joint counts as standing still."""


def engage(clutches: Iterable[str], rates: Mapping[str, float], tolerance: float = STILL) -> tuple[str, ...]:
    """The clutches, where every one of their joints stands still and they may be engaged.

    Args:
        clutches: names of the joints to lock.
        rates: velocity of each joint by name [rad/s or m/s]; others are not looked at.
        tolerance: largest speed that counts as standing still [rad/s or m/s].

    Raises:
        InputError: a joint that moves, whose rate is missing or no number (the sensor does not say that it
            stands); a tolerance that is not above 0.
    """
    if not (math.isfinite(tolerance) and tolerance > 0.0):
        raise InputError("must be above 0 rad/s", element="tolerance", value=tolerance)
    names = tuple(clutches)
    for name in names:
        if name not in rates:
            raise InputError(
                "the clutch's joint has no rate", element=name, cure=f"give one; {nearest(name, rates)}"
            )
        rate = float(rates[name])
        if not math.isfinite(rate):
            raise InputError(
                "the rate of the clutch's joint is no finite number",
                element=name, value=rate, cure="hold the robot and look at the sensor",
            )  # fmt: skip
        if abs(rate) > tolerance:
            raise InputError(
                f"the clutch cannot be engaged on a joint that moves faster than {tolerance:g} rad/s",
                element=name, value=f"{rate:.4g} rad/s", cure="stop the rockers and wheels first",
            )  # fmt: skip
    return names
