"""How well the tables fix a geometry: directions that nothing fixes, and the interval of each length.

An interval is found by moving one length step by step while all others are fitted anew (the profile), until
a target is missed by more than it leaves open. Every geometry on the way was solved, so an interval is one
that certainly holds; the true one may be wider.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rover_pin.analysis.papers.polibot.planar import LENGTHS
from rover_pin.analysis.papers.polibot.search import FREE, LOWER, UPPER, Fit, closer, evaluated, worst
from rover_pin.analysis.papers.polibot.targets import TARGETS
from rover_pin.numerics import Array

ALL = len(TARGETS)
FIRST, LAST = 0.1, 0.003
"""First and last step of a length, of its bounds."""


@dataclass(frozen=True, eq=False)
class Directions:
    """Singular values of the targets' derivatives, over what each leaves open, by 1 mm and 1 deg.

    Attributes:
        values: (r,) from the largest on: how many times what is left open one mm along the direction moves.
        vectors: (f, f) unit directions in rows over the lengths sought; those past `values` move nothing.
        fixed: directions along which one mm is seen.
        names: the lengths sought.
    """

    values: Array
    vectors: Array
    fixed: int
    names: tuple[str, ...]

    @property
    def rank(self) -> int:
        """Directions that move a target at all."""
        return int(np.sum(self.values > 1e-9 * self.values[0]))

    def largest(self, k: int, count: int = 4) -> dict[str, float]:
        """The largest shares of a direction."""
        row = self.vectors[k]
        order = np.argsort(-np.abs(row))[:count]
        return {self.names[i]: float(row[i]) for i in order}


def directions(fit: Fit, use: int = ALL) -> Directions:
    """What the first `use` targets fix at a geometry."""
    _, values, vectors = np.linalg.svd(fit.slopes[:use, FREE], full_matrices=True)
    return Directions(values, vectors, int(np.sum(values > 1.0)), tuple(LENGTHS[k] for k in FREE))


def interval(fit: Fit, length: int, use: int = ALL) -> tuple[Fit, Fit]:
    """The geometries with the least and the greatest value of a length that meet the first `use` targets."""
    return reach(fit, length, -1.0, use), reach(fit, length, 1.0, use)


def reach(fit: Fit, length: int, sign: float, use: int = ALL) -> Fit:
    """Drive one length as far as the targets are met.

    Args:
        fit: a geometry that meets them.
        length: index into LENGTHS.
        sign: +1 up, -1 down.
        use: targets that count, from the first on.
    """
    span = UPPER[length] - LOWER[length]
    end = UPPER[length] if sign > 0.0 else LOWER[length]
    step = FIRST
    while step >= LAST and fit.lengths[length] != end:
        value = fit.lengths[length] + sign * step * span
        lengths = fit.lengths.copy()
        lengths[length] = min(value, end) if sign > 0.0 else max(value, end)
        tried = closer(evaluated(lengths, fit.start, fit.state), use, held=length, most=15, enough=0.9)
        if worst(tried, use) <= 1.0:
            fit, step = tried, min(2.0 * step, 2.0 * FIRST)
        else:
            step /= 3.0
    return fit
