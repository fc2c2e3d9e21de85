"""Closed loops: two frames of the tree that meet as by a ball, a hinge, a pin in a plane, a weld or a rod."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal

import numpy as np
import pinocchio as pin
from pydantic import BaseModel, ConfigDict, Field, model_validator

from rover_pin.mechanism.frames import BodyFrame, FrameSpec, resolve_pair
from rover_pin.mechanism.kinematics import Kinematics
from rover_pin.numerics import Array, frozen

LoopType = Literal["ball", "hinge", "planar", "weld", "distance"]
Finite = Annotated[float, Field(allow_inf_nan=False)]

_SIZES: dict[str, int] = {"ball": 3, "hinge": 5, "planar": 2, "weld": 6, "distance": 1}


class LoopSpec(BaseModel):
    """`{name: left_link, frames: [bar_l, rocker_l], type: ball}`; also axis, length, at, tolerance."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    name: str
    frames: tuple[str | FrameSpec, str | FrameSpec]
    type: LoopType = "ball"
    axis: tuple[Finite, Finite, Finite] | None = None
    length: Annotated[float, Field(gt=0.0, allow_inf_nan=False)] | None = None
    at: Literal["zero"] | None = None
    tolerance: Annotated[float, Field(gt=0.0, allow_inf_nan=False)] = 1e-6

    @model_validator(mode="after")
    def _complete(self) -> LoopSpec:
        needs_axis = self.type in ("hinge", "planar")
        if needs_axis and self.axis is None:
            raise ValueError(f"a {self.type} loop needs `axis`, in the first frame")
        if not needs_axis and self.axis is not None:
            raise ValueError(f"a {self.type} loop has no `axis`")
        if self.axis is not None and np.linalg.norm(self.axis) < 1e-9:
            raise ValueError("`axis` is zero")
        if self.type == "distance" and self.length is None and self.at is None:
            raise ValueError("a distance loop needs `length` (or `at: zero`)")
        if self.length is not None and self.at is not None:
            raise ValueError("`length` and `at: zero` both say the distance: give one")
        if self.type != "distance" and self.length is not None:
            raise ValueError(f"a {self.type} loop has no `length`")
        return self

    def resolve(self, model: Any, *, file: object = None) -> Loop:
        """The loop between two places on the model's bodies.

        Raises:
            SidecarError: a frame that the model does not have, or both on one body.
        """
        element = f"loops.{self.name}"
        first, second = resolve_pair(model, self.frames, "frames", file=file, element=element)
        length = self.length or 0.0
        if self.at == "zero":
            zero = Kinematics(model, model.createData(), np.zeros(model.nv))
            if self.type == "distance":
                length = float(np.linalg.norm(second.origin(zero) - first.origin(zero)))
            else:
                second = _carried(first, second, zero)
        axis = np.array(self.axis if self.axis is not None else (0.0, 0.0, 1.0))
        across = _across(axis / np.linalg.norm(axis))
        return Loop(self.name, self.type, first, second, frozen(across), length, self.tolerance)


@dataclass(frozen=True)
class Loop:
    """Two frames held together; e = origin of the second minus that of the first.

    Rows: ball e (world axes); planar t1.e and t2.e, with t1, t2 across the axis in the first frame, so that a
    linkage that moves in a plane is closed without redundant rows; hinge the ball's rows and a.t1', a.t2'
    with a the axis in the first frame and t1', t2' across the same axis in the second; weld e and twice the
    vector part of the quaternion of R1' R2 (2 sin(angle / 2) along the axis, so that a half turn is open);
    distance |e| - length.

    Attributes:
        name: as in the sidecar.
        type: one of ball, hinge, planar, weld, distance.
        first, second: the frames.
        across: (3, 3) columns t1, t2 and the axis, in a frame's coordinates.
        length: m, of a distance loop.
        tolerance: m, what counts as closed.
    """

    name: str
    type: LoopType
    first: BodyFrame
    second: BodyFrame
    across: Array
    length: float
    tolerance: float

    @property
    def size(self) -> int:
        """Number of rows."""
        return _SIZES[self.type]

    def residual(self, at: Kinematics) -> Array:
        """(size,) [m; rad for rows of orientation]."""
        apart = self.second.origin(at) - self.first.origin(at)
        if self.type == "ball":
            return apart
        if self.type == "distance":
            return np.array([np.linalg.norm(apart) - self.length])
        if self.type == "planar":
            sides: Array = (self.first.axes(at) @ self.across[:, :2]).T @ apart
            return sides
        if self.type == "hinge":
            axis = self.first.axes(at) @ self.across[:, 2]
            return np.concatenate([apart, (self.second.axes(at) @ self.across[:, :2]).T @ axis])
        return np.concatenate([apart, 2.0 * self._turned(at)[1:]])

    def _turned(self, at: Kinematics) -> Array:
        """(4,) quaternion (w >= 0, x, y, z) of the second frame in the first."""
        x, y, z, w = pin.Quaternion(self.first.axes(at).T @ self.second.axes(at)).coeffs()
        return np.array([w, x, y, z]) if w >= 0.0 else -np.array([w, x, y, z])

    def jacobian(self, at: Kinematics) -> Array:
        """(size, nv)."""
        apart = self.second.origin(at) - self.first.origin(at)
        moving: Array = self.second.origin_jacobian(at) - self.first.origin_jacobian(at)
        if self.type == "ball":
            return moving
        if self.type == "distance":
            length = max(float(np.linalg.norm(apart)), 1e-12)
            return (apart / length @ moving)[None, :]
        turn_first = at.angular_jacobian(self.first.joint)
        if self.type == "planar":
            sides = (self.first.axes(at) @ self.across[:, :2]).T
            planar: Array = sides @ moving + np.cross(sides, apart) @ turn_first
            return planar
        turn: Array = at.angular_jacobian(self.second.joint) - turn_first
        if self.type == "hinge":
            axis = self.first.axes(at) @ self.across[:, 2]
            sides = (self.second.axes(at) @ self.across[:, :2]).T
            return np.vstack([moving, np.cross(sides, axis) @ turn])
        w, x, y, z = self._turned(at)
        # quaternion' = quaternion * (0, angular velocity in the second frame) / 2
        lever = np.array([[w, -z, y], [z, w, -x], [-y, x, w]])
        return np.vstack([moving, lever @ self.second.axes(at).T @ turn])


def _carried(first: BodyFrame, second: BodyFrame, zero: Kinematics) -> BodyFrame:
    """The first frame as it stands at zero, fixed to the second frame's body."""
    body = pin.SE3(zero.rotation(second.joint), zero.origin(second.joint))
    stands = pin.SE3(first.axes(zero), first.origin(zero))
    local = body.inverse() * stands
    return BodyFrame(second.joint, frozen(local.rotation), frozen(local.translation), second.label)


def _across(axis: Array) -> Array:
    """(3, 3) columns: two unit vectors across `axis`, and `axis`."""
    helper = np.eye(3)[int(np.argmin(np.abs(axis)))]
    first = np.cross(axis, helper)
    first /= np.linalg.norm(first)
    return np.column_stack([first, np.cross(axis, first), axis])
