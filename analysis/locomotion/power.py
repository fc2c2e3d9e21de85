"""Power of drives and the energy that goes into them."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.integrate import trapezoid

from rover_pin.analysis.locomotion.series import series, times
from rover_pin.errors import InputError
from rover_pin.numerics import Array


def power(torque: ArrayLike, rate: ArrayLike) -> Array:
    """(n,) W: sum over drives of torque times rate; braking counts against it.

    Args:
        torque: (n, drives) N m.
        rate: (n, drives) rad/s.

    Raises:
        InputError: shapes that differ, none at all, or a number that is not finite.
    """
    t, w = series(torque=torque, rate=rate)
    product = np.atleast_2d((t * w).T).T if (t * w).ndim < 2 else t * w
    total: Array = product.sum(axis=1)
    return total


def energy(time: ArrayLike, power: ArrayLike) -> float:
    """J: the integral of the power, by trapezoids.

    Args:
        time: (n,) s, rising.
        power: (n,) W.

    Raises:
        InputError: lengths that differ, fewer than two, a time that is not after the one before, or a number
            that is not finite.
    """
    t = times(time)
    (p,) = series(power=power)
    if p.shape != t.shape:
        raise InputError("series are of unlike lengths", element="time, power", value=f"{t.shape}, {p.shape}")
    return float(trapezoid(p, t))


def mean_power(time: ArrayLike, power: ArrayLike) -> float:
    """W: energy over running time.

    Raises:
        InputError: as `energy`.
    """
    t = times(time)
    return energy(t, power) / float(t[-1] - t[0])
