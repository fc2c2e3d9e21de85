"""A step in time, and how far wheels slid in it: measured from places, not from the rows that forbid it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pinocchio as pin

from rover_pin.errors import InputError
from rover_pin.kinematics.instant import Instant
from rover_pin.numerics import Array

if TYPE_CHECKING:
    from rover_pin.kinematics.instant import Bodies


def advance(at: Instant, velocity: Array, dt: float) -> Instant:
    """The instant dt later: q + v dt, the base's way over the ground turned by half of its yaw.

    So a rover that turns at a steady rate stays on its circle.

    Raises:
        InputError: a velocity of another shape, or with an entry that is not finite.
    """
    if velocity.shape != at.q.shape:
        raise InputError("a velocity has one entry a coordinate", element="v", value=velocity.shape)
    step = velocity * dt
    c, s = math.cos(0.5 * step[3]), math.sin(0.5 * step[3])
    step[0], step[1] = c * step[0] - s * step[1], s * step[0] + c * step[1]
    return at.bodies.at(at.q + step)


class Sliding:
    """How far every wheel slid since the start.

    A wheel that rolls lays as much of its rim on the ground as the place of contact moves over it. The
    place's motion in the world, less its motion on the wheel's body turned by the mean of its two
    orientations, is what slid: exact to third order in a step.

    Args:
        at: the start.
    """

    def __init__(self, at: Instant) -> None:
        self.bodies: Bodies = at.bodies
        self._last = self._looked(at)
        self.slid = np.zeros((len(at.bodies.names), 3))

    def step(self, at: Instant, lifted: tuple[str, ...] = ()) -> Array:
        """(s,) m: what each shape slid along the ground since the start; lifted ones add nothing."""
        points, rotations, locals_ = self._looked(at)
        old_points, old_rotations, old_locals = self._last
        standing = [i for i, name in enumerate(self.bodies.names) if name not in lifted]
        for i in standing:
            mean = old_rotations[i] @ pin.exp3(0.5 * pin.log3(old_rotations[i].T @ rotations[i]))
            moved = points[i] - old_points[i] - mean @ (locals_[i] - old_locals[i])
            normal = at.contacts[i, 4:7]
            self.slid[i] += moved - normal * float(normal @ moved)
        self._last = points, rotations, locals_
        return np.asarray(np.linalg.norm(self.slid, axis=1))

    def _looked(self, at: Instant) -> tuple[Array, Array, Array]:
        points = at.contacts[:, 1:4].copy()
        placed = at.placed
        joints = self.bodies.rolling_joints.tolist()
        rotations = np.array([placed[joint].rotation for joint in joints])
        origins = np.array([placed[joint].translation for joint in joints])
        return points, rotations, np.einsum("sji,sj->si", rotations, points - origins)
