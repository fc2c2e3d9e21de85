"""The largest step that a rover climbs quasi-statically, and what limits it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.analysis.traverse.crossing import across, check_crossing
from rover_pin.analysis.traverse.drive import Progress, driven, unresolved
from rover_pin.analysis.traverse.follow import Follower
from rover_pin.analysis.traverse.path import Waypoints, places, waypoints
from rover_pin.analysis.traverse.run import _check, default_step
from rover_pin.errors import InputError
from rover_pin.terrain import Terrain

if TYPE_CHECKING:
    from rover_pin.analysis.traverse.step import Step
    from rover_pin.rover import Rover

RISER = 0.005
"""m over which a step rises unless told."""


@dataclass(frozen=True)
class LargestStep:
    """Between which heights the answer lies.

    Attributes:
        climbed: m, the largest height that it was found to climb; 0 where none.
        stopped: m, the least that stops it; inf where it climbs the highest that was asked for.
        limit: what stops it there: `friction`, `torque`, `leap`, `tip`, `belly contact` or a status; or "".
        why: in words.
        limiting: wheel, joint or link.
        stop_m: m along the path, where it stops there.
        friction_needed: [-] the most that the largest climbed step asks for; NaN where none.
        torque_needed: N m, likewise; NaN where none, or no wheel is driven.
        effort_share: [-] likewise.
        unresolved_m: m of the way, as `traverse` tells it, of the largest climbed step: above 0, a peak may
            have been missed.
        trials: heights that were tried, m, in order.
        climbs: whether each was climbed.
    """

    climbed: float
    stopped: float
    limit: str
    why: str
    limiting: str
    stop_m: float
    friction_needed: float
    torque_needed: float
    effort_share: float
    unresolved_m: float
    trials: tuple[float, ...]
    climbs: tuple[bool, ...]


def largest_step(
    rover: Rover,
    highest: float | None = None,
    *,
    edge: float = 0.0,
    riser: float = RISER,
    path: Waypoints | None = None,
    tolerance: float = 1e-3,
    step: float | None = None,
    crab: float = 0.0,
    reverse: bool = False,
    friction: float | None = None,
    posture: str | Mapping[str, float] | None = None,
    joints: Mapping[str, float] | None = None,
    locks: Iterable[str] = (),
    gravity: float = 9.81,
    progress: Progress | None = None,
) -> LargestStep:
    """Bisect over the height of a step that the rover drives up, friction and the drives' efforts given.

    A trial is a `traverse` of `Terrain.step(height, edge, riser)` that ends where it stops. Heights between
    the two that are told were not tried; what lies above one that stops it is taken to stop it too. Where
    `limit` is `leap`, what higher steps ask for is not known.

    Args:
        rover: what climbs.
        highest: m, tried first; None is the span of its wheels.
        edge: x of the upper edge, m.
        riser: m along x over which the step rises.
        path: as for `traverse`; None goes along +x from before the step until every wheel is on it.
        tolerance: m, how close the two heights come.
        step: as for `traverse`, and so on down to gravity.
        crab: likewise.
        reverse: likewise.
        friction: likewise.
        posture: likewise.
        joints: likewise.
        locks: likewise.
        gravity: likewise.
        progress: called with finished and expected trials.

    Raises:
        InputError: as `traverse`; a height, riser or tolerance that is not above 0; a path that does not go
            up the step.

    Cost: about ten traverses of 100 to 300 places; seconds to a minute.
    """
    top = rover.wheel_span if highest is None else highest
    for name, value in (("highest", top), ("riser", riser), ("tolerance", tolerance)):
        if not (isinstance(value, int | float | np.floating) and math.isfinite(value) and value > 0):
            raise InputError("must be a finite number above 0", element=name, value=value, cure="give m")
    if not math.isfinite(edge):
        raise InputError("must be a finite number", element="edge", value=edge, cure="give m")
    _check(step, crab, friction)
    angle = crab + (math.pi if reverse else 0.0)
    points = across(rover, edge, riser, angle) if path is None else waypoints(path)
    length = default_step(rover) if step is None else float(step)
    along = places(points, length, angle)
    if path is not None:
        check_crossing(rover, along, edge, riser)
    how: dict[str, Any] = {"posture": posture, "joints": joints, "locks": tuple(locks), "gravity": gravity}
    expected = 1 + max(0, math.ceil(math.log2(top / tolerance)))
    tried: dict[float, list[Step]] = {}

    def climbs(height: float) -> bool:
        if progress is not None:
            progress(len(tried), max(expected, len(tried)))
        tried[height] = steps = []
        for one in driven(Follower(rover, Terrain.step(height, edge, riser), how), along, friction):
            steps.append(one)
            if not one.passes:
                return False
        return True

    low, high = 0.0, math.inf
    if climbs(top):
        low = top
    else:
        high = top
    while math.isfinite(high) and high - low > tolerance:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if climbs(middle) else (low, middle)
    return _answer(low, high, tried, length)


def _answer(low: float, high: float, tried: Mapping[float, list[Step]], length: float) -> LargestStep:
    stop = tried[high][-1] if math.isfinite(high) else None
    best = tried.get(low, [])

    def most(values: list[float]) -> float:
        known = [value for value in values if not math.isnan(value)]
        return max(known, default=math.nan)

    return LargestStep(
        climbed=low,
        stopped=high,
        limit="" if stop is None else stop.limit,
        why="" if stop is None else stop.why,
        limiting="" if stop is None else stop.limiting,
        stop_m=math.nan if stop is None else stop.stood.place.way,
        friction_needed=most([one.needed for one in best]),
        torque_needed=most([one.torque.value for one in best if one.torque is not None]),
        effort_share=most([one.share for one in best]),
        unresolved_m=unresolved(best, length) if best else 0.0,
        trials=tuple(tried),
        climbs=tuple(steps[-1].passes for steps in tried.values()),
    )
