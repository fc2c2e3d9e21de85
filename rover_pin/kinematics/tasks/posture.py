"""Joints at values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rover_pin.errors import InputError
from rover_pin.kinematics.instant import Instant
from rover_pin.kinematics.rows import Aim, above, columns, gain_between, number, picks, weight
from rover_pin.numerics import Array


@dataclass(frozen=True)
class Posture:
    """Draw joints to values.

    Attributes:
        joints: rad or m, by name.
        speed: rad/s or m/s, at most.
        gain: share of the way that a step goes.
        weight: of a (rad/s) squared.
        name: what people read.

    Raises:
        InputError: no joints, or something that is no finite number.
    """

    joints: Mapping[str, float]
    speed: float = 0.1
    gain: float = 0.2
    weight: float = 1.0
    name: str = "posture"

    def __post_init__(self) -> None:
        if not self.joints:
            raise InputError("names no joint", element=self.name, cure="give joints={name: value}")
        for joint, value in self.joints.items():
            number(f"{self.name}: {joint}", value)
        above(f"{self.name}: speed", self.speed)
        gain_between(f"{self.name}: gain", self.gain)
        weight(self.name, self.weight)
        object.__setattr__(self, "joints", dict(self.joints))

    def aim(self, at: Instant, dt: float) -> Aim:
        """A row a joint.

        Raises:
            InputError: an unknown joint.
        """
        names = tuple(self.joints)
        places, rows = at.bodies.once(f"picks {names}", lambda: _picked(at, self.name, names))
        way = self.gain * (np.array(list(self.joints.values())) - at.q[places]) / dt
        target = np.clip(way, -self.speed, self.speed)
        return Aim(rows, target, np.full(len(places), self.weight))


def _picked(at: Instant, element: str, names: tuple[str, ...]) -> tuple[list[int], Array]:
    places = columns(at, element, names)
    return places, picks(at, places)
