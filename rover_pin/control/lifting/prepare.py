"""prepare_lift: raise or lower the chassis first, as far as a lift needs to keep its reserve of load."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from rover_pin.control.lifting.nearest import Search, raising
from rover_pin.control.lifting.plan import STEP
from rover_pin.control.lifting.question import Posture, ask, positive
from rover_pin.control.lifting.result import LiftPlan, Refusal

if TYPE_CHECKING:
    from rover_pin.control.layout import Layout
    from rover_pin.rover import Rover
    from rover_pin.terrain import Terrain


def prepare_lift(
    rover: Rover,
    layout: Layout,
    wheels: Sequence[str],
    height: float,
    joints: Mapping[str, float] | None = None,
    terrain: Terrain | None = None,
    *,
    reserve: float,
    posture: Posture = None,
    x: float = 0.0,
    y: float = 0.0,
    yaw: float = 0.0,
    gravity: float = 9.81,
    step: float = STEP,
) -> LiftPlan | Refusal:
    """The lift from the clearance nearest to the present one from which every standing wheel keeps `reserve`.

    Both rockers turn together with the clutches open, by equal angles in the directions that raise the
    chassis (or lower it); every posture tried must be a stance. The nearest that serves upwards and
    downwards are found by bisection, and the one that changes the clearance less is taken.

    Args:
        rover: the rover.
        layout: its sides.
        wheels: names, at most one a side.
        height: wanted of every lifted wheel, as for `plan_lift` [m].
        joints: present values of driven joints [rad or m] over `posture`.
        terrain: default flat.
        reserve: load that every standing wheel must keep on the way up [N].
        posture: as for `settle`.
        x: of the base, held [m].
        y: of the base, held [m].
        yaw: of the base, held [rad].
        gravity: m/s2.
        step: largest rise between two stances that are looked at [m].

    Returns:
        The plan, whose `start`, `clearance` and `present` are the prepared posture and whose `approach` are
        the stances on the way to it; or a refusal that says what comes nearest.

    Raises:
        InputError: as `plan_lift`; a rocker that does not move the chassis.
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
    present, _ = begun
    return Search(question, present, raising(question, present), float(height), step, reserve).nearest()
