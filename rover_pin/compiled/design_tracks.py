"""Tracks of many designs: circles in the plane of the first, as `TrackSpec.resolve` puts them there."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from rover_pin.compiled.design_parts import seat_of
from rover_pin.compiled.design_places import across, cross_norm, moved, turned
from rover_pin.compiled.design_rows import Flags, Sheet
from rover_pin.compiled.design_tree import Walked, unit
from rover_pin.compiled.machine import FIRST_JOINT, Machine
from rover_pin.compiled.pose import home_of
from rover_pin.compiled.posed import Placed, merge
from rover_pin.description.sidecar import Sidecar
from rover_pin.mechanism import TrackSpec
from rover_pin.mechanism.cable import taut
from rover_pin.mechanism.track import PARALLEL, PulleySpec, WrapSpec
from rover_pin.numerics import Array

if TYPE_CHECKING:
    from rover_pin.mechanism import Track
    from rover_pin.rover import Rover


class _Round(NamedTuple):
    """A circle as stated: (n, 3) m centre and (n, 3) unit axis in its joint's frame, (n,) signed radius."""

    name: str
    joint: int
    center: Array
    axis: Array
    rho: Array


def tracks(rover: Rover, sidecar: Sidecar, machine: Machine, walked: Walked, sheet: Sheet) -> dict[str, Any]:
    """The arrays of tracks; designs are left out whose tracks the loader refuses or runs the other way.

    Args:
        rover: the nominal one.
        sidecar: its sidecar.
        machine: n designs, all but their tracks.
        walked: where frames sit.
        sheet: numbers.
    """
    placed = merge(machine, home_of(rover, machine), ())[0] if sidecar.tracks else ()
    lengths, rhos, middles, planes = [], [], [], []
    for t, (spec, track) in enumerate(zip(sidecar.tracks, rover.tracks, strict=True)):
        lengths.append(sheet.number(spec.length, "tracks", t, "length"))
        found = list(_rounds(rover, sidecar, spec, t, machine, walked, sheet))
        circles, axes = _flattened(found, track, machine, placed, sheet)
        rhos += [circle.rho for circle in circles]
        middles += [circle.center for circle in circles]
        planes.append(axes)
    return {
        "track_lengths": sheet.stack(lengths),
        "track_rho": sheet.stack(rhos),
        "track_centers": sheet.stack(middles, 3),
        "track_axes": sheet.stack(planes, 3, 3),
    }


def _rounds(
    rover: Rover, sidecar: Sidecar, spec: TrackSpec, t: int, machine: Machine, walked: Walked, sheet: Sheet
) -> Iterator[_Round]:
    """The circles in the order of the sidecar."""
    place = {wheel.name: k for k, wheel in enumerate(rover.wheels)}
    for i, entry in enumerate(spec.wheels):
        path: tuple[str | int, ...] = ("tracks", t, "wheels", i)
        if isinstance(entry, PulleySpec):
            seat = seat_of(walked, entry.frame)
            center = moved(seat.place, sheet.numbers(entry.center, *path, "center"))
            axis = turned(seat.place[0], unit(sheet, sheet.numbers(entry.axis, *path, "axis")))
            radius = sheet.number(entry.radius, *path, "radius")
            yield _Round(entry.frame, seat.joint, center, axis, _signed(radius, entry.side))
            continue
        stated = WrapSpec(wheel=entry) if isinstance(entry, str) else entry
        k = place[stated.wheel]
        radius = sheet.number(sidecar.wheels[k].radius, "wheels", k, "radius")
        if stated.radius is not None:
            radius = sheet.number(stated.radius, *path, "radius")
        yield _Round(
            stated.wheel,
            int(machine.shape_joints[k]),
            machine.centers[:, k],
            machine.shape_axes[:, k],
            _signed(radius, stated.side),
        )


def _signed(radius: Array, side: str) -> Array:
    return radius if side == "inside" else -radius


def _flattened(
    rounds: Sequence[_Round], track: Track, machine: Machine, placed: Sequence[Placed], sheet: Sheet
) -> tuple[list[_Round], Array]:
    """Circles moved along their axes into the plane of the first, in the nominal order; the plane's axes."""
    first = rounds[0]
    axes = across(first.axis)
    plane = placed[first.joint].rotation @ axes
    normal = plane[:, :, 2]
    origin = _at(placed, first)
    circles = []
    for one in rounds:
        rotation = placed[one.joint].rotation
        sheet.require(cross_norm(turned(rotation, one.axis), normal) <= PARALLEL)
        _stay_in_plane(one, first, normal, machine, placed, sheet)
        away = _dot(normal, _at(placed, one) - origin)
        back = turned(np.swapaxes(rotation, 1, 2), normal)
        circles.append(one._replace(center=one.center - away[:, None] * back))
    around = [circle.name for circle in track.circles] != [one.name for one in rounds]
    flat = _flat(circles, plane, placed)
    sheet.require((_area(flat) < 0.0) == around)
    if around:
        circles.reverse()
        axes = axes[:, :, [1, 0, 2]] * np.array([1.0, 1.0, -1.0])
        flat = flat[:, ::-1, ::-1]
    _run_around(flat, sheet.stack([circle.rho for circle in circles]), sheet)
    return circles, axes


def _at(placed: Sequence[Placed], one: _Round) -> Array:
    """(n, 3) m, a circle's centre at home."""
    joint = placed[one.joint]
    return moved((joint.rotation, joint.origin), one.center)


def _flat(circles: Sequence[_Round], plane: Array, placed: Sequence[Placed]) -> Array:
    """(n, c, 2) m, centres in the plane."""
    places = np.stack(np.broadcast_arrays(*(_at(placed, one) for one in circles)), axis=1)
    flat: Array = places @ plane[:, :, :2]
    return flat


def _stay_in_plane(
    one: _Round, first: _Round, normal: Array, machine: Machine, placed: Sequence[Placed], sheet: Sheet
) -> None:
    """Leave out designs in which a joint between two circles moves one out of the plane."""
    above, others = _above(machine, one.joint), _above(machine, first.joint)
    for joint in above ^ others:
        axis = turned(placed[joint].rotation, machine.axes[:, joint])
        motion = axis
        if machine.turning[joint]:
            sheet.require(cross_norm(axis, normal) <= PARALLEL)
            lever = _at(placed, one if joint in above else first) - placed[joint].origin
            motion = np.cross(axis, lever)
        sheet.require(np.abs(_dot(motion, normal)) <= PARALLEL)


def _above(machine: Machine, joint: int) -> set[int]:
    """A joint and those that carry it, without the base."""
    found = set()
    while joint >= FIRST_JOINT:
        found.add(joint)
        joint = int(machine.parents[joint])
    return found


def _run_around(flat: Array, rho: Array, sheet: Sheet) -> None:
    """Leave out designs whose cable cannot run around its circles, as `Track` checks it.

    Args:
        flat: (n, c, 2) m, centres in the plane, counter-clockwise.
        rho: (n, c) m, signed radii.
        sheet: told.
    """
    count = flat.shape[1]
    size = np.abs(rho)
    for a in range(count):
        for b in range(count):
            apart = np.hypot(*(flat[:, a] - flat[:, b]).T)
            same = rho[:, a] * rho[:, b] > 0.0
            if a != b:
                sheet.require(~same | (apart + size[:, a] > size[:, b]))
            if a < b:
                sheet.require(same | (apart > size[:, a] + size[:, b]))
    sheet.require(~_crosses(flat))
    following = np.empty(count, dtype=np.int64)
    spans, turns = np.zeros((count, 3)), np.zeros(count)
    for i in np.flatnonzero(sheet.valid & np.any(rho < 0.0, axis=1)):
        sheet.valid[i] &= np.isfinite(taut(flat[i].copy(), rho[i], following, spans, turns))


def _crosses(places: Array) -> Flags:
    """(n,) whether two sides of closed polygons (n, c, 2) cross each other."""
    following = np.roll(places, -1, axis=1)
    count = places.shape[1]
    crossed = np.zeros(len(places), dtype=bool)
    for i in range(count):
        for j in range(i + 2, count - (i == 0)):
            one, other = (places[:, i], following[:, i]), (places[:, j], following[:, j])
            crossed |= (_side(*one, other[0]) * _side(*one, other[1]) < 0.0) & (
                _side(*other, one[0]) * _side(*other, one[1]) < 0.0
            )
    return crossed


def _side(start: Array, end: Array, point: Array) -> Array:
    """(n,) twice the area of triangles, positive counter-clockwise."""
    a, b = end - start, point - start
    area: Array = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return area


def _area(places: Array) -> Array:
    """(n,) signed area of polygons (n, c, 2), positive counter-clockwise."""
    following = np.roll(places, -1, axis=1)
    cross = places[:, :, 0] * following[:, :, 1] - places[:, :, 1] * following[:, :, 0]
    area: Array = 0.5 * cross.sum(axis=1)
    return area


def _dot(a: Array, b: Array) -> Array:
    dot: Array = np.sum(a * b, axis=1)
    return dot
