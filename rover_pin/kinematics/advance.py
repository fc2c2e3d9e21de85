"""A step in time, and how far wheels slid in it: measured from places, not from the rows that forbid it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

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

    Attributes:
        slid: (s, 3) m, world: along the ground, since the start.
    """

    def __init__(self, at: Instant) -> None:
        self.bodies: Bodies = at.bodies
        self.slid = np.zeros((len(at.bodies.names), 3))
        self._last = self._look(at)
        self._standing: dict[tuple[str, ...], Array] = {}

    def step(self, at: Instant, lifted: tuple[str, ...] = ()) -> Array:
        """(s,) m: what each shape slid along the ground since the start; lifted ones add nothing."""
        if lifted not in self._standing:
            stands = [name not in lifted for name in self.bodies.names]
            self._standing[lifted] = np.array(stands, dtype=np.float64)[:, None]
        points, rotations, on_body = self._look(at)
        before, turned, was = self._last
        moved = points - before - np.einsum("sij,sj->si", 0.5 * (turned + rotations), on_body - was)
        normals = at.contacts[:, 4:7]
        moved -= normals * np.einsum("sj,sj->s", normals, moved)[:, None]
        self.slid += moved * self._standing[lifted]
        self._last = points, rotations, on_body
        return np.asarray(np.linalg.norm(self.slid, axis=1))

    def _look(self, at: Instant) -> tuple[Array, Array, Array]:
        """Places of contact (s, 3) m, orientations (s, 3, 3) of the bodies that touch, the places on them."""
        points, placed = at.contacts[:, 1:4], at.placed
        frames = np.array([placed[joint].homogeneous for joint in self.bodies.rolling_joints.tolist()])
        rotations = frames[:, :3, :3]
        return points, rotations, np.einsum("sji,sj->si", rotations, points - frames[:, :3, 3])
