"""Motion constraints in a cycle's program: the command is moved no further than they ask for.

u* = argmin |u - u_nom|^2_W subject to what always holds and to every motion constraint (Qi et al., eq. 41,
whose text did not survive; reconstructed). u_nom and W are the tasks of the action under way. A constraint on
velocities is a row, |g v + c| <= kappa limit. One on posture is a row on its rate, on both sides,
-gamma (kappa limit + eta) <= d eta/dq v <= gamma (kappa limit - eta), so that it is approached ever slower
and not passed. Constraints on loads and on which wheels hang are read, not steered by.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rover_pin.control.motion_constraints import MotionConstraint
from rover_pin.control.now import Now
from rover_pin.control.threshold import Reading, Threshold, threshold_of
from rover_pin.errors import InputError
from rover_pin.kinematics.instant import Instant
from rover_pin.kinematics.rows import Rows
from rover_pin.numerics import Array

REACHED = 1e-4
"""Share of its margin that an index comes up to when it counts as reached."""


@dataclass(frozen=True, eq=False)
class Watched:
    """One motion constraint at one instant.

    Attributes:
        name: of the constraint.
        parts: names of its parts.
        threshold: of the mode; None of a set, which takes none.
        matrix: (parts, nv) gradient of a posture or velocity constraint, else empty.
        value: (parts,) its value at no velocity.
        is_rate: whether `matrix` v adds to the value.
    """

    name: str
    parts: tuple[str, ...]
    threshold: Threshold | None
    matrix: Array
    value: Array
    is_rate: bool

    def reading(self, velocity: Array) -> Reading:
        """The constraint with that velocity."""
        value = self.value + self.matrix @ velocity if self.is_rate else self.value
        if self.threshold is None:
            return Reading(self.name, self.parts, value, value, bool((value > 0.0).any()))
        index = np.abs(value) / self.threshold.limit
        reached = self.threshold.margin * (1.0 - REACHED)
        return Reading(self.name, self.parts, value, index, any(each >= reached for each in index.tolist()))


@dataclass(frozen=True, eq=False)
class Watch:
    """All motion constraints of a mode at one instant; a limit of the cycle's program.

    Attributes:
        watched: one each.
        gamma: 1/s.
    """

    watched: tuple[Watched, ...]
    gamma: float

    def rows(self, at: Instant, dt: float) -> Rows:
        """Rows of constraints on posture and on velocity; parts that do not apply have none."""
        names: list[str] = []
        matrices, lows, highs = [], [], []
        for each in self.watched:
            if each.threshold is None or not len(each.matrix):
                continue
            allowed = each.threshold.allowed
            low, high = -allowed - each.value, allowed - each.value
            if not each.is_rate:
                low, high = self.gamma * low, self.gamma * high
            names.extend(f"{each.name} {part}".rstrip() for part in each.parts)
            matrices.append(each.matrix)
            lows.append(low)
            highs.append(high)
        if not matrices:
            nothing = np.zeros(0)
            return Rows((), np.zeros((0, at.rover.model.nv)), nothing, nothing)
        low, high = np.concatenate(lows), np.concatenate(highs)
        applies = np.isfinite(low)
        low[~applies], high[~applies] = -np.inf, np.inf
        return Rows(tuple(names), np.concatenate(matrices), low, high)

    def readings(self, velocity: Array) -> dict[str, Reading]:
        """By name, with that velocity."""
        return {each.name: each.reading(velocity) for each in self.watched}


class Projection:
    """The motion constraints of a mode with its thresholds.

    Args:
        constraints: by name; those that the mode has no threshold for are left out, but for sets.
        thresholds: of the mode, by name.
        gamma: 1/s; how fast what is left to a posture constraint's limit may be used up.

    Raises:
        InputError: a threshold for a constraint that is not there, or a gamma that is not above 0.
    """

    def __init__(
        self,
        constraints: Mapping[str, MotionConstraint],
        thresholds: Mapping[str, Threshold],
        gamma: float = 5.0,
    ) -> None:
        if not (math.isfinite(gamma) and gamma > 0.0):
            raise InputError("must be a finite number above 0", element="gamma", value=gamma)
        for name in thresholds:
            threshold_of(name, dict.fromkeys(constraints, thresholds[name]))
        self.gamma = gamma
        self._watched = [
            (constraint, thresholds.get(name))
            for name, constraint in constraints.items()
            if name in thresholds or constraint.kind == "set"
        ]

    def watch(self, now: Now) -> Watch:
        """The constraints at an instant; those on loads only where `now` has loads.

        Args:
            now: with no velocity.
        """
        found = []
        for constraint, threshold in self._watched:
            kind = constraint.kind
            if kind == "load" and now.loads is None:
                continue
            value = constraint.value(now)
            matrix = constraint.gradient(now) if kind in ("posture", "velocity") else _NONE
            found.append(
                Watched(constraint.name, constraint.parts, threshold, matrix, value, kind == "velocity")
            )
        return Watch(tuple(found), self.gamma)


_NONE = np.zeros((0, 0))
