"""The plots of a motion's page: which panels, which lines, each thinned with its extremes kept."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.numerics import Array
from rover_pin.simulation.series import clearance
from rover_pin.viz.page.thin import line

if TYPE_CHECKING:
    from rover_pin.simulation.run import Run

POINTS = 1200
"""A line's points, about two a pixel."""


@dataclass(frozen=True)
class Curve:
    """One line of a panel.

    Attributes:
        panel: key of the panel.
        name: in the panel's legend.
        part: which row of a constraint; -1 is the worst of them, and every other line.
        values: (n,) in the panel's unit, NaN where there is nothing.
    """

    panel: str
    name: str
    part: int
    values: Array


PANELS = {
    "indices": ("Motion constraints", "index, limit at 1", 1.0),
    "loads": ("Wheel loads", "N", None),
    "clearance": ("Belly clearance", "mm", None),
    "attitude": ("Attitude", "°", None),
    "drift": ("Wheel drift", "mm, slid since the start", None),
}


def curves(run: Run) -> Iterator[Curve]:
    """Every line that the run has values for."""
    for name, index in run.indices.items():
        yield from _index(name, np.abs(np.asarray(index, dtype=np.float64)).reshape(len(run.time), -1))
    for name, load in run.loads.items():
        yield Curve("loads", name, -1, np.asarray(load, dtype=np.float64))
    height = clearance(run)
    if height is not None:
        yield Curve("clearance", "belly", -1, 1000 * height)
    turned = np.degrees(np.asarray(run.configuration, dtype=np.float64)[:, [5, 4]])
    for name, angle in zip(("roll", "pitch"), turned.T, strict=True):
        yield Curve("attitude", name, -1, angle)
    if run.drift is not None:
        names = [shape.name for shape in run.rover.shapes][: run.drift.shape[1]]
        for name, slid in zip(names, np.asarray(run.drift, dtype=np.float64).T, strict=True):
            yield Curve("drift", name, -1, 1000 * slid)


def worst_part(index: Array) -> Array:
    """(n,) the largest of an index's parts (n, parts) that were evaluated; NaN where none was."""
    if index.shape[1] == 0:
        return np.full(len(index), np.nan)
    held: Array = np.where(np.isnan(index), -np.inf, index).max(axis=1)
    return np.where(np.isnan(index).all(axis=1), np.nan, held)


def _index(name: str, index: Array) -> Iterator[Curve]:
    yield Curve("indices", name, -1, worst_part(index))
    if index.shape[1] > 1:
        for part, values in enumerate(index.T):
            yield Curve("indices", name, part, values)


def packed_curves(run: Run, most: int = POINTS) -> tuple[list[dict[str, Any]], bytes]:
    """What the page needs to know of every line, and their points: per line its times, then its values.

    Lines without any value are left out. Times are in s since the first, as float32.
    """
    time = np.asarray(run.time, dtype=np.float64) - float(run.time[0])
    about: list[dict[str, Any]] = []
    parts: list[bytes] = []
    for curve in curves(run):
        if np.isnan(curve.values).all():
            continue
        times, values = line(time, curve.values, most)
        about.append(
            {"panel": curve.panel, "name": curve.name, "part": curve.part, "count": len(times),
             "highest": _largest(curve.values)}
        )  # fmt: skip
        parts += [times.astype("<f4").tobytes(), values.astype("<f4").tobytes()]
    return about, b"".join(parts)


def _largest(values: Array) -> float | None:
    finite = values[np.isfinite(values)]
    return float(finite.max()) if len(finite) else None
