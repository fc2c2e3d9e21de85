"""A posture for a wanted belly clearance on level ground: the actuated joints moved least from home."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.errors import PostureError
from rover_pin.numerics import Array

if TYPE_CHECKING:
    from rover_pin.rover import Rover

_STEPS = 60
_CLOSE = 1e-10


def posture_for_clearance(
    rover: Rover,
    goal: float,
    start: Mapping[str, float],
    fixed: tuple[str, ...],
    locked: tuple[str, ...],
    gravity: float,
) -> dict[str, float]:
    """Joint values whose stance on level ground has its lowest belly point at `goal` above the ground.

    Minimises the sum of squares of the actuated joints' motion from `start`, subject to the clearance:
    Newton's steps u = start + g (goal - c + g . (u - start)) / g . g, with g the gradient of the clearance c.

    Args:
        rover: the rover; it must declare `belly`.
        goal: m.
        start: joint values at home.
        fixed: joints the user gave, which do not move.
        locked: passive joints that are held.
        gravity: m/s2.

    Raises:
        PostureError: no belly, no actuated joint that changes the clearance, or a goal out of reach.
    """
    if not rover.belly:
        raise PostureError(
            "a clearance goal needs belly points",
            file=rover.sidecar_path,
            element="belly",
            cure="declare `belly` in the sidecar",
        )
    if not math.isfinite(goal):
        raise PostureError("not a finite number", element="clearance", value=goal, cure="give metres")
    turning = {wheel.drive for wheel in rover.wheels}
    movers = [j for j in rover.actuated if j not in turning and j not in fixed]
    home = np.array([start[joint] for joint in movers])
    lower = np.array([rover.lower[rover.column[joint]] for joint in movers])
    upper = np.array([rover.upper[rover.column[joint]] for joint in movers])
    u = home.copy()
    reached = _clearance(rover, start, movers, u, locked, gravity)
    for _ in range(_STEPS):
        if not movers or reached is None:
            break
        gradient = _gradient(rover, start, movers, u, locked, gravity)
        steep = float(gradient @ gradient)
        if not steep > 1e-12:
            break
        wanted = home + gradient * (goal - reached + gradient @ (u - home)) / steep
        step = wanted - u
        if np.max(np.abs(step)) < _CLOSE and abs(goal - reached) < 1e-9:
            return dict(zip(movers, (float(value) for value in u), strict=True))
        u, reached = _advance(rover, start, movers, u, step, goal, reached, locked, gravity, lower, upper)
    here = "the rover does not stand" if reached is None else f"the nearest is {reached:.4f} m"
    raise PostureError(
        "no posture of the actuated joints gives this belly clearance on level ground",
        element="clearance",
        value=goal,
        cure=f"{here}; ask for a clearance within the joints' reach",
    )


def _advance(
    rover: Rover,
    start: Mapping[str, float],
    movers: list[str],
    u: Array,
    step: Array,
    goal: float,
    reached: float,
    locked: tuple[str, ...],
    gravity: float,
    lower: Array,
    upper: Array,
) -> tuple[Array, float | None]:
    """A step, shortened to 0.2 rad, to the limits, and until the rover still stands."""
    share = min(1.0, 0.2 / max(float(np.max(np.abs(step))), 1e-12))
    for _ in range(12):
        tried = np.clip(u + share * step, lower, upper)
        found = _clearance(rover, start, movers, tried, locked, gravity)
        if found is not None and abs(found - goal) <= abs(reached - goal) + 1e-9:
            return tried, found
        share *= 0.5
    return u, None


def _clearance(
    rover: Rover,
    start: Mapping[str, float],
    movers: list[str],
    u: Array,
    locked: tuple[str, ...],
    gravity: float,
) -> float | None:
    """Lowest belly point over level ground [m], or None where the rover does not stand."""
    from rover_pin.statics.settle import on_level

    values = {**start, **dict(zip(movers, (float(value) for value in u), strict=True))}
    problem, footing = on_level(rover, values, locked, gravity)
    if footing.status != "settled":
        return None
    at = problem.locate(footing.z)
    return min(float(at.point(point.joint, point.point)[2]) for point in rover.belly)


def _gradient(
    rover: Rover,
    start: Mapping[str, float],
    movers: list[str],
    u: Array,
    locked: tuple[str, ...],
    gravity: float,
) -> Array:
    """Central differences of the clearance by each mover; 0 where a side does not stand."""
    gradient = np.zeros(len(u))
    for i in range(len(u)):
        sides = []
        for sign in (1.0, -1.0):
            shifted = u.copy()
            shifted[i] += sign * 1e-5
            sides.append(_clearance(rover, start, movers, shifted, locked, gravity))
        if sides[0] is not None and sides[1] is not None:
            gradient[i] = (sides[0] - sides[1]) / 2e-5
    return gradient
