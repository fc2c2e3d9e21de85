"""Passive joints held by an engaged clutch."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rover_pin.errors import InputError, nearest
from rover_pin.kinematics.instant import Instant
from rover_pin.kinematics.rows import Rows, columns, gain_between, number, pinned


@dataclass(frozen=True)
class Clutch:
    """Lockable joints held at the values where they were engaged.

    Attributes:
        joints: value [rad or m] by name.
        gain: share of what a joint is off by that a step makes good.

    Raises:
        InputError: a value that is no finite number.
    """

    joints: Mapping[str, float]
    gain: float = 0.5

    def __post_init__(self) -> None:
        for joint, value in self.joints.items():
            number(f"clutch of {joint}", value)
        gain_between("clutch: gain", self.gain)
        object.__setattr__(self, "joints", dict(self.joints))

    def rows(self, at: Instant, dt: float) -> Rows:
        """A row a joint.

        Raises:
            InputError: a joint that the rover cannot lock.
        """
        for joint in self.joints:
            if joint not in at.rover.lockable:
                known = at.rover.lockable
                cure = nearest(joint, known) if known else "list it under `locks` in the sidecar"
                raise InputError("is no joint that can be locked", element="clutch", value=joint, cure=cure)
        places = columns(at, "clutch", tuple(self.joints))
        rate = -self.gain / dt * (at.q[places] - np.array(list(self.joints.values())))
        return pinned(at, "clutch", tuple(self.joints), rate)
