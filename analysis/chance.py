"""Distributions that a study may draw a quantity from, and how the study file writes them.

Numbers are drawn through the inverse of the cumulative distribution, so that any sequence in [0, 1) serves.
The densities are those of scipy.stats: norm(mean, sd), triang, lognorm(s, scale=scale). Bounds truncate:
the rest of the density is scaled up.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.analysis.finite import number
from rover_pin.errors import StudyError, nearest
from rover_pin.numerics import Array

if TYPE_CHECKING:
    from scipy.stats.distributions import rv_frozen

KEYS: Mapping[str, tuple[str, ...]] = {
    "normal": ("mean", "sd"),
    "uniform": ("low", "high"),
    "triangular": ("low", "mode", "high"),
    "lognormal": ("s", "scale"),
}
"""Distributions and their numbers."""

BOUNDED = ("normal", "lognormal")
"""Those that `bounds: [low, high]` may truncate."""

FORMS = {
    "normal": "{normal: {mean: 1, sd: 0.1, bounds: [0.5, 1.5]}}",
    "uniform": "{uniform: {low: 0, high: 1}}",
    "triangular": "{triangular: {low: 0, mode: 1, high: 2}}",
    "lognormal": "{lognormal: {s: 0.2, scale: 1}}",
}

TAIL = 2.0**-32
"""Share of either tail that is not drawn (normal: beyond 6.2 sd), so that every draw is finite."""


@dataclass(frozen=True)
class Chance:
    """A distribution of one number.

    Attributes:
        kind: of `KEYS`.
        numbers: in the order of `KEYS`.
        bounds: that truncate it; None where nothing does.
    """

    kind: str
    numbers: tuple[float, ...]
    bounds: tuple[float, float] | None = None

    @property
    def varies(self) -> bool:
        """Whether there is more than one value: always."""
        return True

    @property
    def support(self) -> tuple[float, float]:
        """Between which values the density is, +-inf where it never ends."""
        low, high = self._law.support()
        return (float(low), float(high)) if self.bounds is None else self.bounds

    @cached_property
    def ends(self) -> tuple[float, float]:
        """Least and greatest value that is ever drawn."""
        low, high = self.spread(np.array([0.0, 1.0]))
        return (float(low), float(high))

    @cached_property
    def _law(self) -> rv_frozen:
        """The same in scipy's words; a normal distribution truncated."""
        from scipy import stats

        if self.kind == "normal":
            mean, sd = self.numbers
            if self.bounds is None:
                return stats.norm(mean, sd)
            return stats.truncnorm(*((end - mean) / sd for end in self.bounds), loc=mean, scale=sd)
        if self.kind == "triangular":
            low, mode, high = self.numbers
            return stats.triang((mode - low) / (high - low), loc=low, scale=high - low)
        s, scale = self.numbers
        return stats.lognorm(s, scale=scale)

    def spread(self, unit: Array) -> Array:
        """Numbers in [0, 1) as draws, by the inverse of the cumulative distribution."""
        share = np.clip(unit, TAIL, 1.0 - TAIL)
        if self.bounds is None:
            return np.asarray(self._law.ppf(share), dtype=np.float64)
        if self.kind == "lognormal":
            below, above = self._law.cdf(self.bounds)
            share = below + share * (above - below)
        return np.clip(self._law.ppf(share), *self.bounds)


def is_chance(raw: Mapping[Any, Any]) -> bool:
    """Whether a mapping is meant for a distribution: one key, which names one or nearly so."""
    return len(raw) == 1 and isinstance(next(iter(raw.values())), Mapping)


def read_chance(raw: Mapping[Any, Any]) -> Chance:
    """A distribution from `{normal: {mean: 10, sd: 0.5, bounds: [8, 12]}}` and the like, bounds optional.

    Raises:
        StudyError: no such distribution, a key missing or unknown, or numbers that make none.
    """
    kind, given = next(iter(raw.items()))
    if kind not in KEYS:
        raise StudyError("no such distribution", value=kind, cure=nearest(str(kind), KEYS))
    keys = (*KEYS[kind], "bounds") if kind in BOUNDED else KEYS[kind]
    for key in given:
        if key not in keys:
            raise StudyError("unknown key", element=f"{kind}.{key}", cure=nearest(str(key), keys))
    for key in KEYS[kind]:
        if key not in given:
            raise StudyError("is missing", element=f"{kind}.{key}", cure=f"write {FORMS[kind]}")
    numbers = {key: _named(f"{kind}.{key}", given[key]) for key in KEYS[kind]}
    for key in ("sd", "s", "scale"):
        if numbers.get(key, 1.0) <= 0.0:
            raise StudyError("must be more than zero", element=f"{kind}.{key}", value=given[key])
    _ascending(kind, numbers)
    chance = Chance(kind, tuple(numbers.values()), _bounds(kind, given.get("bounds")))
    _some_mass(chance)
    return chance


def _named(element: str, raw: object) -> float:
    try:
        return number(raw)
    except StudyError as error:
        raise StudyError(error.what, element=element, value=error.value) from None


def _ascending(kind: str, numbers: Mapping[str, float]) -> None:
    """Refuse a low that is no lower than the high, and a mode that is not between them."""
    if "low" not in numbers:
        return
    low, high = numbers["low"], numbers["high"]
    if low >= high:
        raise StudyError("low must be less than high", element=kind, value=[low, high])
    if not low <= numbers.get("mode", low) <= high:
        raise StudyError("lies outside low and high", element=f"{kind}.mode", value=numbers["mode"])


def _bounds(kind: str, raw: object) -> tuple[float, float] | None:
    if raw is None:
        return None
    element = f"{kind}.bounds"
    if not isinstance(raw, list | tuple) or len(raw) != 2:
        raise StudyError("should be two numbers", element=element, value=raw, cure="write [low, high]")
    low, high = (_named(element, each) for each in raw)
    if low >= high:
        raise StudyError("low must be less than high", element=element, value=[low, high])
    return low, high


def _some_mass(chance: Chance) -> None:
    """Refuse bounds out in a tail, where the inverse of the distribution has no digits left."""
    if chance.bounds is None:
        return
    from scipy import stats

    first, second = chance.numbers
    law = stats.norm(first, second) if chance.kind == "normal" else stats.lognorm(first, scale=second)
    held = float(law.cdf(chance.bounds[1]) - law.cdf(chance.bounds[0]))
    if held < 1e-6:
        what = f"hold {held:.1e} of the distribution"
        cure = "bounds that cut tails off, or a uniform distribution"
        raise StudyError(what, element=f"{chance.kind}.bounds", value=list(chance.bounds), cure=cure)
