"""Wheels, feet and belly points of the sidecar, placed on the bodies of the model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from rover_pin.contact import Foot, Wheel
from rover_pin.description.geometry import BodyPoint
from rover_pin.description.notes import Notes
from rover_pin.description.prepare import Prepared
from rover_pin.description.sidecar import Sidecar
from rover_pin.description.specs import BellySpec, FootSpec, WheelSpec
from rover_pin.description.suspects import tell_undeclared_wheels
from rover_pin.errors import InputError, SidecarError
from rover_pin.mechanism.frames import find_frame
from rover_pin.numerics import Array, frozen

PARALLEL = 1e-6  # sine between the wheel's axis and the joint's
ON_AXIS = 1e-5  # m from the wheel's centre to the joint's axis


@dataclass(frozen=True)
class Touching:
    """What touches the ground, and what must not.

    Attributes:
        wheels, feet: in the sidecar's order.
        belly: points for clearance and grounding.
        wheel_links: links whose own shapes are wheels.
    """

    wheels: tuple[Wheel, ...]
    feet: tuple[Foot, ...]
    belly: tuple[BodyPoint, ...]
    wheel_links: frozenset[str]


@dataclass(frozen=True)
class Placer:
    """What is needed to place a shape.

    Attributes:
        model: Pinocchio's model.
        axes: per turning joint, its axis in its own frame.
        file: the sidecar, named in errors.
        notes: told of guesses.
    """

    model: pin.Model
    axes: Mapping[str, Array]
    file: object
    notes: Notes

    def place(self, sidecar: Sidecar, made: Prepared) -> Touching:
        """All that touches the ground or must not.

        Raises:
            SidecarError: an unknown frame, no axis to take, a name given twice, or a size that is no shape.
        """
        wheels, feet = self.wheels(sidecar.wheels), self.feet(sidecar.contacts)
        self._once([*(w.name for w in wheels), *(f.name for f in feet)])
        if not wheels and not feet:
            self.notes.add("no wheels nor contacts are declared: nothing touches the ground")
        tell_undeclared_wheels(made.tree, made.continuous, [w.link for w in wheels], self.notes)
        links = frozenset(
            link
            for spec, wheel in zip(sidecar.wheels, wheels, strict=True)
            for link in self._links(spec, wheel)
        )
        return Touching(wheels, feet, self.belly(sidecar.belly), links)

    def _links(self, spec: WheelSpec, wheel: Wheel) -> list[str]:
        """Links that are the wheel: all that turn with it; where it is rigid, its own if centred there."""
        if wheel.drive is None:
            return [] if any(spec.center) else [wheel.link]
        turning = self.model.getJointId(wheel.drive)
        bodies = (f for f in self.model.frames if f.type == pin.FrameType.BODY)
        return [str(f.name) for f in bodies if f.parentJoint == turning]

    def wheels(self, specs: Sequence[WheelSpec]) -> tuple[Wheel, ...]:
        """The declared wheels.

        Raises:
            SidecarError: an unknown frame, no axis to take, a name given twice, or a size that is no wheel.
        """
        return tuple(self._wheel(spec, f"wheels[{i}]") for i, spec in enumerate(specs))

    def feet(self, specs: Sequence[FootSpec]) -> tuple[Foot, ...]:
        """The declared feet.

        Raises:
            SidecarError: an unknown frame, or a name given twice.
        """
        feet = []
        for i, spec in enumerate(specs):
            frame = find_frame(self.model, spec.frame, file=self.file, element=f"contacts[{i}]")
            center = frame.placement.act(np.array(spec.center))
            link = self.link_of(frame)
            feet.append(
                Foot(
                    spec.name or spec.frame,
                    link,
                    int(frame.parentJoint),
                    frozen(center),
                    spec.radius,
                    spec.friction,
                )
            )
        return tuple(feet)

    def belly(self, specs: Sequence[BellySpec]) -> tuple[BodyPoint, ...]:
        """The declared belly points.

        Raises:
            SidecarError: an unknown frame.
        """
        points = []
        for i, spec in enumerate(specs):
            frame = find_frame(self.model, spec.frame, file=self.file, element=f"belly[{i}]")
            place = frozen(frame.placement.act(np.array(spec.point)))
            points.append(BodyPoint(self.link_of(frame), int(frame.parentJoint), place))
        return tuple(points)

    def link_of(self, frame: pin.Frame) -> str:
        """The link that a frame sits on: itself, or the link behind a joint."""
        if frame.type == pin.FrameType.BODY:
            return str(frame.name)
        own = self.model.getFrameId(frame.name, frame.type)
        for other in self.model.frames:
            if other.type == pin.FrameType.BODY and other.parentFrame == own:
                return str(other.name)
        return str(frame.name)

    def _wheel(self, spec: WheelSpec, element: str) -> Wheel:
        frame = find_frame(self.model, spec.frame, file=self.file, element=element)
        name = spec.name or spec.frame
        joint = int(frame.parentJoint)
        center = frame.placement.act(np.array(spec.center))
        turning = self.axes.get(self.model.names[joint])
        if spec.axis is not None:
            axis = frame.placement.rotation @ (np.array(spec.axis) / np.linalg.norm(spec.axis))
        elif turning is not None:
            axis = np.array(turning)
        else:
            raise SidecarError(
                "no turning joint right above it to take the axis from",
                file=self.file,
                element=element,
                value=spec.frame,
                cure="state its `axis`",
            )
        drive = None
        if turning is not None and _about(turning, axis, center):
            drive = str(self.model.names[joint])
            up = self.model.jointPlacements[joint]
            joint, center, axis = int(self.model.parents[joint]), up.act(center), up.rotation @ axis
        tread = {} if spec.tread is None else {"tread": spec.tread}
        width = spec.width
        if width is None:
            width = 2.0 * (spec.tread or 0.0)
            if spec.tread is None:
                self.notes.add(f"wheel {name}: neither width nor tread is stated; taken as a thin disc")
        try:
            return Wheel(
                name,
                self.link_of(frame),
                joint,
                frozen(center),
                frozen(axis),
                spec.radius,
                width,
                friction=spec.friction,
                free=spec.free,
                drive=drive,
                auxiliary=spec.auxiliary,
                **tread,
            )
        except InputError as error:
            raise SidecarError(
                error.what, file=self.file, element=element, value=error.value, cure=error.cure
            ) from error

    def _once(self, names: Sequence[str]) -> None:
        for i, name in enumerate(names):
            if name in names[:i]:
                raise SidecarError(
                    "two wheels or contacts bear one name",
                    file=self.file,
                    element="wheels",
                    value=name,
                    cure="give each its own `name`",
                )


def _about(turning: Array, axis: Array, center: Array) -> bool:
    """Whether a joint at the origin turns the wheel about the wheel's own axis."""
    parallel = np.linalg.norm(np.cross(turning, axis)) < PARALLEL
    return bool(parallel and np.linalg.norm(np.cross(turning, center)) < ON_AXIS)
