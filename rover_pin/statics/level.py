"""Stances on level ground, kept: where every settle of a posture starts, wherever on the map."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

from rover_pin.statics.ground import Footing, settle_on_level
from rover_pin.statics.held import free_coordinates, held_joints
from rover_pin.statics.problem import Problem
from rover_pin.terrain import Terrain

if TYPE_CHECKING:
    from rover_pin.rover import Rover

LEVEL = Terrain.flat()
KEPT = 64

_footings: WeakKeyDictionary[Rover, dict[tuple[object, ...], tuple[Problem, Footing]]] = WeakKeyDictionary()


def on_level(
    rover: Rover, values: Mapping[str, float], locked: tuple[str, ...], gravity: float
) -> tuple[Problem, Footing]:
    """The problem of a posture and its stance on level ground at height 0; kept per rover and posture.

    Args:
        rover: the rover.
        values: every joint's value [rad or m].
        locked: passive joints that are held.
        gravity: m/s2.

    Raises:
        MechanismError: held values that contradict a coupling or a loop.
    """
    key = (tuple(sorted(values.items())), locked, gravity)
    kept = _footings.setdefault(rover, {})
    if key not in kept:
        held = held_joints(rover, locked)
        problem = Problem(rover, free_coordinates(rover, held, values, 0.0, 0.0, 0.0), gravity)
        footing = settle_on_level(problem, values, LEVEL)
        if len(kept) >= KEPT:
            kept.pop(next(iter(kept)))
        kept[key] = (problem, footing)
    return kept[key]
