"""Limits of motion constraints, and what is crossed now."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rover_pin.control.motion_constraints.constraint import MotionConstraint
from rover_pin.control.now import Now
from rover_pin.errors import InputError, nearest
from rover_pin.numerics import Array

ROUNDING = 1e-9
"""By which an index may pass its margin: a projection stops on the margin itself, up to rounding."""


@dataclass(frozen=True)
class Threshold:
    """What a motion constraint may reach: |value| / limit <= margin.

    Attributes:
        limit: in the constraint's unit.
        margin: kappa, in (0, 1].

    Raises:
        InputError: a limit that is not finite and above 0, or a margin outside (0, 1].
    """

    limit: float
    margin: float = 1.0

    def __post_init__(self) -> None:
        if not (math.isfinite(self.limit) and self.limit > 0.0):
            raise InputError("must be a finite number above 0", element="limit", value=self.limit)
        if not 0.0 < self.margin <= 1.0:
            raise InputError("lies above 0 and is at most 1", element="margin", value=self.margin)

    @property
    def allowed(self) -> float:
        """Margin times limit."""
        return self.margin * self.limit


@dataclass(frozen=True)
class Reading:
    """A motion constraint as it is now.

    Attributes:
        name: of the constraint.
        parts: names of its parts.
        value: (parts,) in its unit; NaN where it does not apply.
        index: (parts,) |value| / limit; of a set the number of rules broken.
        crossed: whether an index is beyond the margin.
    """

    name: str
    parts: tuple[str, ...]
    value: Array
    index: Array
    crossed: bool

    @property
    def worst(self) -> float:
        """The largest index; 0 where the constraint does not apply."""
        return float(np.nanmax(self.index, initial=0.0))


def evaluate(
    constraints: Mapping[str, MotionConstraint], thresholds: Mapping[str, Threshold], now: Now
) -> dict[str, Reading]:
    """All constraints against the thresholds of a mode.

    Args:
        constraints: by name.
        thresholds: by name of constraint, of the mode the rover is in; more than asked for do no harm.
        now: the rover in motion.

    Raises:
        InputError: a constraint without a threshold, named; or what a constraint cannot be worked out from.
    """
    readings = {}
    for name, constraint in constraints.items():
        value = constraint.value(now)
        limit, margin = 1.0, 0.0
        if constraint.kind != "set":
            threshold = threshold_of(name, thresholds)
            limit, margin = threshold.limit, threshold.margin
        index = np.abs(value) / limit
        beyond = any(each > margin + ROUNDING for each in index.tolist())
        readings[name] = Reading(name, constraint.parts, value, index, beyond)
    return readings


def crossed(readings: Mapping[str, Reading]) -> tuple[str, ...]:
    """Names of the constraints that are crossed."""
    return tuple(name for name, reading in readings.items() if reading.crossed)


def threshold_of(name: str, thresholds: Mapping[str, Threshold]) -> Threshold:
    """The threshold of a motion constraint.

    Raises:
        InputError: there is none; names the nearest.
    """
    if name not in thresholds:
        raise InputError("has no threshold in this mode", element=name, cure=nearest(name, thresholds))
    return thresholds[name]
