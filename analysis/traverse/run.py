"""traverse: a rover driven quasi-statically along a line."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.analysis.traverse.drive import Progress, driven, unresolved
from rover_pin.analysis.traverse.follow import Follower
from rover_pin.analysis.traverse.path import Waypoints, check_on_map, places, waypoints
from rover_pin.analysis.traverse.result import as_dataset
from rover_pin.errors import InputError
from rover_pin.stability.report import chosen

if TYPE_CHECKING:
    import xarray as xr

    from rover_pin.analysis.traverse.step import Step
    from rover_pin.rover import Rover
    from rover_pin.terrain import Terrain


def traverse(
    rover: Rover,
    terrain: Terrain,
    path: Waypoints,
    *,
    step: float | None = None,
    crab: float = 0.0,
    reverse: bool = False,
    measures: Iterable[str] = ("tip",),
    friction: float | None = None,
    posture: str | Mapping[str, float] | None = None,
    joints: Mapping[str, float] | None = None,
    locks: Iterable[str] = (),
    gravity: float = 9.81,
    until_stop: bool = False,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Drive a rover along straight legs between waypoints, standing at every place, without speed.

    The root link's frame follows the path, its heading along it; at a corner it turns on the spot. Each
    stance is found from the one before. Where a contact starts, ends or jumps (a step's edge), where the
    rover ceases to stand or friction or torque to suffice, the step is halved down to 1/4096 of itself, so
    that peaks are met. Contacts with a riser have its edge's normal, from the edge to the wheel.

    Friction is the least coefficient with which forces hold the rover, passive joints counted (Thueer et al.
    2006); torque the least possible largest torque of a driven wheel within the friction given (Noble and
    Issac 2019). Both are of rest: no rolling resistance, no speed, no turning moment. It stops where the
    friction is not enough, where drives would need more than the URDF's `effort`, where a wheel would have to
    rise at once (`leap`), or where it does not stand.

    Args:
        rover: what drives.
        terrain: on what.
        path: (n, 2) waypoints [m], `x1,y1;x2,y2`, or a CSV file of them.
        step: m between places; None is a fifth of the smallest wheel's radius.
        crab: rad, the heading from the path's direction, counterclockwise.
        reverse: drive backwards.
        measures: names of further measures at every place.
        friction: coefficient at every contact; None takes what each shape declares.
        posture: as for `rover_pin.settle`.
        joints: likewise; where crabbed, steer the wheels here.
        locks: likewise.
        gravity: m/s2.
        until_stop: end at the first place where it stops; else its stances beyond are there too.
        progress: called with finished and all places.

    Returns:
        Dimensions step, wheel, joint. `way_m, x_m, y_m, yaw_rad, z_m, roll_rad, pitch_rad, joint_rad,
        load_n, wheel_m` (centres), `ground_m`, `status, followed, friction_needed, friction_margin,
        torque_needed, torque_nm, effort_share, limit, why, limiting`, one variable a measure; attributes
        `passed` (1 or 0), `stop_m`, `stop_limit`, `stop_why`, `stop_at`, `unresolved_m` (see `unresolved`).

    Raises:
        InputError: a path, number, measure, posture or joint that cannot be used.
        OffMapError: a waypoint that is not on the map.

    Cost: about 20 ms a place with six wheels.
    """
    points = waypoints(path)
    _check(step, crab, friction)
    asked = [each for each in chosen(measures) if not each.missing(rover)]
    check_on_map(points, terrain)
    length = default_step(rover) if step is None else float(step)
    angle = crab + (math.pi if reverse else 0.0)
    how: dict[str, Any] = {"posture": posture, "joints": joints, "locks": tuple(locks), "gravity": gravity}
    along = places(points, length, angle)
    follower = Follower(rover, terrain, how)
    found: list[Step] = []
    for one in driven(follower, along, friction, progress):
        found.append(one)
        if until_stop and not one.passes:
            break
    told = {**how, "step": length, "crab": angle, "friction": friction}
    data = as_dataset(rover, terrain, points, found, asked, told)
    return data.assign_attrs(unresolved_m=unresolved(found, length))


def default_step(rover: Rover) -> float:
    """A fifth of the smallest wheel's radius, m; a hundredth of the span where there are only feet."""
    radii = [wheel.radius for wheel in rover.wheels]
    return min(radii) / 5.0 if radii else rover.wheel_span / 100.0


def _check(step: float | None, crab: float, friction: float | None) -> None:
    for name, value, cure in (
        ("step", step, "give a length above 0 in m"),
        ("friction", friction, "give a number above 0, like 0.6"),
    ):
        if value is not None and not _positive(value):
            raise InputError("must be a finite number above 0", element=name, value=value, cure=cure)
    if not math.isfinite(crab):
        raise InputError("must be a finite number", element="crab", value=crab, cure="give an angle in rad")


def _positive(value: object) -> bool:
    number = isinstance(value, int | float | np.floating | np.integer) and not isinstance(value, bool)
    return number and math.isfinite(value) and value > 0  # type: ignore[arg-type, operator]
