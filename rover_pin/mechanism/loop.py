"""Closed loops: two frames of the tree that meet as by a ball, a hinge, a pin in a plane, a weld or a rod.

And what holds a frame to the world in the same way: an axis that stays level.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal

import numpy as np
import pinocchio as pin
from pydantic import BaseModel, ConfigDict, Field, model_validator

from rover_pin.mechanism.closure import SIZES, close
from rover_pin.mechanism.closure_bending import bend_loop
from rover_pin.mechanism.frames import BodyFrame, FrameSpec, resolve_pair
from rover_pin.mechanism.kinematics import Kinematics, column_of
from rover_pin.numerics import Array, frozen

LoopType = Literal["ball", "hinge", "planar", "weld", "distance", "level"]
Finite = Annotated[float, Field(allow_inf_nan=False)]

KINDS: tuple[LoopType, ...] = ("ball", "hinge", "planar", "weld", "distance", "level")
"""Types in the order of `rover_pin.mechanism.closure`."""


class LoopSpec(BaseModel):
    """`{name: left_link, frames: [bar_l, rocker_l], type: ball}`; also axis, length, at, tolerance.

    A level loop has one frame: `{name: symmetry, type: level, frame: base_link, axis: [0, 1, 0]}`.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    name: str
    frames: tuple[str | FrameSpec, str | FrameSpec]
    type: LoopType = "ball"
    axis: tuple[Finite, Finite, Finite] | None = None
    length: Annotated[float, Field(gt=0.0, allow_inf_nan=False)] | None = None
    at: Literal["zero"] | None = None
    tolerance: Annotated[float, Field(gt=0.0, allow_inf_nan=False)] = 1e-6

    @model_validator(mode="before")
    @classmethod
    def _of_one_frame(cls, data: Any) -> Any:
        if not isinstance(data, dict):
            return data
        level = data.get("type") == "level"
        if level and ("frames" in data or "frame" not in data):
            raise ValueError("a level loop has one `frame`, and no `frames`")
        if not level and "frame" in data:
            raise ValueError("only a level loop has one `frame`; name two `frames`")
        if level:
            data = {**data, "frames": (data["frame"], data["frame"])}
            del data["frame"]
        return data

    @model_validator(mode="after")
    def _complete(self) -> LoopSpec:
        needs_axis = self.type in ("hinge", "planar", "level")
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
        if self.type == "level":
            spec = self.frames[0]
            frame = FrameSpec(link=spec) if isinstance(spec, str) else spec
            first = second = frame.resolve(model, file=file, element=element)
        else:
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
    """Two frames held together; `rover_pin.mechanism.closure.close` has the rows.

    A planar loop has two, so that a linkage that moves in a plane is closed without redundant rows; a weld's
    rows of orientation are 2 sin(angle / 2) along the axis, so that a half turn is open.

    Attributes:
        name: as in the sidecar.
        type: one of ball, hinge, planar, weld, distance, level.
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
        return SIZES[KINDS.index(self.type)]

    def residual(self, at: Kinematics) -> Array:
        """(size,) [m; rad for rows of orientation]."""
        return self._rows(at)[0]

    def jacobian(self, at: Kinematics) -> Array:
        """(size, nv)."""
        return self._rows(at)[1]

    def bend(self, at: Kinematics, multipliers: Array, out: Array) -> None:
        """Take the sum of multipliers (size,) times second derivatives of the residual off `out` (nv, nv)."""
        frames = (self.first, self.second)
        tree = at.columns
        bend_loop(
            KINDS.index(self.type), self.across, tree.parent, tree.turn, tree.move, tree.ref,
            np.array([column_of(frame.joint) for frame in frames]),
            np.array([frame.origin(at) for frame in frames]),
            np.array([frame.axes(at) for frame in frames]), multipliers, tree.scratch, out,
        )  # fmt: skip

    def _rows(self, at: Kinematics) -> tuple[Array, Array]:
        """Residual and Jacobian."""
        return at.once(self, lambda: self._close(at))

    def _close(self, at: Kinematics) -> tuple[Array, Array]:
        residual, jacobian = np.empty(self.size), np.empty((self.size, at.model.nv))
        first = self.first.origin(at), self.first.axes(at), self.first.jacobian(at)
        second = first
        if self.second is not self.first:
            second = self.second.origin(at), self.second.axes(at), self.second.jacobian(at)
        close(KINDS.index(self.type), self.across, self.length, *first, *second, residual, jacobian)
        return residual, jacobian


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
