"""The base's motion: forward, left, up, and turning, in its heading's frame."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from rover_pin.errors import InputError
from rover_pin.kinematics.instant import Instant
from rover_pin.kinematics.rows import Aim, above, number, weight
from rover_pin.numerics import Array

LINEAR = ("forward", "left", "up")
ANGULAR = ("yaw", "pitch", "roll")


@dataclass(frozen=True)
class BaseTwist:
    """Rates of the root link's origin along its heading, and of its angles; silent ones are not asked for.

    Attributes:
        forward: m/s, along the heading in the horizontal plane.
        left: m/s, across it.
        up: m/s.
        yaw: rad/s.
        pitch: rad/s, nose down positive.
        roll: rad/s.
        weight: of a (m/s) squared.
        lever: m; a rad/s counts as much as this many m/s.
        name: what people read.

    Raises:
        InputError: nothing asked for, or something that is no finite number.
    """

    forward: float | None = None
    left: float | None = None
    up: float | None = None
    yaw: float | None = None
    pitch: float | None = None
    roll: float | None = None
    weight: float = 1.0
    lever: float = 0.5
    name: str = "base twist"

    def __post_init__(self) -> None:
        weight(self.name, self.weight)
        above(f"{self.name}: lever", self.lever)
        asked = self._asked(LINEAR + ANGULAR)
        for word, value in asked.items():
            number(f"{self.name}: {word}", value, "give a rate in m/s or rad/s")
        if not asked:
            raise InputError("asks for nothing", element=self.name, cure="give forward=, left=, yaw=, ...")

    def _asked(self, words: tuple[str, ...]) -> dict[str, float]:
        return {word: value for word in words if (value := getattr(self, word)) is not None}

    def aim(self, at: Instant, dt: float) -> Aim:
        """A row a rate asked for."""
        asked = self._asked(LINEAR + ANGULAR)
        weights = [self.weight * (1.0 if word in LINEAR else self.lever**2) for word in asked]
        rows = np.array([twist_row(at, word) for word in asked])
        return Aim(rows, np.array(list(asked.values())), np.array(weights))


def twist_row(at: Instant, word: str) -> Array:
    """(nv,) velocity of the root link's origin `forward`, `left`, `up`, or of its `yaw`, `pitch`, `roll`."""
    row = np.zeros(at.rover.model.nv)
    if word in ANGULAR:
        row[3 + ANGULAR.index(word)] = 1.0
    elif word == "up":
        row[2] = 1.0
    else:
        turned = at.heading + (0.0 if word == "forward" else 0.5 * math.pi)
        row[0], row[1] = math.cos(turned), math.sin(turned)
    return row
