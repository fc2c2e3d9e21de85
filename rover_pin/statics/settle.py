"""settle: how a rover stands at a place on a terrain."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from rover_pin.description.guesses import cure_for_no_contact
from rover_pin.errors import InputError, OffMapError
from rover_pin.statics.asked import held_values
from rover_pin.statics.follow import follow, straight
from rover_pin.statics.ground import Footing, failed, off_map
from rover_pin.statics.level import on_level
from rover_pin.statics.problem import Problem
from rover_pin.statics.report import report
from rover_pin.statics.resisted import against
from rover_pin.statics.stance import Stance, Status
from rover_pin.statics.verdict import wheel_off_map
from rover_pin.terrain import Terrain

if TYPE_CHECKING:
    from rover_pin.rover import Rover


def settle(
    rover: Rover,
    terrain: Terrain,
    *,
    x: float = 0.0,
    y: float = 0.0,
    yaw: float = 0.0,
    posture: str | Mapping[str, float] | None = None,
    joints: Mapping[str, float] | None = None,
    locks: Iterable[str] = (),
    gravity: float = 9.81,
    resistance: float = 0.0,
) -> Stance:
    """How `rover` comes to rest when it is lowered at a place of `terrain`.

    Held are the base's x, y, yaw, the actuated joints at the posture, locked joints, and the wheels (braked).
    Free are z, roll, pitch and every other joint. Every contact force is parallel to gravity; gaps and loads
    are complementary. Of several stances it is the one that the rover reaches from level ground as the
    terrain rises from its height under the base, h0 + s (h - h0), s from 0 to 1.

    Args:
        rover: what stands.
        terrain: what it stands on.
        x: of the root link's frame [m, world].
        y: of the root link's frame [m, world].
        yaw: of the root link's frame [rad].
        posture: a name, joint values [rad or m], or `{"clearance": m}`: the belly's clearance on level
            ground, reached by moving the actuated joints least from home. Default: `home`, else zero.
        joints: further joint values; a passive joint given here is locked there.
        locks: passive joints, from the rover's `lockable`, to hold at the posture.
        gravity: m/s2.
        resistance: N, at the centre of mass against the heading, overcome by the same share of its load at
            every contact, in tracks by their tensions (`rover_pin.statics.resistance`).

    Returns:
        The stance; its `status` says whether it is `settled`. Only then it has loads.

    Raises:
        InputError: what cannot be asked: no wheels, a posture outside limits, held values that contradict a
            loop or coupling, numbers that are not finite.
        OffMapError: x, y is not on the map.
    """
    _check(rover, terrain, x, y, yaw, gravity)
    if not math.isfinite(resistance):
        raise InputError("must be a finite number", element="resistance", value=resistance)
    values, locked = held_values(rover, posture, dict(joints or {}), tuple(locks), gravity)
    problem, footing = on_level(rover, values, locked, gravity)
    problem = problem.moved(x, y, yaw)
    level = float(terrain.height(x, y))
    z = footing.z.copy()
    z[0] += level
    if footing.status is not Status.SETTLED:
        reason = footing.reason + " (already on level ground)"
        return report(problem, failed(z, footing.status, footing.limiting, reason), terrain, locked)
    found = straight(problem, footing, z, terrain)
    if found is not None:
        stance = report(*_resisted(problem, found, terrain, resistance), terrain, locked)
        if stance.status not in (Status.NO_CONVERGENCE, Status.TIPS):
            return stance
    found = follow(problem, footing, z, terrain, level)
    stance = report(*_resisted(problem, found, terrain, resistance), terrain, locked)
    if stance.status in (Status.TIPS, Status.NO_CONVERGENCE):
        beyond = wheel_off_map(problem, problem.locate(z), terrain)
        if beyond is not None:  # what it fell over is not on the map
            return report(problem, off_map(z, beyond), terrain, locked)
    return stance


def _resisted(
    problem: Problem, footing: Footing, terrain: Terrain, resistance: float
) -> tuple[Problem, Footing]:
    """The footing against a resistance, where there is one."""
    if resistance == 0.0 or footing.status is not Status.SETTLED:
        return problem, footing
    return against(problem, footing, terrain, resistance)


def _check(rover: Rover, terrain: Terrain, x: float, y: float, yaw: float, gravity: float) -> None:
    if not isinstance(terrain, Terrain):
        raise InputError(
            "not a Terrain",
            element="terrain",
            value=terrain,
            cure="make one with Terrain.flat(), Terrain.from_file(...), or Terrain.parse('slope:10')",
        )
    for name, value in (("x", x), ("y", y), ("yaw", yaw), ("gravity", gravity)):
        if not math.isfinite(value):
            raise InputError("must be a finite number", element=name, value=value)
    if gravity <= 0.0:
        raise InputError("must be above 0 m/s2", element="gravity", value=gravity)
    if not rover.shapes:
        raise InputError(
            "nothing of this robot touches the ground: it has no wheels and no contacts",
            file=rover.sidecar_path or rover.source,
            element="wheels",
            cure=cure_for_no_contact(rover.recipe.sidecar_text),
        )
    if not bool(terrain.covers(x, y)):
        xmin, xmax, ymin, ymax = terrain.extent
        raise OffMapError(
            "the place is not on the map",
            element=terrain.label,
            value=f"{x:g}, {y:g}",
            cure=f"the map spans x {xmin:g} to {xmax:g} m, y {ymin:g} to {ymax:g} m",
        )
    _check_size(rover, terrain)


def _check_size(rover: Rover, terrain: Terrain) -> None:
    xmin, xmax, ymin, ymax = terrain.extent
    side = min(xmax - xmin, ymax - ymin)
    if side < rover.wheel_span:
        raise OffMapError(
            f"the map is smaller than the rover, whose wheels are {rover.wheel_span:.3g} m apart",
            element=terrain.label,
            value=f"{side:.3g} m",
            cure="give a larger map, or check its spacing",
        )
