"""What every contact shape has to satisfy, with the error that names the shape and the cure."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from rover_pin.errors import InputError
from rover_pin.numerics import Array, frozen


def point(shape: str, key: str, value: ArrayLike) -> Array:
    """A frozen (3,) point, m.

    Raises:
        InputError: not three finite numbers.
    """
    try:
        array = frozen(value)
    except (TypeError, ValueError):
        array = np.empty(0)
    if array.shape != (3,) or not np.isfinite(array).all():
        raise InputError(
            f"{key} is not three finite numbers", element=shape, value=value, cure=f"give {key}: [x, y, z]"
        )
    return array


def direction(shape: str, key: str, value: ArrayLike) -> Array:
    """A frozen (3,) unit vector along `value`.

    Raises:
        InputError: not three finite numbers, or all zero.
    """
    array = point(shape, key, value)
    length = float(np.linalg.norm(array))
    if not length > 1e-9:
        raise InputError(
            f"{key} has no direction", element=shape, value=array.tolist(), cure=f"give {key}: [0, 1, 0]"
        )
    return frozen(array / length)


def length(shape: str, key: str, value: float, *, zero: bool = False) -> float:
    """A finite length above zero, m; zero itself only where `zero`.

    Raises:
        InputError: not a number, infinite, negative, or zero where that is no shape.
    """
    return _number(shape, key, value, zero=zero, unit=" in metres")


def coefficient(shape: str, key: str, value: float) -> float:
    """A finite coefficient, zero or more.

    Raises:
        InputError: not a number, infinite or negative.
    """
    return _number(shape, key, value, zero=True, unit="")


def _number(shape: str, key: str, value: float, *, zero: bool, unit: str) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    if not (math.isfinite(number) and (number > 0.0 or (zero and number == 0.0))):
        bound = "of zero or more" if zero else "above zero"
        raise InputError(
            f"{key} is not a finite number {bound}",
            element=shape,
            value=value,
            cure=f"give {key}{unit}",
        )
    return number
