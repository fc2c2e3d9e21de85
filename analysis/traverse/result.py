"""A traverse as an xarray Dataset with units and provenance, and as files."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from rover_pin.analysis.provenance import made_by, stands_how
from rover_pin.analysis.traverse.centres import centres
from rover_pin.analysis.traverse.path import total
from rover_pin.stability.measure import Standing

if TYPE_CHECKING:
    from rover_pin.analysis.traverse.step import Step
    from rover_pin.numerics import Array
    from rover_pin.rover import Rover
    from rover_pin.stability.measure import Measure
    from rover_pin.terrain import Terrain

STEP, WHEEL, JOINT, AXIS = "step", "wheel", "joint", "axis"


def as_dataset(
    rover: Rover,
    terrain: Terrain,
    points: Array,
    steps: Sequence[Step],
    measures: Sequence[Measure],
    how: Mapping[str, Any],
) -> xr.Dataset:
    """The Dataset of the steps in order."""
    drives = {wheel.drive for wheel in rover.wheels}
    joints = [name for name in rover.joints if name not in drives]
    variables = {
        **_places(rover, terrain, steps, joints),
        **_asked(rover, steps),
        **_margins(steps, measures, how["friction"]),
    }
    return xr.Dataset(
        variables,
        coords={WHEEL: [shape.name for shape in rover.shapes], JOINT: np.array(joints, dtype=str)},
        attrs=_attributes(rover, terrain, points, steps, measures, how),
    )


def _places(rover: Rover, terrain: Terrain, steps: Sequence[Step], joints: Sequence[str]) -> dict[str, Any]:
    """Where it is and how it stands; what is not known of a place without a stance is NaN."""
    at = [one.stood.place for one in steps]
    stances = [one.stood.stance for one in steps]
    known = np.array([stance.settled for stance in stances])
    pose = np.array([[s.position[2], s.rpy[0], s.rpy[1]] for s in stances])
    pose[~known] = np.nan
    turns = dict(zip(rover.dof_names, rover.turning, strict=True))
    values = np.array([[s.joints[name] for name in joints] for s in stances]).reshape(len(steps), len(joints))
    values[~known] = np.nan
    loads = [
        [s.loads.get(shape.name, 0.0) if s.settled else math.nan for shape in rover.shapes] for s in stances
    ]
    x, y = np.array([p.x for p in at]), np.array([p.y for p in at])
    middles = _centres(rover, steps)
    under = np.array(terrain.height(middles[..., 0], middles[..., 1]))
    lengths = ", ".join(name for name in joints if not turns[name])
    return {
        "way_m": _told([p.way for p in at], "driven since the first waypoint", "m"),
        "x_m": _told(x, "of the root link", "m"),
        "y_m": _told(y, "of the root link", "m"),
        "yaw_rad": _told([p.yaw for p in at], "heading of the root link", "rad"),
        "turning": _told([int(p.turning) for p in at], "1 where it turns on the spot"),
        "ground_m": _told(terrain.height(x, y), "height of the ground on the path", "m"),
        "z_m": _told(pose[:, 0], "of the root link", "m"),
        "roll_rad": _told(pose[:, 1], "of the root link", "rad"),
        "pitch_rad": _told(pose[:, 2], "of the root link", "rad"),
        "joint_rad": (
            (STEP, JOINT),
            values,
            {"units": "rad", "long_name": "places of joints that drive no wheel", "in_m": lengths},
        ),
        "wheel_m": ((STEP, WHEEL, AXIS), middles, _about("centres of wheels, world", "m")),
        "under_m": ((STEP, WHEEL), under, _about("height of the ground under wheels", "m")),
        "load_n": ((STEP, WHEEL), np.array(loads), _about("load against gravity", "N")),
        "status": _told([str(s.status) for s in stances], "how it stands"),
        "followed": _told(
            [int(one.stood.followed) for one in steps],
            "1 where found from the stance before, 0 where lowered",
        ),
    }


def _centres(rover: Rover, steps: Sequence[Step]) -> Array:
    """(steps, wheels, 3) m; NaN where there is no stance."""
    found = np.full((len(steps), len(rover.shapes), 3), np.nan)
    for k, one in enumerate(steps):
        if one.stood.stance.settled:
            found[k] = centres(rover, one.stood.stance.configuration)
    return found


def _asked(rover: Rover, steps: Sequence[Step]) -> dict[str, Any]:
    """Friction and torque, and what stops it."""
    torques = [
        [
            math.nan if one.torque is None else one.torque.edges.get(shape.name, math.nan)
            for shape in rover.shapes
        ]
        for one in steps
    ]
    declared = [float(shape.friction) for shape in rover.shapes]
    drives = {wheel.name: wheel.drive for wheel in rover.wheels if wheel.drive is not None}
    known = {name: float(rover.effort[rover.column[drive]]) for name, drive in drives.items()}
    efforts = [e if math.isfinite(e := known.get(s.name, math.nan)) else math.nan for s in rover.shapes]
    margins = [math.nan if one.friction is None else one.friction.value for one in steps]
    return {
        "friction_needed": _told([s.needed for s in steps], "least friction that holds it", "1"),
        "friction_margin": _told(margins, "friction that it can do without", "1"),
        "torque_needed": _told(
            [math.nan if s.torque is None else s.torque.value for s in steps],
            "least possible largest torque of a driven wheel, within the friction",
            "N m",
        ),
        "torque_nm": ((STEP, WHEEL), np.array(torques), _about("|torque| of wheels in those forces", "N m")),
        "effort_share": _told(
            [s.share for s in steps], "least possible largest share of a drive's effort", "1"
        ),
        "limit": _told([s.limit for s in steps], "what stops it here; empty where nothing"),
        "why": _told([s.why for s in steps], "in words"),
        "limiting": _told([s.limiting for s in steps], "wheel, joint or link"),
        "radius_m": (WHEEL, [s.ring + s.tread for s in rover.shapes], _about("of wheels and feet", "m")),
        "home_m": (
            (WHEEL, AXIS),
            centres(rover, rover.neutral),
            _about("centres in the root link's frame at home", "m"),
        ),
        "friction_declared": (WHEEL, declared, _about("coefficient that the shape declares", "1")),
        "effort_nm": (WHEEL, efforts, _about("the drive's effort; NaN where it has none", "N m")),
    }


def _margins(steps: Sequence[Step], measures: Sequence[Measure], friction: float | None) -> dict[str, Any]:
    """Every further measure; -inf or inf where it fails closed, NaN where the rover does not stand."""
    found: dict[str, Any] = {}
    for measure in measures:
        values, edges = [], []
        for one in steps:
            stance = one.stood.stance
            margin = measure.evaluate(Standing(stance, friction)) if stance.settled else None
            values.append(math.nan if margin is None else margin.value)
            edges.append("" if margin is None else margin.limiting or "")
        about = {"units": measure.unit, "better": measure.better, "long_name": measure.name}
        found[measure.name] = (STEP, values, about)
        found[f"{measure.name}_limiting"] = _told(edges, "edge that limits it")
    return found


def _told(values: Any, text: str, unit: str = "") -> tuple[str, Any, dict[str, str]]:
    return STEP, values, _about(text, unit)


def _about(text: str, unit: str = "") -> dict[str, str]:
    return {**({"units": unit} if unit else {}), "long_name": text}


def _attributes(
    rover: Rover,
    terrain: Terrain,
    points: Array,
    steps: Sequence[Step],
    measures: Sequence[Measure],
    how: Mapping[str, Any],
) -> dict[str, Any]:
    stop = next((one for one in steps if not one.passes), None)
    return {
        "title": f"{rover.name} along a path on {terrain.label}",
        **stands_how(rover, how["posture"], how["gravity"], how["joints"], how["locks"]),
        "friction": "as declared" if how["friction"] is None else float(how["friction"]),
        "terrain": terrain.label,
        "terrain_digest": terrain.digest,
        "path": ";".join(f"{x!r},{y!r}" for x, y in points.tolist()),
        "length_m": total(points),
        "step_m": float(how["step"]),
        "crab_rad": float(how["crab"]),
        "measures": ", ".join(measure.name for measure in measures),
        "passed": int(stop is None),
        "stop_m": math.nan if stop is None else stop.stood.place.way,
        "stop_limit": "" if stop is None else stop.limit,
        "stop_why": "" if stop is None else stop.why,
        "stop_at": "" if stop is None else stop.limiting,
        **made_by(),
    }
