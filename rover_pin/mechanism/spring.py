"""Springs, on a joint or between two frames, with preload, rest length and stop."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field

from rover_pin.errors import MechanismError, SidecarError, nearest
from rover_pin.mechanism.bending import bend_strut
from rover_pin.mechanism.closure import push, torque
from rover_pin.mechanism.columns import strut
from rover_pin.mechanism.frames import BodyFrame, FrameSpec, resolve_pair
from rover_pin.mechanism.kinematics import Kinematics, column_of
from rover_pin.numerics import Array

Finite = Annotated[float, Field(allow_inf_nan=False)]
Stiffness = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]


class JointSpringSpec(BaseModel):
    """`{name: s, joint: bogie_l, stiffness: 40, rest: 0.1, preload: 2}`."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    name: str
    joint: str
    stiffness: Stiffness
    rest: Finite = 0.0
    preload: Finite = 0.0

    def resolve(self, columns: Mapping[str, int], *, file: object = None) -> JointSpring:
        """The spring on its configuration entry.

        Raises:
            SidecarError: a joint that the model does not have.
        """
        if self.joint not in columns:
            raise SidecarError(
                "no moving joint of this name",
                file=file,
                element=f"springs.{self.name}",
                value=self.joint,
                cure=nearest(self.joint, columns),
            )
        return JointSpring(
            self.name, self.joint, columns[self.joint], self.stiffness, self.rest, self.preload
        )


class FrameSpringSpec(BaseModel):
    """`{name: s, frames: [a, b], stiffness: 12000, preload: 60, length_max: 0.15}`."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    name: str
    frames: tuple[str | FrameSpec, str | FrameSpec]
    stiffness: Stiffness
    preload: Finite = 0.0
    length_max: Annotated[float, Field(gt=0.0, allow_inf_nan=False)]

    def resolve(self, model: Any, *, file: object = None) -> FrameSpring:
        """The spring between two places on the model's bodies.

        Raises:
            SidecarError: a frame that the model does not have, or both on one body.
        """
        element = f"springs.{self.name}"
        first, second = resolve_pair(model, self.frames, "ends", file=file, element=element)
        return FrameSpring(self.name, first, second, self.stiffness, self.preload, self.length_max)


SpringSpec = JointSpringSpec | FrameSpringSpec


@dataclass(frozen=True)
class JointSpring:
    """A spring on a joint: torque = preload - stiffness (q - rest).

    Attributes:
        name: as in the sidecar.
        joint: the joint's name.
        column: its entry in the configuration.
        stiffness: N m/rad (revolute) or N/m (prismatic).
        rest: rad or m.
        preload: N m or N.
    """

    name: str
    joint: str
    column: int
    stiffness: float
    rest: float
    preload: float

    def energy(self, at: Kinematics) -> float:
        """k (q - rest)^2 / 2 - preload (q - rest) [J]."""
        away = float(at.q[self.column]) - self.rest
        return 0.5 * self.stiffness * away * away - self.preload * away

    def effort(self, at: Kinematics) -> float:
        """The joint's torque [N m] or force [N], along +q."""
        return torque(float(at.q[self.column]), self.stiffness, self.rest, self.preload)

    def force(self, at: Kinematics) -> Array:
        """(nv,) generalised force."""
        result = np.zeros(at.model.nv)
        result[self.column] = self.effort(at)
        return result

    def bend(self, at: Kinematics, out: Array) -> None:
        """Add the stiffness to `out` (nv, nv)."""
        out[self.column, self.column] += self.stiffness


@dataclass(frozen=True)
class FrameSpring:
    """A spring that pushes two points apart up to a stop: force = preload + k (length_max - length).

    At `length_max` it stands on its stop, which carries the rest: the one-sided row length_max - length >= 0.

    Attributes:
        name: as in the sidecar.
        first, second: where its ends sit.
        stiffness: N/m.
        preload: N, the force at `length_max`.
        length_max: m.
    """

    name: str
    first: BodyFrame
    second: BodyFrame
    stiffness: float
    preload: float
    length_max: float

    def length(self, at: Kinematics) -> float:
        """Distance between the ends [m].

        Raises:
            MechanismError: the ends coincide, so that the spring has no direction.
        """
        return self._span(at)[0]

    def length_gradient(self, at: Kinematics) -> Array:
        """(nv,) d length / dq [m/rad or m/m]."""
        return self._span(at)[1]

    def _span(self, at: Kinematics) -> tuple[float, Array, Array]:
        """Length, its gradient, and the ends (2, 3) m, world."""
        return at.once(self, lambda: self._measure(at))

    def _measure(self, at: Kinematics) -> tuple[float, Array, Array]:
        gradient, points, tree = np.empty(at.model.nv), np.empty((2, 3)), at.columns
        rotations, origins = at.placements
        joints, ends, local = self._ends
        length = strut(
            tree.parent, tree.turn, tree.move, tree.ref, rotations, origins, joints, ends, local, points,
            gradient,
        )  # fmt: skip
        if length < 1e-9:
            raise MechanismError(
                "the spring's ends coincide, so it pushes in no direction",
                element=f"springs.{self.name}",
                value=length,
                cure="move one of its frames",
            )
        return length, gradient, points

    @cached_property
    def _ends(self) -> tuple[NDArray[np.int64], NDArray[np.int64], Array]:
        """Joints (2,), columns (2,) and places (2, 3) m of the ends."""
        frames = (self.first, self.second)
        return (
            np.array([frame.joint for frame in frames]),
            np.array([column_of(frame.joint) for frame in frames]),
            np.array([frame.translation for frame in frames]),
        )

    def effort(self, at: Kinematics) -> float:
        """The spring's push [N]."""
        return push(self.length(at), self.stiffness, self.preload, self.length_max)

    def energy(self, at: Kinematics) -> float:
        """preload d + k d^2 / 2 with d = length_max - length [J]."""
        short = self.length_max - self.length(at)
        return self.preload * short + 0.5 * self.stiffness * short * short

    def force(self, at: Kinematics) -> Array:
        """(nv,) generalised force."""
        return self.effort(at) * self.length_gradient(at)

    @property
    def kind(self) -> str:
        """`springs`."""
        return "springs"

    @property
    def impossible(self) -> tuple[str, str]:
        """Longer than its stop, wherever the joints go."""
        return (
            "the spring is longer than its length_max wherever the joints go",
            "give a greater length_max, or move its frames",
        )

    def slack(self, at: Kinematics) -> float:
        """length_max - length [m]."""
        return self.length_max - self.length(at)

    def slack_gradient(self, at: Kinematics) -> Array:
        """(nv,) minus the gradient of the length."""
        return -self.length_gradient(at)

    def bend(self, at: Kinematics, out: Array) -> None:
        """Add the second derivative of the energy to `out` (nv, nv)."""
        self._bend(at, self.effort(at), self.stiffness, out)

    def bend_slack(self, at: Kinematics, multiplier: float, out: Array) -> None:
        """Take multiplier times the second derivative of `slack` off `out` (nv, nv)."""
        self._bend(at, -multiplier, 0.0, out)

    def _bend(self, at: Kinematics, force: float, stiffness: float, out: Array) -> None:
        """Take the derivative of a push along the spring off `out`."""
        tree, points = at.columns, self._span(at)[2]
        bend_strut(
            tree.parent, tree.turn, tree.move, tree.ref, self._ends[1], points, force, stiffness,
            tree.scratch, out,
        )  # fmt: skip


Spring = JointSpring | FrameSpring
