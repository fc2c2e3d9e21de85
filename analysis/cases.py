"""The cases of a study: one by one, and as columns of any run of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from rover_pin.analysis.quantities import Choice, Quantity
from rover_pin.numerics import Array

POSTURE = "posture"


@dataclass(frozen=True)
class Case:
    """One question: where, heading which way (rad), in which posture, as which rover, with which friction."""

    x: float
    y: float
    yaw: float
    posture: str | None
    friction: float | None
    parameters: Mapping[str, float]
    joints: Mapping[str, float]
    weights: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Cases:
    """A run of n cases of a study, by columns.

    Attributes:
        x, y: (n,) m.
        yaw: (n,) rad.
        postures: names of the postures that occur; empty where none was asked for.
        posture: (n,) index into `postures`.
        friction: (n,) or None where each wheel's declared friction counts.
        parameters, joints: name to (n,) values.
        weights: masses and where they sit, named as in `weights.py`, likewise.
    """

    x: Array
    y: Array
    yaw: Array
    postures: tuple[str, ...]
    posture: NDArray[np.int64]
    friction: Array | None
    parameters: Mapping[str, Array]
    joints: Mapping[str, Array]
    weights: Mapping[str, Array] = field(default_factory=dict)

    def __len__(self) -> int:
        """The number of cases."""
        return len(self.x)

    def __getitem__(self, i: int) -> Case:
        """The i-th case of the run."""
        return Case(
            float(self.x[i]),
            float(self.y[i]),
            float(self.yaw[i]),
            self.postures[self.posture[i]] if self.postures else None,
            None if self.friction is None else float(self.friction[i]),
            {name: float(values[i]) for name, values in self.parameters.items()},
            {name: float(values[i]) for name, values in self.joints.items()},
            {name: float(values[i]) for name, values in self.weights.items()},
        )


@dataclass(frozen=True)
class Questions:
    """What varies, with the map resolved to numbers, in the order that samplers follow."""

    place: Mapping[str, Quantity]
    friction: Quantity | None
    parameters: Mapping[str, Quantity]
    joints: Mapping[str, Quantity]
    postures: tuple[str, ...]
    weights: Mapping[str, Quantity] = field(default_factory=dict)

    @property
    def columns(self) -> dict[str, Quantity]:
        """Every quantity by its name; the last varies fastest in a grid."""
        posture: Quantity = Choice(tuple(float(i) for i in range(max(1, len(self.postures)))))
        friction = {} if self.friction is None else {"friction": self.friction}
        return {**self.parameters, **self.weights, POSTURE: posture, **self.joints, **friction, **self.place}
