"""plan_lift: which way the rockers turn, how far, and what the wheels that stand carry on the way."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import TYPE_CHECKING

from rover_pin.control.lifting.climb import climb
from rover_pin.control.lifting.hoist import Hoist
from rover_pin.control.lifting.places import clearance_of, side_span
from rover_pin.control.lifting.question import Posture, Question, ask, positive
from rover_pin.control.lifting.result import LiftPlan, Refusal, RefusalStatus

if TYPE_CHECKING:
    from rover_pin.control.layout import Layout
    from rover_pin.rover import Rover
    from rover_pin.statics.stance import Stance
    from rover_pin.terrain import Terrain

STEP = 0.02
"""m: largest rise between two stances that are looked at."""


def plan_lift(
    rover: Rover,
    layout: Layout,
    wheels: Sequence[str],
    height: float,
    joints: Mapping[str, float] | None = None,
    terrain: Terrain | None = None,
    *,
    posture: Posture = None,
    x: float = 0.0,
    y: float = 0.0,
    yaw: float = 0.0,
    gravity: float = 9.81,
    reserve: float = 0.0,
    step: float = STEP,
) -> LiftPlan | Refusal:
    """Plan to lift wheels from the present posture.

    The clutch of each side with a wheel to lift is engaged at its joint's present value, then that side's
    rocker turns. The direction is the one in which the wheel rises while every other wheel touches; the
    angles are solved for rising heights, each pose followed from the one before. The loads at each follow
    from equilibrium with all other wheels held to the ground; where one would be negative the lift is
    refused with that load, else the statics must accept the pose as a stance.

    Args:
        rover: the rover.
        layout: its sides.
        wheels: names, at most one a side.
        height: wanted of every lifted wheel's lowest point over the ground under its centre [m].
        joints: present values of driven joints [rad or m] over `posture`, as a stance's `joints`. Passive
            joints follow from the statics; a clutch's value given here is where it is locked.
        terrain: default flat.
        posture: as for `settle`: a name, values, or `{"clearance": m}`.
        x: of the base, held [m].
        y: of the base, held [m].
        yaw: of the base, held [rad].
        gravity: m/s2.
        reserve: load that every standing wheel must keep on the way [N].
        step: largest rise between two stances that are looked at [m].

    Returns:
        The plan, or a refusal: wheels not admissible together, a side without clutch, no stance to start
        from, a negative load, a reserve not kept, a limit, a link in the ground, a height out of reach.

    Raises:
        InputError: unknown wheels or joints, numbers that are not finite, a height or step not above 0.
        OffMapError: the place is not on the map.
    """
    question = ask(rover, layout, wheels, terrain, (x, y, yaw), gravity)
    positive("height", height)
    positive("reserve", reserve, zero=True)
    positive("step", step)
    given = rover.resolve_posture(dict(joints or {}))
    begun = question.begin(posture, given)
    if isinstance(begun, Refusal):
        return begun
    present, locked = begun
    found = lift_from(question, present, locked, float(height), step, reserve)
    if isinstance(found, Refusal) and found.status is RefusalStatus.NEGATIVE_LOAD:
        instead = question.lifted_instead(present, locked, found.rockers)
        return replace(found, reason=f"{found.reason}; {instead}")
    return found


def lift_from(
    question: Question,
    present: Stance,
    locked: Mapping[str, float],
    height: float,
    step: float,
    reserve: float,
    approach: tuple[Stance, ...] = (),
) -> LiftPlan | Refusal:
    """The lift from a stance, clutches locked at given values."""
    hoist = Hoist(question, present, locked)
    found = climb(hoist, height, step, reserve)
    if isinstance(found, Refusal):
        return found
    top, stance = found.poses[-1], found.stances[-1]
    shorter = {s.name: side_span(stance, s) < side_span(present, s) for s in question.sides}
    rockers = [side.rocker for side in question.layout.sides]
    return LiftPlan(
        wheels=question.wheels,
        clutches=MappingProxyType(dict(locked)),
        start=MappingProxyType({rocker: present.joints[rocker] for rocker in rockers}),
        rockers=MappingProxyType(dict(zip(hoist.rockers, top.angles.tolist(), strict=True))),
        directions=MappingProxyType({s: "folds" if shrinks else "unfolds" for s, shrinks in shorter.items()}),
        clearance=clearance_of(present),
        heights=MappingProxyType(dict(zip(question.wheels, top.heights.tolist(), strict=True))),
        loads=stance.loads,
        least_load=found.least_load,
        least_wheel=found.least_wheel,
        present=present,
        stances=found.stances,
        approach=approach,
    )
