"""How the wheels that should carry do so: how many are loaded, and how unevenly."""

from __future__ import annotations

import numpy as np

from rover_pin.numerics import Array

LOADED_N = 1e-3
"""A wheel carries above this, N: less is what rounding leaves."""


def touching(loads: Array) -> Array:
    """(n,) how many of the wheels are loaded.

    Args:
        loads: (n, wheels) N of the wheels that should carry; NaN, and so is the
            answer, where a case is not settled.
    """
    counted = np.count_nonzero(loads > LOADED_N, axis=1).astype(np.float64)
    return np.where(np.isnan(loads).any(axis=1), np.nan, counted)


def load_spread(loads: Array) -> Array:
    """(n,) population standard deviation of the wheels' loads over their mean [-]: 0 where all carry alike.

    Wheels off the ground count with their zero load. NaN where a case is not settled or nothing is carried.

    Args:
        loads: (n, wheels) N of the wheels that should carry.
    """
    if not loads.shape[1]:
        return np.full(len(loads), np.nan)
    mean = loads.mean(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(mean > 0.0, loads.std(axis=1) / mean, np.nan)
