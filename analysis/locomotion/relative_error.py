"""How far what was done is from what was commanded."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from rover_pin.errors import InputError


def relative_error(commanded: ArrayLike, real: ArrayLike) -> float:
    """Sum of |commanded - real| over the sum of |commanded|, of N segments (the HIT-MRII paper, eq. 42).

    Args:
        commanded: (N,) in any unit.
        real: (N,) in the same unit.

    Raises:
        InputError: lengths that differ, none at all, a number that is not finite, or nothing commanded.
    """
    asked, done = np.atleast_1d(np.asarray(commanded, dtype=np.float64)), np.atleast_1d(np.asarray(real))
    if asked.shape != done.shape or asked.ndim != 1 or not len(asked):
        raise InputError(
            "commanded and real need as many numbers as each other, at least one",
            element="relative error",
            value=f"{asked.shape} and {done.shape}",
        )
    if not (np.isfinite(asked).all() and np.isfinite(done).all()):
        raise InputError("is no finite number", element="relative error", value=[*asked, *done])
    size = float(np.sum(np.abs(asked)))
    if size == 0.0:
        raise InputError("nothing was commanded", element="relative error", cure="leave such segments out")
    return float(np.sum(np.abs(asked - done))) / size
