"""Coordinates at rates."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rover_pin.errors import InputError
from rover_pin.kinematics.instant import Instant
from rover_pin.kinematics.rows import Aim, columns, number, picks, weight
from rover_pin.numerics import Array


@dataclass(frozen=True)
class Rates:
    """Ask coordinates for rates: drives, rockers, or the base's own.

    Attributes:
        rates: rad/s or m/s, by name of `Rover.dof_names`.
        weight: of a (rad/s) squared.
        name: what people read.

    Raises:
        InputError: no names, or something that is no finite number.
    """

    rates: Mapping[str, float]
    weight: float = 1.0
    name: str = "rates"

    def __post_init__(self) -> None:
        if not self.rates:
            raise InputError("names no coordinate", element=self.name, cure="give rates={name: value}")
        for joint, value in self.rates.items():
            number(f"{self.name}: {joint}", value)
        weight(self.name, self.weight)
        object.__setattr__(self, "rates", dict(self.rates))

    def aim(self, at: Instant, dt: float) -> Aim:
        """A row a coordinate.

        Raises:
            InputError: an unknown coordinate.
        """
        names = tuple(self.rates)
        places, rows = at.bodies.once(f"picks {names}", lambda: _picked(at, self.name, names))
        target = np.array(list(self.rates.values()))
        return Aim(rows, target, np.full(len(places), self.weight))


def _picked(at: Instant, element: str, names: tuple[str, ...]) -> tuple[list[int], Array]:
    places = columns(at, element, names)
    return places, picks(at, places)
