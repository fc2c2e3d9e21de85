"""A step in time, and how far wheels slid in it: measured from places, not from the rows that forbid it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.errors import InputError
from rover_pin.kinematics.instant import Instant
from rover_pin.numerics import Array, cross

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

    A wheel that rolls lays as much of its rim on the ground as its centre moves over it. The centre's motion,
    and the wheel's turn times the lever from centre to place of contact (the mean of before and after), make
    what slid: from two places, exact for steady rolling and to third order in a step else.

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
        levers, rotations, centers = self._look(at)
        before, turned, was = self._last
        turns = _turn_between(turned, rotations)
        moved = centers - was + cross(turns, 0.5 * (before + levers))
        normals = at.contacts[:, 4:7]
        moved -= normals * np.einsum("sj,sj->s", normals, moved)[:, None]
        self.slid += moved * self._standing[lifted]
        self._last = levers, rotations, centers
        return np.asarray(np.linalg.norm(self.slid, axis=1))

    def _look(self, at: Instant) -> tuple[Array, Array, Array]:
        """Levers (s, 3) m from centre to contact, orientations (s, 3, 3), centres (s, 3) m."""
        placed = at.placed
        joints = self.bodies.rolling_joints.tolist()
        rotations = np.array([placed[joint].rotation for joint in joints])
        return at.contacts[:, 1:4] - at.centers, rotations, at.centers


def _turn_between(before: Array, after: Array) -> Array:
    """(s, 3) rad, world: rotation vectors between orientations (s, 3, 3) less than a quarter turn apart."""
    turned = np.einsum("sij,skj->sik", after, before)
    half = 0.5 * np.column_stack(
        [
            turned[:, 2, 1] - turned[:, 1, 2],
            turned[:, 0, 2] - turned[:, 2, 0],
            turned[:, 1, 0] - turned[:, 0, 1],
        ]
    )
    sine = np.linalg.norm(half, axis=1)
    share = np.where(sine > 1e-12, np.arcsin(np.minimum(sine, 1.0)) / np.maximum(sine, 1e-300), 1.0)
    vectors: Array = half * share[:, None]
    return vectors
