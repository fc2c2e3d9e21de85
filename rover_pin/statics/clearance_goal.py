"""A posture for a wanted belly clearance on level ground: the actuated joints moved least from home."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np

from rover_pin.errors import PostureError
from rover_pin.numerics import Array
from rover_pin.statics.level import on_level

if TYPE_CHECKING:
    from rover_pin.rover import Rover

_STEPS = 60
_CLOSE = 1e-9  # m
_SETTLED = 1e-5  # rad or m; what is left moves along the level set of the clearance, not across it
_NUDGE = 1e-4  # rad or m
_KEPT = 16

_answers: WeakKeyDictionary[Rover, dict[tuple[object, ...], dict[str, float]]] = WeakKeyDictionary()


def posture_for_clearance(
    rover: Rover,
    goal: float,
    start: Mapping[str, float],
    fixed: tuple[str, ...],
    locked: tuple[str, ...],
    gravity: float,
) -> dict[str, float]:
    """Joint values whose stance on level ground has its lowest belly point at `goal` above the ground.

    Minimises the sum of squares of the actuated joints' motion from `start`, subject to the clearance: steps
    u = start + g (goal - c + g . (u - start)) / g . g, with c the clearance of the lowest belly point and g
    the gradient of the belly's mean height. The lowest point changes with every roll; following its gradient
    would tilt the rover to and fro instead of raising it.

    Args:
        rover: the rover; it must declare `belly`.
        goal: m.
        start: joint values at home.
        fixed: joints the user gave, which do not move.
        locked: passive joints that are held.
        gravity: m/s2.

    Raises:
        PostureError: no belly, no actuated joint that changes the clearance, or a goal out of reach.

    Cost: some hundred stances, 0.8 s for ten driven joints; the answer is kept with the rover.
    """
    key = (goal, tuple(sorted(start.items())), fixed, locked, gravity)
    kept = _answers.setdefault(rover, {})
    if key not in kept:
        if len(kept) >= _KEPT:
            kept.pop(next(iter(kept)))
        kept[key] = _solved(rover, goal, start, fixed, locked, gravity)
    return dict(kept[key])


def _solved(
    rover: Rover,
    goal: float,
    start: Mapping[str, float],
    fixed: tuple[str, ...],
    locked: tuple[str, ...],
    gravity: float,
) -> dict[str, float]:
    """The answer to `posture_for_clearance`."""
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
    found = _clearance(rover, start, movers, u, locked, gravity)
    reached = None if found is None else found[0]
    for _ in range(_STEPS):
        if not movers or reached is None:
            break
        gradient = _gradient(rover, start, movers, u, locked, gravity)
        steep = float(gradient @ gradient)
        if not steep > 1e-12:
            break
        wanted = home + gradient * (goal - reached + gradient @ (u - home)) / steep
        step = wanted - u
        if np.max(np.abs(step)) < _SETTLED and abs(goal - reached) < _CLOSE:
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
        if found is not None and abs(found[0] - goal) <= abs(reached - goal) + 1e-9:
            return tried, found[0]
        share *= 0.5
    return u, None


def _clearance(
    rover: Rover,
    start: Mapping[str, float],
    movers: list[str],
    u: Array,
    locked: tuple[str, ...],
    gravity: float,
) -> tuple[float, float] | None:
    """Lowest belly point over level ground and the belly's mean height [m]; None where it does not stand."""
    values = {**start, **dict(zip(movers, (float(value) for value in u), strict=True))}
    problem, footing = on_level(rover, values, locked, gravity)
    if footing.status != "settled":
        return None
    at = problem.locate(footing.z)
    heights = [float(at.point(point.joint, point.point)[2]) for point in rover.belly]
    return min(heights), sum(heights) / len(heights)


def _gradient(
    rover: Rover,
    start: Mapping[str, float],
    movers: list[str],
    u: Array,
    locked: tuple[str, ...],
    gravity: float,
) -> Array:
    """Central differences of the belly's mean height by each mover.

    0 where a side does not stand, and where a mover (a steer joint) changes nothing beyond rounding.
    """
    gradient = np.zeros(len(u))
    for i in range(len(u)):
        sides = []
        for sign in (1.0, -1.0):
            shifted = u.copy()
            shifted[i] += sign * _NUDGE
            sides.append(_clearance(rover, start, movers, shifted, locked, gravity))
        if sides[0] is not None and sides[1] is not None:
            gradient[i] = (sides[0][1] - sides[1][1]) / (2.0 * _NUDGE)
    gradient[np.abs(gradient) < 1e-6 * np.max(np.abs(gradient), initial=0.0)] = 0.0
    return gradient
