"""Joints that do not move: brakes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rover_pin.kinematics.instant import Instant
from rover_pin.kinematics.rows import Rows, columns, picks


@dataclass(frozen=True)
class Held:
    """Joints that stay where they are.

    A drive that is held turns with its carrier: where an arm moves, its wheel rolls with the arm.

    Attributes:
        joints: their names.
        word: what holds them, for people.
    """

    joints: tuple[str, ...]
    word: str = "brake"

    def __post_init__(self) -> None:
        object.__setattr__(self, "joints", tuple(self.joints))

    def rows(self, at: Instant, dt: float) -> Rows:
        """A row a joint: its rate is 0.

        Raises:
            InputError: an unknown joint.
        """
        still = np.zeros(len(self.joints))
        matrix = picks(at, columns(at, self.word, self.joints))
        return Rows(tuple(f"{self.word} of {joint}" for joint in self.joints), matrix, still, still)
