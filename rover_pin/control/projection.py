"""Motion constraints in a cycle's program: the command is moved no further than they ask for.

u* = argmin |u - u_nom|^2_W subject to what always holds and to every motion constraint: eq. 41 of the
HIT-MRII paper, whose text did not survive, reconstructed. u_nom and W are the tasks of the action under way.
A constraint on velocities is a row, |g v + c| <= kappa limit. One on posture is a row on its rate, on both
sides, -gamma (kappa limit + eta) <= d eta/dq v <= gamma (kappa limit - eta), so that it is approached ever
slower and not passed. Constraints on loads and on which wheels hang are read, not steered by.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from rover_pin.control.motion_constraints import MotionConstraint
from rover_pin.control.now import Now
from rover_pin.control.threshold import Reading, Threshold
from rover_pin.errors import InputError, nearest
from rover_pin.kinematics.instant import Instant
from rover_pin.kinematics.rows import Rows
from rover_pin.numerics import Array

REACHED = 1e-4
"""Share of its margin that an index comes up to when it counts as reached."""


@dataclass(frozen=True, eq=False)
class Watch:
    """All motion constraints of a mode at one instant; a limit of the cycle's program.

    Attributes:
        projection: thresholds and names.
        value: (k,) every part's value at no velocity, in the projection's order; NaN where it does not apply.
        matrix: (r, nv) gradients of the first r parts, which are those on velocity, then those on posture.
    """

    projection: Projection
    value: Array
    matrix: Array

    def rows(self, at: Instant, dt: float) -> Rows:
        """Rows of the constraints on velocity and on posture; parts that do not apply are open."""
        projection, steered = self.projection, len(self.matrix)
        if not steered:
            nothing = np.zeros(0)
            return Rows((), np.zeros((0, at.rover.model.nv)), nothing, nothing)
        value, allowed, pace = self.value[:steered], projection.allowed[:steered], projection.pace
        low, high = pace * (-allowed - value), pace * (allowed - value)
        if np.isnan(low).any():
            low, high = np.where(np.isnan(low), -np.inf, low), np.where(np.isnan(high), np.inf, high)
        return Rows(projection.row_names, self.matrix, low, high)

    def look(self, velocity: Array) -> Look:
        """The constraints with a velocity (nv,)."""
        value = self.value.copy()
        rates = self.projection.rates
        value[:rates] += self.matrix[:rates] @ velocity
        return Look(self.projection, value)


@dataclass(frozen=True, eq=False)
class Look:
    """All motion constraints of a mode with a velocity.

    Attributes:
        projection: thresholds and names.
        value: (k,) of every part.
    """

    projection: Projection
    value: Array

    @cached_property
    def index(self) -> Array:
        """(k,) |value| / limit; of a set the number of rules broken."""
        index: Array = np.abs(self.value) / self.projection.limit
        return index

    @cached_property
    def crossed(self) -> tuple[str, ...]:
        """Names of the constraints that have reached their thresholds."""
        reached = self.index >= self.projection.reached
        if not reached.any():
            return ()
        parts = self.projection.parts
        return tuple(dict.fromkeys(parts[i][0] for i in np.flatnonzero(reached)))

    @cached_property
    def readings(self) -> dict[str, Reading]:
        """By name of constraint."""
        found = {}
        crossed = self.crossed
        for name, parts, place in self.projection.places:
            value, index = self.value[place], self.index[place]
            if not np.isnan(value).all() or name in crossed:
                found[name] = Reading(name, parts, value, index, name in crossed)
        return found


class Projection:
    """The motion constraints of a mode with its thresholds.

    Args:
        constraints: by name; those that the mode has no threshold for are left out, but for sets.
        thresholds: of the mode, by name.
        gamma: 1/s; how fast what is left to a posture constraint's limit may be used up.

    Attributes:
        places: name, names of parts and place in flat arrays of every constraint: first those on velocity,
            then on posture, then on sets and on loads.
        parts: (k,) names of constraint and part.
        limit: (k,).
        allowed: (k,) margin times limit.
        reached: (k,) index that counts as reached.
        pace: (r,) what is left to the limit counts as a rate times this: 1 of velocities, gamma of postures.
        rates: number of parts on velocity.
        row_names: (r,) of parts on velocity and on posture.

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
            if name not in constraints:
                raise InputError(
                    "no motion constraint of that name", element=name, cure=nearest(name, constraints)
                )
        order = ("velocity", "posture", "set", "load")
        chosen = [c for name, c in constraints.items() if name in thresholds or c.kind == "set"]
        watched = sorted(chosen, key=lambda constraint: order.index(constraint.kind))
        ends = np.cumsum([0, *(len(c.parts) for c in watched)]).tolist()
        spans = [slice(a, b) for a, b in pairwise(ends)]
        self.places = [(c.name, c.parts, span) for c, span in zip(watched, spans, strict=True)]
        self.parts = [(c.name, part) for c in watched for part in c.parts]
        each = [thresholds.get(name) for name, _ in self.parts]
        self.limit = np.array([1.0 if t is None else t.limit for t in each])
        self.allowed = np.array([1.0 if t is None else t.allowed for t in each])
        self.reached = np.array([0.5 if t is None else t.margin * (1.0 - REACHED) for t in each])
        kinds = [c.kind for c in watched for _ in c.parts]
        self.rates, self._steered = kinds.count("velocity"), kinds.count("velocity") + kinds.count("posture")
        self.pace = np.where(np.arange(self._steered) < self.rates, 1.0, gamma)
        self._steps = [(c, c.kind, span) for c, span in zip(watched, spans, strict=True)]
        self._kept: dict[str, tuple[object, tuple[str, ...], Array]] = {}
        self.row_names = tuple(f"{name} {part}".rstrip() for name, part in self.parts[: self._steered])

    def watch(self, now: Now) -> Watch:
        """The constraints at an instant; those on loads only where `now` has loads.

        Args:
            now: with no velocity.
        """
        value, matrix = np.empty(len(self.parts)), np.empty((self._steered, len(now.v)))
        for constraint, kind, place in self._steps:
            if kind == "velocity":
                matrix[place] = constraint.gradient(now)
                value[place] = constraint.offset(now)
            elif kind == "posture":
                matrix[place] = constraint.gradient(now)
                value[place] = constraint.value(now)
            elif kind == "load" and now.loads is None:
                value[place] = np.nan
            else:
                value[place] = self._seldom(constraint, now)
        if now.lifted:
            idle = np.logical_not(matrix[: self.rates].any(axis=1))
            value[: self.rates][idle] = np.nan
        return Watch(self, value, matrix)

    def _seldom(self, constraint: MotionConstraint, now: Now) -> Array:
        """The value of a constraint on lifted wheels or loads: kept while these are the same."""
        kept = self._kept.get(constraint.name)
        if kept is None or kept[0] is not now.loads or kept[1] != now.lifted:
            kept = self._kept[constraint.name] = now.loads, now.lifted, constraint.value(now)
        return kept[2]
