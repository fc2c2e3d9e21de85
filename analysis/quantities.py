"""What a study may vary: a range, a choice of values, or one fixed value, as written in the study file."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import BeforeValidator

from rover_pin.errors import StudyError


@dataclass(frozen=True)
class Span:
    """Every value from `low` to `high`."""

    low: float
    high: float

    @property
    def varies(self) -> bool:
        """Whether there is more than one value."""
        return self.high > self.low

    @property
    def ends(self) -> tuple[float, float]:
        """Least and greatest value."""
        return (self.low, self.high)


@dataclass(frozen=True)
class Choice:
    """One of `values`; a single one is a fixed value."""

    values: tuple[float, ...]

    @property
    def varies(self) -> bool:
        """Whether there is more than one value."""
        return len(self.values) > 1

    @property
    def ends(self) -> tuple[float, float]:
        """Least and greatest value."""
        return (min(self.values), max(self.values))


Quantity = Span | Choice
"""A range or a choice of numbers."""

MAP = "map"
"""The word for the whole map, less the room the wheels need."""


def number(raw: object) -> float:
    """A finite float from what YAML gave (`1e-3` comes as text there).

    Raises:
        StudyError: not a number, or not a finite one.
    """
    try:
        if isinstance(raw, bool) or raw is None:
            raise TypeError
        value = float(raw)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        raise StudyError("is not a number", value=raw) from None
    if not math.isfinite(value):
        raise StudyError("is not a finite number", value=raw)
    return value


def quantity(raw: object) -> Quantity:
    """Read a quantity: `0.5` or `[0.5]` fixed, `[lo, hi]` a range, three or more a choice.

    `{values: [a, b]}` is a choice of two.

    Raises:
        StudyError: empty, upside down, or not numbers.
    """
    if isinstance(raw, Span | Choice):
        return raw
    if isinstance(raw, Mapping):
        if set(raw) != {"values"} or not isinstance(raw["values"], list | tuple) or not raw["values"]:
            raise StudyError(
                "is no quantity", value=dict(raw), cure="write [lo, hi], or {values: [a, b, ...]}"
            )
        return Choice(tuple(number(v) for v in raw["values"]))
    if not isinstance(raw, list | tuple):
        return Choice((number(raw),))
    values = tuple(number(v) for v in raw)
    if not values:
        raise StudyError("has no value", cure="write [lo, hi] for a range or one number")
    if len(values) != 2:
        return Choice(values)
    if values[0] > values[1]:
        raise StudyError("range is upside down", value=list(values), cure="write the lesser number first")
    return Span(*values)


def _optional(raw: Any) -> Any:
    return None if raw is None else quantity(raw)


def _placed(raw: Any) -> Any:
    return MAP if isinstance(raw, str) and raw == MAP else _optional(raw)


QuantityField = Annotated[Any, BeforeValidator(quantity)]
"""A `Quantity` in a pydantic model."""

OptionalField = Annotated[Any, BeforeValidator(_optional)]
"""A `Quantity` or nothing in a pydantic model."""

PlaceField = Annotated[Any, BeforeValidator(_placed)]
"""A `Quantity`, the word `map`, or nothing in a pydantic model."""
