"""traverse: a rover driven quasi-statically along a line."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.analysis.traverse.follow import Follower
from rover_pin.analysis.traverse.path import Place, Waypoints, check_on_map, places, waypoints
from rover_pin.analysis.traverse.result import as_dataset
from rover_pin.analysis.traverse.step import Step, ask
from rover_pin.errors import InputError
from rover_pin.stability.report import chosen
from rover_pin.statics.stance import Status

if TYPE_CHECKING:
    import xarray as xr

    from rover_pin.rover import Rover
    from rover_pin.terrain import Terrain

Progress = Callable[[int, int], None]
"""Called with the number of places passed and of all."""

TURNED = 0.2
"""rad: a contact's normal that turns further between two places is looked at more closely."""

DEPTH = 12
"""Halvings of a step where something changes at once."""

NOT_FOUND = str(Status.NO_CONVERGENCE)

ASIDE = (0.1, 0.3)
"""Where else to ask if a place has no answer, as shares of the way back to the one before."""


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
    friction is not enough, where drives would need more than the URDF's `effort`, or where it does not stand.

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


def driven(
    follower: Follower, along: list[Place], friction: float | None, progress: Progress | None = None
) -> Iterator[Step]:
    """Steps along places, closer where something changes at once."""
    last: Step | None = None
    for done, place in enumerate(along):
        if progress is not None:
            progress(done, len(along))
        if last is None:
            steps = iter([ask(follower.at(place, None), friction)])
        else:
            steps = _onto(follower, last, place, friction)
        for one in steps:
            last = one
            yield one
    if progress is not None:
        progress(len(along), len(along))


def _onto(follower: Follower, last: Step, place: Place, friction: float | None) -> Iterator[Step]:
    """From one place of the path to the next, and what lies between where the two differ much."""
    there = ask(follower.at(place, last.stood), friction)
    if there.limit == NOT_FOUND:
        there = _beside(follower, last, there, friction)
    between = list(_between(follower, last, there, friction, DEPTH))
    yield from between
    if between:  # by small steps it may come there otherwise than at once
        again = ask(follower.at(there.stood.place, between[-1].stood), friction)
        there = there if again.limit == NOT_FOUND else again
    yield there


def _between(follower: Follower, a: Step, b: Step, friction: float | None, depth: int) -> Iterator[Step]:
    """Halves of halves where something changes at once.

    A middle to which the solver finds no way from `a` is asked from `b`; one that has none from there either
    is passed over.
    """
    if not depth or NOT_FOUND in (a.limit, b.limit) or not _differ(a, b):
        return
    place = b.stood.place.towards(a.stood.place, 0.5)
    middle = ask(follower.at(place, a.stood), friction)
    if middle.limit == NOT_FOUND and b.stood.footing is not None:
        middle = ask(follower.at(place, b.stood), friction)
    if middle.limit == NOT_FOUND:
        return
    yield from _between(follower, a, middle, friction, depth - 1)
    yield middle
    yield from _between(follower, middle, b, friction, depth - 1)


def _beside(follower: Follower, last: Step, failed: Step, friction: float | None) -> Step:
    """A place a little before one that has no answer, where that has one."""
    for share in ASIDE:
        place = failed.stood.place.towards(last.stood.place, share)
        there = ask(follower.at(place, last.stood), friction)
        if there.limit != NOT_FOUND:
            return there
    return failed


def _differ(a: Step, b: Step) -> bool:
    """Whether something changed at once: a contact, the stance's existence, or from passing to what stops it.

    Where it has stopped by friction or torque and passes again nothing but contacts counts.
    """
    one, other = _normals(a), _normals(b)
    if a.limit != b.limit and (a.passes or not (one and other)):
        return True
    if not one or not other:
        return False
    return any(_apart(one.get(wheel), other.get(wheel)) for wheel in one.keys() | other.keys())


def _normals(step: Step) -> dict[str, list[Any]]:
    found: dict[str, list[Any]] = {}
    for contact in step.stood.stance.contacts:
        found.setdefault(contact.wheel, []).append(contact.normal)
    return found


def _apart(one: list[Any] | None, other: list[Any] | None) -> bool:
    """Whether a normal has none near it on the other side; a wheel that only lifts or lands has."""
    if one is None or other is None:
        return True
    cosines = np.array(one) @ np.array(other).T
    return bool(min(cosines.max(axis=0).min(), cosines.max(axis=1).min()) < math.cos(TURNED))


def unresolved(steps: Sequence[Step], length: float) -> float:
    """The longest way [m] over which something changes at once and no stance was found between; 0 where none.

    Friction or torque may be higher there than at both its ends.
    """
    finest = 1.01 * length / 2**DEPTH
    gaps = [b.stood.place.way - a.stood.place.way for a, b in pairwise(steps) if _differ(a, b)]
    return max((gap for gap in gaps if gap > finest), default=0.0)


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
