"""Couplings hold: differentials, gears, mimics."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rover_pin.kinematics.instant import Instant
from rover_pin.kinematics.rows import Rows, equations, gain_between
from rover_pin.numerics import Array


@dataclass(frozen=True)
class CouplingsKept:
    """Every coupling's row; `gain` of what it is off by is made good in a step.

    Attributes:
        gain: in (0, 1].

    Raises:
        InputError: a gain outside.
    """

    gain: float = 0.5

    def __post_init__(self) -> None:
        gain_between("couplings: gain", self.gain)

    def rows(self, at: Instant, dt: float) -> Rows:
        """A row a coupling."""
        names, matrix, offset = at.bodies.once("couplings", lambda: _stacked(at))
        return equations(names, matrix, self.gain / dt * (offset - matrix @ at.q))


def _stacked(at: Instant) -> tuple[tuple[str, ...], Array, Array]:
    couplings = at.rover.couplings
    matrix = np.array([each.row for each in couplings]).reshape(-1, at.rover.model.nv)
    offset = np.array([each.offset for each in couplings])
    return tuple(f"coupling {each.name}" for each in couplings), matrix, offset
