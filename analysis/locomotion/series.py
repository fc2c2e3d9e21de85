"""Logged series, checked."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from rover_pin.errors import InputError
from rover_pin.numerics import Array


def series(**given: ArrayLike) -> list[Array]:
    """The series as float64 arrays that broadcast with one another.

    Raises:
        InputError: one that is empty, has an entry that is no finite number, or a shape unlike the others'.
    """
    found = []
    for name, values in given.items():
        array = np.asarray(values, dtype=np.float64)
        if not array.size:
            raise InputError("is empty", element=name)
        if not np.isfinite(array).all():
            place = int(np.flatnonzero(~np.isfinite(array).ravel())[0])
            value = float(array.ravel()[place])
            raise InputError("has an entry that is no finite number", element=f"{name}[{place}]", value=value)
        found.append(array)
    try:
        np.broadcast_shapes(*(array.shape for array in found))
    except ValueError as error:
        shapes = ", ".join(f"{name} {np.shape(values)}" for name, values in given.items())
        raise InputError("series are of unlike lengths", element=", ".join(given), value=shapes) from error
    return found


def times(time: ArrayLike) -> Array:
    """(n,) s, rising.

    Raises:
        InputError: fewer than two, no finite numbers, or a time that is not after the one before.
    """
    (found,) = series(time=time)
    if found.ndim != 1 or len(found) < 2:
        raise InputError("needs at least two times", element="time", value=found.shape)
    back = np.flatnonzero(np.diff(found) <= 0.0)
    if len(back):
        place = int(back[0]) + 1
        raise InputError("is not after the time before", element=f"time[{place}]", value=float(found[place]))
    return found
