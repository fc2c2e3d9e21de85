"""How much of a commanded motion is lost, or slid beyond."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from rover_pin.analysis.locomotion.series import series
from rover_pin.numerics import Array

STANDSTILL = 1e-9
"""m/s: below this, commanded and real, there is no ratio."""


def slip_ratio(commanded: ArrayLike, real: ArrayLike, standstill: float = STANDSTILL) -> Array:
    """(c - v) / c where it is driven, |v| <= |c|; (c - v) / |v|, the command's sign, where it slides ahead.

    Wong, "Theory of Ground Vehicles": 0 where nothing is lost, 1 where it stands with turning wheels, above 1
    where it is carried back, below 0 down to -1 where it slides ahead of its wheels. Of a wheel c is radius
    times rate, of the body the commanded speed.

    Args:
        commanded: c (n,) m/s.
        real: v (n,) m/s.
        standstill: m/s; where both are slower there is no ratio: NaN. So it is where nothing was commanded
            and it moves.

    Raises:
        InputError: lengths that differ, none at all, or a number that is not finite.
    """
    c, v = series(commanded=commanded, real=real)
    c, v = np.broadcast_arrays(c, v)
    ahead = (np.abs(v) > np.abs(c)) & (c * v > 0.0)
    size = np.where(ahead, np.abs(v), np.abs(c))
    known = (np.abs(c) > standstill) & (size > standstill)
    lost = (c - v) * np.sign(c)
    return np.where(known, lost / np.where(known, size, 1.0), np.nan)
