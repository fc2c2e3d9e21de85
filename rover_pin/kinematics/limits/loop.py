"""Loops stay closed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rover_pin.kinematics.instant import Instant
from rover_pin.kinematics.rows import Rows, equations, gain_between


@dataclass(frozen=True)
class LoopsClosed:
    """Every loop's rows; `gain` of what a loop is open by is closed in a step.

    Attributes:
        gain: in (0, 1].

    Raises:
        InputError: a gain outside.
    """

    gain: float = 0.5

    def __post_init__(self) -> None:
        gain_between("loops: gain", self.gain)

    def rows(self, at: Instant, dt: float) -> Rows:
        """The loops' rows, one after the other."""
        loops = at.rover.loops
        if not loops:
            return equations((), np.zeros((0, at.rover.model.nv)), np.zeros(0))
        matrix = np.vstack([loop.jacobian(at.mechanism) for loop in loops])
        rate = -self.gain / dt * np.concatenate([loop.residual(at.mechanism) for loop in loops])
        names = tuple(f"loop {loop.name} row {i + 1}" for loop in loops for i in range(loop.size))
        return equations(names, matrix, rate)
