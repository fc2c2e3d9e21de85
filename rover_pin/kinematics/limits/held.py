"""Joints that do not move: brakes."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from rover_pin.kinematics.instant import Bodies, Instant
from rover_pin.kinematics.rows import Rows, pinned


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
    _kept: list[tuple[Bodies, Rows]] = field(default_factory=list, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "joints", tuple(self.joints))

    def rows(self, at: Instant, dt: float) -> Rows:
        """A row a joint: its rate is 0.

        Raises:
            InputError: an unknown joint.
        """
        if self._kept and self._kept[0][0] is at.bodies:
            return self._kept[0][1]
        found = pinned(at, self.word, self.joints, np.zeros(len(self.joints)))
        self._kept[:] = [(at.bodies, found)]
        return found
