"""What a study may vary, as the study file writes it: a range, a choice, a distribution, or one value."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import BeforeValidator

from rover_pin.analysis.chance import Chance, is_chance, read_chance
from rover_pin.analysis.finite import number
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
    def support(self) -> tuple[float, float]:
        """Between which values it lies."""
        return self.ends

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
    def support(self) -> tuple[float, float]:
        """Between which values it lies."""
        return self.ends

    @property
    def ends(self) -> tuple[float, float]:
        """Least and greatest value."""
        return (min(self.values), max(self.values))


Quantity = Span | Choice | Chance
"""A range, a choice or a distribution of numbers."""

MOST_VALUES = 10_000
"""The most values that evenly spaced ones may be."""

MAP = "map"
"""The word for the whole map, less the room the wheels need."""


def quantity(raw: object) -> Quantity:
    """Read a quantity: `0.5` or `[0.5]` fixed, `[lo, hi]` a range, three or more a choice.

    `{values: [a, b]}` is a choice of two, `{from: lo, to: hi, by: step}` one of evenly spaced values, as is
    `{from: lo, to: hi, count: n}`. Distributions: `{normal: {mean: 10, sd: 0.5, bounds: [8, 12]}}` and the
    others of `chance.py`; a uniform one is a range.

    Raises:
        StudyError: empty, upside down, or not numbers.
    """
    if isinstance(raw, Quantity):
        return raw
    if isinstance(raw, Mapping):
        return _mapped(raw)
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


def _mapped(raw: Mapping[Any, Any]) -> Quantity:
    """A quantity written as a mapping."""
    if is_chance(raw):
        chance = read_chance(raw)
        return Span(*chance.numbers) if chance.kind == "uniform" else chance
    keys = set(raw)
    if keys == {"values"} and isinstance(raw["values"], list | tuple) and raw["values"]:
        return Choice(tuple(number(v) for v in raw["values"]))
    if keys not in ({"from", "to", "by"}, {"from", "to", "count"}):
        cure = "write [lo, hi], {values: [a, b, ...]}, {from: lo, to: hi, by: step} "
        cure += "or {normal: {mean: 1, sd: 0.1}}"
        raise StudyError("is no quantity", value=dict(raw), cure=cure)
    low, high = number(raw["from"]), number(raw["to"])
    if low >= high:
        raise StudyError("range is upside down", value=[low, high], cure="write the lesser number as `from`")
    return _evenly(low, high, raw)


def _evenly(low: float, high: float, raw: Mapping[Any, Any]) -> Choice:
    """Evenly spaced values with both ends, as many as `count` says, or `by` apart as far as they go."""
    if "count" in raw:
        count = number(raw["count"])
        if count != int(count) or not 2 <= count <= MOST_VALUES:
            raise StudyError("is no count of values", element="count", value=raw["count"], cure="at least 2")
        steps = int(count) - 1
        return Choice(tuple(low + (high - low) * k / steps for k in range(steps + 1)))
    by = number(raw["by"])
    if by <= 0 or (high - low) / by >= MOST_VALUES:
        cure = f"a positive step that makes at most {MOST_VALUES} values"
        raise StudyError("is no step", element="by", value=raw["by"], cure=cure)
    return Choice(tuple(low + k * by for k in range(int((high - low) / by * (1 + 1e-12) + 1e-9) + 1)))


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
