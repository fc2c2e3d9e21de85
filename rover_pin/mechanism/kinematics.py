"""One configuration of the Pinocchio model, with the points and Jacobians that elements ask for."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any, NamedTuple, TypeVar

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from rover_pin.mechanism.columns import to_columns
from rover_pin.numerics import Array

BASE = 6
"""Columns of the base: x, y, z, yaw, pitch, roll."""

FIRST_JOINT = 2
"""Pinocchio's id of the first moving joint: 0 is the universe, 1 the base."""


T = TypeVar("T")


class Columns(NamedTuple):
    """The tree as columns, one a coordinate; see `rover_pin.mechanism.columns`.

    Attributes:
        parent: (nv,) the column that a column hangs on, -1 of the first.
        turn: (nv, 3) axes, world; zero where a column slides.
        move: (nv, 3) velocity of the point of the column's body at `ref`.
        ref: (3,) m, world: the base's origin.
        scratch: (nv, 3).
    """

    parent: NDArray[np.int64]
    turn: Array
    move: Array
    ref: Array
    scratch: Array


def column_of(joint: int) -> int:
    """The last column of a joint's body; -1 of the universe."""
    return -1 if joint == 0 else BASE - 1 + joint - (FIRST_JOINT - 1)


class Kinematics:
    """Forward kinematics and joint Jacobians of `model` at `q`, computed once.

    The model's configuration is a plain vector (base as x, y, z and ZYX Euler angles), so that a Jacobian
    with respect to velocities is the derivative with respect to `q`.

    Args:
        model: Pinocchio model with nq == nv.
        data: its data; overwritten by the next `Kinematics` made with it.
        q: (nv,) configuration [m, rad].
    """

    def __init__(self, model: Any, data: Any, q: Array) -> None:
        self.model = model
        self.data = data
        self.q = q
        pin.computeJointJacobians(model, data, q)
        self._jacobians: dict[int, Array] = {}
        self._kept: dict[int, tuple[object, Any]] = {}

    def once(self, element: object, work_out: Callable[[], T]) -> T:
        """What an element works out at this configuration: once, however often it is asked."""
        kept = self._kept.get(id(element))
        if kept is None:
            kept = self._kept[id(element)] = element, work_out()  # kept too, so that its id stays its own
        found: T = kept[1]
        return found

    @cached_property
    def columns(self) -> Columns:
        """The tree as columns."""
        chain = [joint + BASE - FIRST_JOINT for joint in self.model.parents]  # as `column_of`
        chain[:FIRST_JOINT] = range(-1, BASE - 1)
        nv = self.model.nv
        turn, move, ref = np.empty((nv, 3)), np.empty((nv, 3)), np.array(self.q[:3])
        to_columns(self.data.J, ref, turn, move)
        return Columns(np.array(chain), turn, move, ref, np.empty((nv, 3)))

    def rotation(self, joint: int) -> Array:
        """(3, 3) rotation of the joint's frame in the world."""
        rotation: Array = self.data.oMi[joint].rotation
        return rotation

    def origin(self, joint: int) -> Array:
        """(3,) m, the joint frame's origin in the world."""
        origin: Array = self.data.oMi[joint].translation
        return origin

    @cached_property
    def placements(self) -> tuple[Array, Array]:
        """Rotations (joints, 3, 3) and origins (joints, 3) m of all joints' frames, world."""
        found = np.empty((self.model.njoints, 3, 3)), np.empty((self.model.njoints, 3))
        for rotation, origin, placement in zip(*found, self.data.oMi, strict=True):
            rotation[:] = placement.rotation
            origin[:] = placement.translation
        return found

    def point(self, joint: int, local: Array) -> Array:
        """(3,) m, world place of a point given in the joint's frame."""
        placement = self.data.oMi[joint]
        world: Array = placement.rotation @ local + placement.translation
        return world

    def point_rows(self, joint: int, local: Array) -> Array:
        """(p, 3) m, world places of points (p, 3) given in the joint's frame."""
        placement = self.data.oMi[joint]
        world: Array = local @ placement.rotation.T + placement.translation
        return world

    def joint_jacobian(self, joint: int) -> Array:
        """(6, nv) linear and angular rows of the joint frame's origin, along world axes."""
        found = self._jacobians.get(joint)
        if found is None:
            if joint == 0:
                found = np.zeros((6, self.model.nv))
            else:
                found = pin.getJointJacobian(self.model, self.data, joint, pin.LOCAL_WORLD_ALIGNED)
            self._jacobians[joint] = found
        return found

    def point_jacobian(self, joint: int, world: Array) -> Array:
        """(3, nv) velocity of the point of the joint's body that is now at `world`."""
        jacobian = self.joint_jacobian(joint)
        x, y, z = world - self.origin(joint)
        turning = jacobian[3:]
        result = jacobian[:3].copy()
        result[0] += z * turning[1] - y * turning[2]
        result[1] += x * turning[2] - z * turning[0]
        result[2] += y * turning[0] - x * turning[1]
        return result
