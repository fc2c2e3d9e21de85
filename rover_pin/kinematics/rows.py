"""Rows that bind a velocity, and aims that draw it: what limits and tasks give the program of one step."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from rover_pin.errors import InputError
from rover_pin.kinematics.instant import Instant
from rover_pin.numerics import Array


@dataclass(frozen=True)
class Rows:
    """low <= matrix v <= high, k rows.

    Attributes:
        names: (k,) what people read where a row fights another.
        matrix: (k, nv).
        low: (k,); -inf where a row is open.
        high: (k,).
        bend: weight of the square of what a row may be missed by; inf: rows that do not bend.
        pins: (k,) columns, where every row is a coordinate itself.
        equation: whether low and high are the same.
    """

    names: tuple[str, ...]
    matrix: Array
    low: Array
    high: Array
    bend: float = math.inf
    pins: tuple[int, ...] = ()
    equation: bool = False


def equations(
    names: tuple[str, ...], matrix: Array, side: Array, bend: float = math.inf, pins: tuple[int, ...] = ()
) -> Rows:
    """Rows matrix v = side."""
    return Rows(names, matrix, side, side, bend, pins, True)


def pinned(at: Instant, word: str, joints: tuple[str, ...], rates: Array) -> Rows:
    """Rows that give coordinates their rates.

    Raises:
        InputError: an unknown coordinate, with the nearest names.
    """
    places = columns(at, word, joints)
    names = tuple(f"{word} of {joint}" for joint in joints)
    return equations(names, picks(at, places), rates, pins=tuple(places))


@dataclass(frozen=True)
class Aim:
    """What a task asks for: the least sum of weight times (matrix v - target) squared.

    Attributes:
        matrix: (k, nv).
        target: (k,).
        weight: (k,), at least 0.
    """

    matrix: Array
    target: Array
    weight: Array


class Task(Protocol):
    """Something wanted of the motion; missed where limits forbid it."""

    @property
    def name(self) -> str:
        """What people read."""

    def aim(self, at: Instant, dt: float) -> Aim:
        """Rows at an instant, for a step of dt [s]."""


class Limit(Protocol):
    """Something the motion must obey."""

    def rows(self, at: Instant, dt: float) -> Rows:
        """Rows at an instant, for a step of dt [s]."""


class Box(Protocol):
    """Bounds on single coordinates, which solvers take apart from rows."""

    def box(self, at: Instant, dt: float) -> tuple[Array, Array]:
        """Lowest and highest rate of every coordinate, (nv,) each."""

    def bound_name(self, dof: str, upper: bool) -> str:
        """What people read where that bound fights a row."""


def weight(element: str, value: float, *, may_be_infinite: bool = False) -> float:
    """A weight, checked.

    Raises:
        InputError: it is not finite, or below 0.
    """
    if math.isnan(value) or value < 0.0 or (math.isinf(value) and not may_be_infinite):
        raise InputError("a weight is a finite number, at least 0", element=element, value=value)
    return float(value)


def number(element: str, value: float, cure: str = "") -> float:
    """A finite number, checked.

    Raises:
        InputError: it is not finite.
    """
    if not math.isfinite(value):
        raise InputError("must be a finite number", element=element, value=value, cure=cure or None)
    return float(value)


def above(element: str, value: float, unit: str = "") -> float:
    """A finite number above 0, checked.

    Raises:
        InputError: it is not finite, or not above 0.
    """
    if not number(element, value) > 0.0:
        raise InputError(f"must be above 0 {unit}".rstrip(), element=element, value=value)
    return float(value)


def gain_between(element: str, value: float) -> float:
    """A gain in (0, 1], checked.

    Raises:
        InputError: it is outside.
    """
    if not 0.0 < value <= 1.0:
        raise InputError("a gain lies above 0 and is at most 1", element=element, value=value)
    return float(value)


def columns(at: Instant, element: str, names: tuple[str, ...]) -> list[int]:
    """Columns of coordinates by name.

    Raises:
        InputError: an unknown one, with the nearest names.
    """
    from rover_pin.errors import nearest

    found = []
    for name in names:
        if name not in at.rover.column:
            raise InputError(
                "no coordinate of that name", element=element, value=name, cure=nearest(name, at.rover.column)
            )
        found.append(at.rover.column[name])
    return found


def picks(at: Instant, places: list[int]) -> Array:
    """(k, nv) rows that pick single coordinates."""
    rows = np.zeros((len(places), at.rover.model.nv))
    rows[np.arange(len(places)), places] = 1.0
    return rows
