"""What wheels pull, for what they carry and for what they are given."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from rover_pin.analysis.locomotion.series import series
from rover_pin.numerics import Array


def traction_coefficient(pull: ArrayLike, load: ArrayLike) -> Array:
    """Drawbar pull over normal load [-]; NaN where nothing is carried.

    Args:
        pull: (n,) N.
        load: (n,) N.

    Raises:
        InputError: lengths that differ, none at all, or a number that is not finite.
    """
    force, normal = series(pull=pull, load=load)
    carried = normal > 0.0
    return np.where(carried, force / np.where(carried, normal, 1.0), np.nan)


def traction_efficiency(pull: ArrayLike, speed: ArrayLike, torque: ArrayLike, rate: ArrayLike) -> Array:
    """Drawbar pull times travel speed over the drive's power, F v / (T w) [-]; NaN where no power goes in.

    Negative where a wheel that is driven is pushed back.

    Args:
        pull: F (n,) N.
        speed: v (n,) m/s.
        torque: T (n,) N m.
        rate: w (n,) rad/s.

    Raises:
        InputError: lengths that differ, none at all, or a number that is not finite.
    """
    f, v, t, w = series(pull=pull, speed=speed, torque=torque, rate=rate)
    given = t * w
    works = given > 0.0
    return np.where(works, f * v / np.where(works, given, 1.0), np.nan)
