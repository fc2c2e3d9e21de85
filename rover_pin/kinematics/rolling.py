"""Rows of what touches the ground: along the normal, along the rolling direction, sideways.

A wheel that rolls without sliding has no velocity where it touches: the point is taken as one of the body
that turns with the wheel's own drive, so that drive, steering and everything above them have their columns.
Campion, Bastin, D'Andrea-Novel, "Structural properties of wheeled mobile robots", IEEE T-RA 12 (1996): the
rolling and the no-slip condition, here from frame Jacobians.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rover_pin.kinematics.instant import Instant, Integers
from rover_pin.numerics import Array

DIRECTIONS = ("normal", "roll", "slip")


def contact_rows(at: Instant, which: Integers, directions: Sequence[str] = DIRECTIONS) -> Array:
    """(len(directions) k, nv) velocities [m/s] where shapes `which` (k,) touch, direction by direction.

    `normal`: the rate of the gap, 0 keeps the contact. `roll`: sliding along the rolling direction, 0 where a
    wheel rolls. `slip`: sliding across it, to the left.
    """
    places = [DIRECTIONS.index(word) for word in directions]
    rows: Array = np.concatenate([at.contact_rows[place][which] for place in places])
    return rows


def rim_rows(at: Instant, which: Integers) -> Array:
    """(k, nv) what a drive's encoder tells, as a speed of the rim [m/s]: radius times the joint's own rate.

    The carrier turns with the arm, so that this is not the speed of the wheel over the ground where an arm
    moves. Wheels without a drive have a row of zeros.
    """
    rows = np.zeros((len(which), at.rover.model.nv))
    for row, place in enumerate(which.tolist()):
        wheel = at.rover.wheels[place]
        if wheel.drive is not None:
            rows[row, at.rover.column[wheel.drive]] = wheel.radius * rolling_sense(at, place)
    return rows


def ground_rows(at: Instant, which: Integers) -> Array:
    """(k, nv) speed of wheels over the ground along their rolling direction [m/s]: of the wheel's centre."""
    return at.rows(at.bodies.packed.joints[which], at.centers[which], at.rolling[which])


def rolling_sense(at: Instant, place: int) -> float:
    """1 where a drive that turns forward rolls the wheel along `rolling`, -1 where it rolls it back."""
    column = at.rover.model.idx_vs[int(at.bodies.rolling_joints[place])]
    return 1.0 if float(at.jacobian[3:, column] @ at.axes[place]) >= 0.0 else -1.0
