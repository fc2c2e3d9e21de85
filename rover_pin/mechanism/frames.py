"""Frames named in a sidecar, and the same frames fixed to a joint's body."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import pinocchio as pin
from pydantic import BaseModel, ConfigDict, field_validator

from rover_pin.errors import SidecarError, nearest
from rover_pin.mechanism.columns import frame_rows
from rover_pin.mechanism.kinematics import Kinematics, column_of
from rover_pin.numerics import Array, frozen


class FrameSpec(BaseModel):
    """A frame of the sidecar: a link's or joint's name, or `{link: L, xyz: [..], rpy: [..]}`."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    link: str
    xyz: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rpy: tuple[float, float, float] = (0.0, 0.0, 0.0)

    @field_validator("xyz", "rpy")
    @classmethod
    def _finite(cls, value: tuple[float, float, float]) -> tuple[float, float, float]:
        if not all(math.isfinite(number) for number in value):
            raise ValueError("numbers must be finite")
        return value

    def resolve(self, model: Any, *, file: object = None, element: str | None = None) -> BodyFrame:
        """The frame as a fixed place on a body of `model`.

        Raises:
            SidecarError: the model has no link or joint of that name.
        """
        base = find_frame(model, self.link, file=file, element=element)
        offset = pin.SE3(pin.rpy.rpyToMatrix(*self.rpy), np.array(self.xyz))
        placement = base.placement * offset
        return BodyFrame(
            base.parentJoint, frozen(placement.rotation), frozen(placement.translation), self.link
        )


@dataclass(frozen=True)
class BodyFrame:
    """A frame fixed to the body of a joint.

    Attributes:
        joint: Pinocchio's id of the joint.
        rotation: (3, 3) of the frame in the joint's frame.
        translation: (3,) m, its origin in the joint's frame.
        label: the link or joint it was named by.
    """

    joint: int
    rotation: Array
    translation: Array
    label: str

    def origin(self, at: Kinematics) -> Array:
        """(3,) m, world."""
        return at.point(self.joint, self.translation)

    def axes(self, at: Kinematics) -> Array:
        """(3, 3) rotation in the world."""
        axes: Array = at.rotation(self.joint) @ self.rotation
        return axes

    def jacobian(self, at: Kinematics) -> Array:
        """(6, nv) velocity of the origin, then angular velocity, world axes."""
        tree, out = at.columns, np.empty((6, at.model.nv))
        frame_rows(
            tree.parent, tree.turn, tree.move, tree.ref, column_of(self.joint), self.origin(at), out
        )  # fmt: skip
        return out


def resolve_pair(
    model: Any, specs: tuple[str | FrameSpec, str | FrameSpec], called: str, *, file: object, element: str
) -> tuple[BodyFrame, BodyFrame]:
    """Two frames of `model` that sit on different bodies.

    Args:
        model: Pinocchio's model.
        specs: the frames, as in the sidecar.
        called: what they are called in the message (`frames`, `ends`).
        file: the sidecar.
        element: the element of it that names them.

    Raises:
        SidecarError: a frame that the model does not have, or both on one body.
    """
    first, second = (
        (FrameSpec(link=spec) if isinstance(spec, str) else spec).resolve(model, file=file, element=element)
        for spec in specs
    )
    if first.joint == second.joint:
        raise SidecarError(
            f"both {called} sit on one body",
            file=file,
            element=element,
            value=f"{first.label}, {second.label}",
            cure="name frames on two bodies that move against each other",
        )
    return first, second


def find_frame(model: Any, name: str, *, file: object = None, element: str | None = None) -> Any:
    """Pinocchio's frame of a link, else of a joint, by name.

    Raises:
        SidecarError: there is none; the message names the nearest.
    """
    for kind in (pin.FrameType.BODY, pin.FrameType.JOINT, pin.FrameType.FIXED_JOINT):
        if model.existFrame(name, kind):
            return model.frames[model.getFrameId(name, kind)]
    known = [frame.name for frame in model.frames if frame.name not in ("universe", "root_joint")]
    raise SidecarError(
        "no link or joint of this name", file=file, element=element, value=name, cure=nearest(name, known)
    )
