"""Springs, sizes of wheels and tracks of many designs: numbers that stand in the sidecar alone."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.compiled.design_rows import Sheet
from rover_pin.description.sidecar import Sidecar
from rover_pin.mechanism import FrameSpringSpec, JointSpringSpec
from rover_pin.mechanism.track import PulleySpec, WrapSpec
from rover_pin.numerics import Array

if TYPE_CHECKING:
    from rover_pin.description.formulas import Path
    from rover_pin.rover import Rover

_FOLLOWED = {
    ("springs", "stiffness"), ("springs", "preload"), ("springs", "rest"), ("springs", "length_max"),
    ("springs", "frames", "xyz"), ("loops", "length"), ("loops", "frames", "xyz"), ("wheels", "center"),
    ("wheels", "radius"), ("wheels", "width"), ("wheels", "tread"), ("contacts", "center"),
    ("contacts", "radius"), ("belly", "point"), ("tracks", "length"), ("tracks", "wheels", "radius"),
}  # fmt: skip
"""Places of the sidecar whose formulas designs follow, without indices."""


def is_followed(path: Path) -> bool:
    """Whether designs follow a formula at this place of the sidecar."""
    return tuple(step for step in path if isinstance(step, str)) in _FOLLOWED


def check_sizes(sheet: Sheet) -> None:
    """Leave to the loader designs whose numbers it would refuse."""
    for path, numbers in sheet.stated.items():
        key = path[-1]
        if key in ("radius", "length", "length_max") and path[0] != "contacts":
            sheet.require(numbers > 0.0)
        elif key in ("radius", "width", "tread", "stiffness"):
            sheet.require(numbers >= 0.0)


def springs(sidecar: Sidecar, sheet: Sheet) -> dict[str, Any]:
    """(n, f, 3) and (n, k, 3) values of springs between frames and on joints."""
    struts, torsions = [], []
    for i, spec in enumerate(sidecar.springs):
        stiffness = sheet.number(spec.stiffness, "springs", i, "stiffness")
        preload = sheet.number(spec.preload, "springs", i, "preload")
        if isinstance(spec, FrameSpringSpec):
            longest = sheet.number(spec.length_max, "springs", i, "length_max")
            struts.append(np.stack(np.broadcast_arrays(stiffness, preload, longest), axis=1))
        elif isinstance(spec, JointSpringSpec):
            rest = sheet.number(spec.rest, "springs", i, "rest")
            torsions.append(np.stack(np.broadcast_arrays(stiffness, rest, preload), axis=1))
    return {"strut_values": sheet.stack(struts, 3), "torsion_values": sheet.stack(torsions, 3)}


def sizes(sidecar: Sidecar, sheet: Sheet) -> dict[str, Any]:
    """(n, s) rings and treads of wheels and feet, as `Wheel` and `Foot` take them from what is stated."""
    rings, treads = [], []
    for i, spec in enumerate(sidecar.wheels):
        radius = sheet.number(spec.radius, "wheels", i, "radius")
        width = sheet.number(_width(spec.width, spec.tread), "wheels", i, "width")
        tread = np.minimum(0.5 * width, radius)
        if spec.tread is not None:
            tread = sheet.number(spec.tread, "wheels", i, "tread")
        sheet.require(tread <= radius)
        rings.append(radius - tread)
        treads.append(tread)
    for i, foot in enumerate(sidecar.contacts):
        rings.append(np.zeros(1))
        treads.append(sheet.number(foot.radius, "contacts", i, "radius"))
    return {"rings": sheet.stack(rings), "treads": sheet.stack(treads)}


def tracks(rover: Rover, sidecar: Sidecar, centers: Array, sheet: Sheet) -> dict[str, Any]:
    """Tracks of many designs: circles in the nominal order, moved into the plane as nominally.

    Args:
        rover: the nominal one.
        sidecar: its sidecar.
        centers: (n, s, 3) m, of the shapes.
        sheet: numbers.
    """
    place = {wheel.name: k for k, wheel in enumerate(rover.wheels)}
    lengths, rhos, middles = [], [], []
    for t, (spec, track) in enumerate(zip(sidecar.tracks, rover.tracks, strict=True)):
        lengths.append(sheet.number(spec.length, "tracks", t, "length"))
        stated = {_circle_of(entry): i for i, entry in enumerate(spec.wheels)}
        for circle in track.circles:
            i = stated[circle.name]
            radius = _radius(sidecar, place, spec.wheels[i], sheet, "tracks", t, "wheels", i)
            rhos.append(np.copysign(radius, circle.rho))
            middle = circle.center[None]
            if circle.wheel:
                k = place[circle.name]
                middle = centers[:, k] + (circle.center - rover.wheels[k].center)
            middles.append(middle)
    return {
        "track_lengths": sheet.stack(lengths),
        "track_rho": sheet.stack(rhos),
        "track_centers": sheet.stack(middles, 3),
        "track_axes": sheet.stack([track.axes[None] for track in rover.tracks], 3, 3),
    }


def _circle_of(entry: str | WrapSpec | PulleySpec) -> str:
    """The name of a circle."""
    if isinstance(entry, str):
        return entry
    return entry.frame if isinstance(entry, PulleySpec) else entry.wheel


def _radius(
    sidecar: Sidecar, place: Mapping[str, int], entry: str | WrapSpec | PulleySpec, sheet: Sheet,
    *path: str | int,
) -> Array:  # fmt: skip
    """(n,) or (1,) m, the radius on which the cable runs."""
    if not isinstance(entry, str) and entry.radius is not None:
        return sheet.number(entry.radius, *path, "radius")
    k = place[_circle_of(entry)]
    return sheet.number(sidecar.wheels[k].radius, "wheels", k, "radius")


def _width(width: float | None, tread: float | None) -> float:
    """A wheel's width where it may be silent, as `Placer` takes it."""
    return 2.0 * (tread or 0.0) if width is None else width
