"""What a design is worth: the figure looked for over its cases, and how far it is from its bounds."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping

import numpy as np

from rover_pin.analysis.search_spec import Bounds, SearchSpec
from rover_pin.errors import StudyError, nearest
from rover_pin.numerics import Array

FAR = 1e3
"""Violation of a design that never settles: farther than any that does."""

NOTHING = 1e9
"""What a design that never settles is worth."""


def in_degrees(figures: Mapping[str, Array]) -> dict[str, Array]:
    """Figures, with the angles once more in degrees."""
    angles = {
        f"{name.removesuffix('_rad')}_deg": np.rad2deg(values)
        for name, values in figures.items()
        if name.endswith("_rad")
    }
    return {**figures, **angles}


def check_figures(spec: SearchSpec, known: Iterable[str]) -> None:
    """Refuse names that are no figures.

    Raises:
        StudyError: names the entry, with the nearest name.
    """
    names = list(known)
    stems = {name.partition("/")[0] for name in names}
    for name in (spec.goal, *spec.subject_to):
        allowed = names if name == spec.goal else [*names, *stems]
        if name not in allowed:
            where = "search.subject_to" if name in spec.subject_to else "search"
            raise StudyError("no such figure", element=where, value=name, cure=nearest(name, allowed))


def score(spec: SearchSpec, figures: Mapping[str, Array], settled: Array) -> tuple[float, list[float]]:
    """The worth of one design, and by how much it breaks each bound (0 or less where it keeps it).

    Args:
        spec: what is looked for.
        figures: (k,) over its cases, NaN where one did not settle.
        settled: (k,) which did.

    Returns:
        The figure's mean or worst value over the settled cases; violations, those of bounds as a share of the
        bound's size, the last one the share of cases that did not settle.
    """
    there = np.asarray(settled, dtype=bool)
    if not there.any():
        return spec.sign * NOTHING, [FAR] * (len(spec.subject_to) + 1)
    values = figures[spec.goal][there]
    if not np.isfinite(values).all():
        return spec.sign * NOTHING, [FAR] * (len(spec.subject_to) + 1)
    told = float(values.mean()) if spec.over == "mean" else float(spec.sign * (spec.sign * values).max())
    broken = [_violation(name, bounds, figures, there) for name, bounds in spec.subject_to.items()]
    return told, [*broken, float(1.0 - there.mean())]


def _violation(name: str, bounds: Bounds, figures: Mapping[str, Array], there: Array) -> float:
    """The largest excess over a bound, over the bounds' size."""
    known = [values[there] for key, values in figures.items() if name in (key, key.partition("/")[0])]
    low, high = bounds
    size = max((abs(each) for each in bounds if each), default=1.0)
    worst = -math.inf
    for values in known:
        if low is not None:
            worst = max(worst, float((low - values).max()) / size)
        if high is not None:
            worst = max(worst, float((values - high).max()) / size)
    return FAR if math.isnan(worst) else worst
