"""Wheels, feet, belly points, loops and springs of many designs, placed as the loader places them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.compiled.design_places import (
    HERE,
    Place,
    across,
    behind,
    cross_norm,
    moved,
    norm,
    product,
    turn_of,
    turned,
)
from rover_pin.compiled.design_rows import Sheet
from rover_pin.compiled.design_tree import Seat, Walked, unit
from rover_pin.compiled.machine import FIRST_JOINT, Integers, integers
from rover_pin.description.shapes import ON_AXIS, PARALLEL
from rover_pin.description.sidecar import Sidecar
from rover_pin.description.specs import WheelSpec
from rover_pin.description.trace import UntraceableError
from rover_pin.mechanism import FrameSpringSpec
from rover_pin.mechanism.frames import FrameSpec
from rover_pin.numerics import Array

if TYPE_CHECKING:
    from rover_pin.contact import Wheel
    from rover_pin.rover import Rover


def seat_of(walked: Walked, name: str) -> Seat:
    """Where a named frame sits.

    Raises:
        UntraceableError: a frame of the model that is no link's nor joint's of the URDF.
    """
    found = walked.seat(name)
    if found is None:
        raise UntraceableError("a frame that is neither a link nor a joint of the URDF", element=name)
    return found


def wheel_links(rover: Rover, sidecar: Sidecar, walked: Walked, sheet: Sheet) -> frozenset[str]:
    """Links whose collision shapes are wheels, as `Placer` finds them; nominal ones."""
    links: set[str] = set()
    for i, (spec, wheel) in enumerate(zip(sidecar.wheels, rover.wheels, strict=True)):
        if wheel.drive is None:
            away = np.any(sheet.numbers(spec.center, "wheels", i, "center") != 0.0, axis=1)
            sheet.require(away == any(spec.center))
            links |= set() if any(spec.center) else {wheel.link}
        else:
            turning = rover.model.getJointId(wheel.drive)
            links |= {name for name, seat in walked.seats.items() if seat.joint == turning}
    return frozenset(links)


def touching(rover: Rover, sidecar: Sidecar, walked: Walked, sheet: Sheet) -> tuple[Array, Array]:
    """(n, s, 3) m centres and (n, s, 3) unit axes of wheels and feet, in their carriers' frames."""
    centers, axes = [], []
    for i, (spec, wheel) in enumerate(zip(sidecar.wheels, rover.wheels, strict=True)):
        center, axis = _wheel(spec, i, wheel, walked, sheet)
        centers.append(center)
        axes.append(axis)
    for i, (foot, shape) in enumerate(zip(sidecar.contacts, rover.feet, strict=True)):
        local = sheet.numbers(foot.center, "contacts", i, "center")
        centers.append(moved(seat_of(walked, foot.frame).place, local))
        axes.append(shape.axis[None])
    return sheet.stack(centers, 3), sheet.stack(axes, 3)


def _wheel(spec: WheelSpec, i: int, wheel: Wheel, walked: Walked, sheet: Sheet) -> tuple[Array, Array]:
    """Centre and axis; designs are left out whose joint turns it about itself where nominally it does not."""
    seat = seat_of(walked, spec.frame)
    center = moved(seat.place, sheet.numbers(spec.center, "wheels", i, "center"))
    joint = walked.joints.get(seat.joint)
    turning = None if joint is None or joint.sliding else joint.axis
    axis = turning
    if spec.axis is not None or axis is None:
        stated = sheet.numbers(spec.axis or (0.0, 0.0, 1.0), "wheels", i, "axis")
        axis = turned(seat.place[0], unit(sheet, stated))
    drives = np.zeros(1, dtype=bool)
    if turning is not None:
        drives = (cross_norm(turning, axis) < PARALLEL) & (cross_norm(turning, center) < ON_AXIS)
    sheet.require(drives == (wheel.drive is not None))
    if wheel.drive is not None and joint is not None:
        center, axis = moved(joint.place, center), turned(joint.place[0], axis)
    return center, unit(sheet, axis)


def belly(sidecar: Sidecar, walked: Walked, sheet: Sheet) -> tuple[Integers, Array]:
    """(b,) joints and (n, b, 3) m points."""
    seats = [seat_of(walked, spec.frame) for spec in sidecar.belly]
    points = [
        moved(seat.place, sheet.numbers(spec.point, "belly", i, "point"))
        for i, (seat, spec) in enumerate(zip(seats, sidecar.belly, strict=True))
    ]
    return integers(seat.joint for seat in seats), sheet.stack(points, 3)


def struts(sidecar: Sidecar, walked: Walked, sheet: Sheet) -> Array:
    """(n, f, 2, 3) m, ends of springs between frames."""
    ends = [
        [
            _frame(walked, sheet, frame, "springs", i, "frames", k).place[1]
            for k, frame in enumerate(spec.frames)
        ]
        for i, spec in enumerate(sidecar.springs)
        if isinstance(spec, FrameSpringSpec)
    ]
    return sheet.stack([sheet.stack(pair, 3) for pair in ends], 2, 3)


def loops(sidecar: Sidecar, walked: Walked, sheet: Sheet) -> dict[str, Any]:
    """Loops' frames, lengths and axes."""
    rotations, places, lengths, axes = [], [], [], []
    zero = _at_zero(walked) if any(spec.at == "zero" for spec in sidecar.loops) else {}
    for i, spec in enumerate(sidecar.loops):
        stated: Sequence[tuple[str | int, ...]] = (("frames", 0), ("frames", 1))
        if spec.type == "level":
            stated = (("frame",), ("frame",))
        first, second = (
            _frame(walked, sheet, frame, "loops", i, *path)
            for frame, path in zip(spec.frames, stated, strict=True)
        )
        axis = sheet.numbers(spec.axis or (0.0, 0.0, 1.0), "loops", i, "axis")
        length = sheet.number(spec.length or 0.0, "loops", i, "length")
        place = second.place
        if spec.at == "zero":
            here, there = (behind(zero[s.joint], s.place) for s in (first, second))
            if spec.type == "distance":
                length = norm(there[1] - here[1])
            else:
                place = _inside(zero[second.joint], here)
        rotations.append(sheet.stack([first.place[0], place[0]], 3, 3))
        places.append(sheet.stack([first.place[1], place[1]], 3))
        lengths.append(length)
        axes.append(across(unit(sheet, axis)))
    return {
        "loop_rotations": sheet.stack(rotations, 2, 3, 3),
        "loop_translations": sheet.stack(places, 2, 3),
        "loop_lengths": sheet.stack(lengths),
        "loop_across": sheet.stack(axes, 3, 3),
    }


def _frame(walked: Walked, sheet: Sheet, spec: str | FrameSpec, *path: str | int) -> Seat:
    if isinstance(spec, str):
        return seat_of(walked, spec)
    seat = seat_of(walked, spec.link)
    turn = turn_of(sheet, sheet.numbers(spec.rpy, *path, "rpy"))
    return Seat(seat.joint, behind(seat.place, (turn, sheet.numbers(spec.xyz, *path, "xyz"))))


def _at_zero(walked: Walked) -> dict[int, Place]:
    """Joints' frames with every joint and the base at zero."""
    places: dict[int, Place] = {FIRST_JOINT - 1: HERE}
    for joint in sorted(walked.joints):
        places[joint] = behind(places[walked.joints[joint].carrier], walked.joints[joint].place)
    return places


def _inside(frame: Place, place: Place) -> Place:
    """A place given in another's frame."""
    back = np.swapaxes(frame[0], 1, 2)
    return product(back, place[0]), turned(back, place[1] - frame[1])
