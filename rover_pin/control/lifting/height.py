"""Wheel-lift height as a function of the rocker's angle, clutch engaged: geometry alone, no loads."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from rover_pin.control.lifting.hoist import Hoist
from rover_pin.control.lifting.question import Posture, ask
from rover_pin.control.lifting.result import Refusal
from rover_pin.errors import InputError
from rover_pin.numerics import Array, frozen

if TYPE_CHECKING:
    from rover_pin.control.layout import Layout
    from rover_pin.rover import Rover
    from rover_pin.statics.problem import Integers
    from rover_pin.terrain import Terrain

_STRIDE = 0.05  # rad between two poses that are followed


def lift_height(
    rover: Rover,
    layout: Layout,
    wheel: str,
    angles: ArrayLike,
    joints: Mapping[str, float] | None = None,
    terrain: Terrain | None = None,
    *,
    posture: Posture = None,
    x: float = 0.0,
    y: float = 0.0,
    yaw: float = 0.0,
) -> Array | Refusal:
    """Height of a wheel over the ground while its side's rocker turns with the clutch engaged.

    What the HIT-MRII paper gives as its equations 8 to 10 for front, middle and rear wheels (they did not
    survive in our copy): here the height of the wheel's lowest point over the ground under its centre, in the
    pose in which all others touch, solved from the contacts, for any rover and terrain. Whether the loads
    allow that pose is for `plan_lift`.

    Args:
        rover: the rover.
        layout: its sides.
        wheel: name of the lifted wheel.
        angles: of the rocker of its side [rad], any shape.
        joints: as for `plan_lift`.
        terrain: default flat.
        posture: as for `settle`; the clutch is engaged in this posture.
        x: of the base [m].
        y: of the base [m].
        yaw: of the base [rad].

    Returns:
        Heights [m] in the shape of `angles`; negative where the wheel would be in the ground (the other
        direction lifts it), NaN where the others cannot all touch. Or a refusal: no clutch, no stance.

    Raises:
        InputError: unknown wheel or joint, angles that are not finite or beyond the rocker's limits.
    """
    question = ask(rover, layout, (wheel,), terrain, (x, y, yaw), 9.81)
    asked = np.asarray(angles, dtype=np.float64)
    _within(rover, question.sides[0].rocker, asked)
    given = rover.resolve_posture(dict(joints or {}))
    begun = question.begin(posture, given)
    if isinstance(begun, Refusal):
        return begun
    present, locked = begun
    hoist = Hoist(question, present, locked)
    flat = asked.ravel()
    heights = np.full(flat.shape, math.nan)
    for chosen in (flat >= hoist.start[0], flat < hoist.start[0]):
        rows = np.flatnonzero(chosen)
        outward = rows[np.argsort(np.abs(flat[rows] - hoist.start[0]), kind="stable")]
        _follow(hoist, flat, outward, heights)
    return frozen(heights.reshape(asked.shape))


def _follow(hoist: Hoist, angles: Array, order: Integers, heights: Array) -> None:
    """Fill in heights [m] at angles [rad] in an order that leads away from the start."""
    now, q = float(hoist.start[0]), np.array(hoist.present.configuration)
    for row in order:
        goal = float(angles[row])
        strides = max(1, math.ceil(abs(goal - now) / _STRIDE))
        for k in range(1, strides + 1):
            pose = hoist.pose(np.array([now + (goal - now) * k / strides]), q)
            if pose is None:
                return
            q, heights[row] = pose.q, pose.heights[0]
        now = goal


def _within(rover: Rover, rocker: str, angles: Array) -> None:
    if not np.isfinite(angles).all():
        raise InputError("angles must be finite numbers", element=rocker, cure="give radians")
    column = rover.column[rocker]
    low, high = float(rover.lower[column]), float(rover.upper[column])
    beyond = angles[(angles < low) | (angles > high)]
    if beyond.size:
        raise InputError(
            "beyond the rocker's limits",
            element=rocker, value=f"{beyond.flat[0]:.4g} rad",
            cure=f"stay within {low:.4g} to {high:.4g} rad",
        )  # fmt: skip
