"""A link's or joint's frame at a place."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from rover_pin.errors import InputError
from rover_pin.kinematics.instant import Instant
from rover_pin.kinematics.rows import Aim, above, gain_between, number, weight
from rover_pin.numerics import Array


@dataclass(frozen=True)
class FrameGoal:
    """Draw a frame's origin, and its axes where `rotation` is given, to a place in the world.

    Attributes:
        frame: link or joint.
        position: x, y, z [m, world]; None leaves an axis alone.
        rotation: (3, 3) axes in the world, or None.
        gain: share of the way that a step goes.
        speed: m/s, at most, and rad/s times `lever`.
        weight: of a (m/s) squared.
        lever: m; a rad/s counts as much as this many m/s.

    Raises:
        InputError: a position that is not three entries, a rotation that is none, a bad gain or weight.
    """

    frame: str
    position: Sequence[float | None] = (None, None, None)
    rotation: Array | None = None
    gain: float = 0.1
    speed: float = 0.05
    weight: float = 1.0
    lever: float = 0.5

    def __post_init__(self) -> None:
        if len(self.position) != 3:
            raise InputError("a position has x, y, z", element=self.name, value=tuple(self.position))
        for axis, value in zip("xyz", self.position, strict=True):
            if value is not None:
                number(f"{self.name}: {axis}", value)
        if self.rotation is None and all(value is None for value in self.position):
            raise InputError("asks for nothing", element=self.name, cure="give position= or rotation=")
        if self.rotation is not None:
            given = np.array(self.rotation, dtype=np.float64)
            if given.shape != (3, 3) or not _is_rotation(given):
                raise InputError(
                    "is no rotation matrix", element=f"{self.name}: rotation", value=given.tolist()
                )
            given.setflags(write=False)
            object.__setattr__(self, "rotation", given)
        gain_between(f"{self.name}: gain", self.gain)
        above(f"{self.name}: speed", self.speed)
        above(f"{self.name}: lever", self.lever)
        weight(self.name, self.weight)

    @property
    def name(self) -> str:
        """What people read."""
        return f"frame {self.frame}"

    def aim(self, at: Instant, dt: float) -> Aim:
        """Rows of the origin, then of the turn left to the goal, its rotation vector."""
        joint, origin, rotation = at.frame(self.frame)
        asked = [i for i, value in enumerate(self.position) if value is not None]
        goal = np.array([float(self.position[i] or 0.0) for i in asked])
        rows = at.rows(np.full(len(asked), joint), np.tile(origin, (len(asked), 1)), np.eye(3)[asked])
        way = goal - origin[asked]
        weights = np.full(len(asked), self.weight)
        if self.rotation is not None:
            left = rotation @ pin.log3(rotation.T @ self.rotation)
            rows = np.vstack([rows, at.turns(np.full(3, joint), np.eye(3))])
            way = np.concatenate([way, left])
            weights = np.concatenate([weights, np.full(3, self.weight * self.lever**2)])
        most = np.where(np.arange(len(way)) < len(asked), self.speed, self.speed / self.lever)
        return Aim(rows, np.clip(self.gain * way / dt, -most, most), weights)


def _is_rotation(given: Array) -> bool:
    """Whether rows are unit and at right angles, and no mirror image."""
    return np.allclose(given @ given.T, np.eye(3), atol=1e-6) and float(np.linalg.det(given)) > 0.0
