"""Figures of a comparison: how a measure spreads in each design, and how two differ case by case."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.analysis.comparison.statistics import both, differences
from rover_pin.numerics import Array
from rover_pin.viz.plots import STYLE, cell_values, new_figure
from rover_pin.viz.units import shown

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rover_pin.analysis.comparison import Comparison
    from rover_pin.analysis.comparison.result import Pair

COLOURS = ("#0b57a4", "#d95f02", "#5d3790", "#8c8878", "#d6007f", "#1d242c")
BINS = 40


def plot_spreads(found: Comparison, measure: str, names: Mapping[str, str]) -> Figure:
    """Every design's distribution of a measure over the cases it answers, one over the other.

    Args:
        found: of `rover_pin.analysis.compare`.
        measure: one that all designs have.
        names: short names by label, for the legend.
    """
    import matplotlib as mpl

    unit, factor = shown(found.units[measure])
    values = {label: factor * _values(found, label, measure) for label in found.labels}
    kept = {label: v[np.isfinite(v)] for label, v in values.items()}
    edges = _edges(np.concatenate(list(kept.values())))
    with mpl.rc_context(STYLE):
        figure = new_figure(3.0, 2.3)
        axes = figure.add_subplot()
        for k, (label, each) in enumerate(kept.items()):
            colour = COLOURS[k % len(COLOURS)]
            axes.hist(each, bins=edges, histtype="step", color=colour, linewidth=1.2, label=names[label])  # type: ignore[arg-type]
            if len(each):
                axes.axvline(float(np.median(each)), color=colour, linewidth=0.9, linestyle=":")
        way = {"high": "→ better", "low": "← better"}[found.better[measure]]
        axes.set(xlabel=f"[{unit}]  {way}", ylabel="cases")
        axes.legend(frameon=False, loc="upper left", bbox_to_anchor=(0, 1.16), ncols=4, borderpad=0)
    return figure


def plot_pair(found: Comparison, pair: Pair, measure: str, names: Mapping[str, str]) -> Figure:
    """Two designs by a measure: one against the other, the differences with their interval, and where.

    Args:
        found: of `rover_pin.analysis.compare`.
        pair: one of its pairs.
        measure: one that all designs have.
        names: short names by label.
    """
    import matplotlib as mpl

    unit, factor = shown(found.units[measure])
    first, second = (_values(found, label, measure) for label in (pair.first, pair.second))
    there = both(first, second) & np.isfinite(first) & np.isfinite(second)
    moved = np.where(there, 0.0, np.nan)
    moved[there] = factor * differences(first[there], second[there])
    a, b = names[pair.first], names[pair.second]
    with mpl.rc_context(STYLE):
        figure = new_figure(8.6, 2.5)
        panels = figure.subplots(1, 3)
        _scatter(panels[0], factor * first[there], factor * second[there], (a, b), unit)
        _histogram(panels[1], found, pair, measure, moved[there], f"{b} - {a} [{unit}]")
        _where(panels[2], found, moved, measure, f"{b} - {a} [{unit}]")
    return figure


def _values(found: Comparison, label: str, measure: str) -> Array:
    return np.asarray(found.datasets[label][measure].values, dtype=np.float64)


def _edges(values: Array) -> Array:
    """Edges of bins over all but half a per cent at either end."""
    low, high = (float(v) for v in np.percentile(values, [0.5, 99.5])) if len(values) else (0.0, 1.0)
    if not high - low > 1e-9 * max(abs(low), abs(high)):
        wide = 0.5 * abs(low) or 0.5
        low, high = low - wide, high + wide
    return np.linspace(low, high, BINS + 1)


def _scatter(axes: Axes, x: Array, y: Array, names: tuple[str, str], unit: str) -> None:
    """Every case; above the line the second has more."""
    axes.plot(x, y, "o", color=COLOURS[0], markersize=1.8, markeredgewidth=0, alpha=0.5, rasterized=True)
    if len(x):
        ends = [min(x.min(), y.min()), max(x.max(), y.max())]
        axes.plot(ends, ends, color="0.5", linewidth=0.7)
    axes.set(xlabel=f"{names[0]} [{unit}]", ylabel=f"{names[1]} [{unit}]")


def _histogram(axes: Axes, found: Comparison, pair: Pair, measure: str, moved: Array, label: str) -> None:
    """The differences, the interval of their median as a band."""
    factor = shown(found.units[measure])[1]
    told = pair.measures[measure]
    axes.hist(moved, bins=_edges(moved), color="0.62")  # type: ignore[arg-type]
    if np.isfinite([told.low, told.high]).all():
        axes.axvspan(factor * told.low, factor * told.high, color=COLOURS[0], alpha=0.25, linewidth=0)
    if np.isfinite(told.median):
        axes.axvline(factor * told.median, color=COLOURS[0], linewidth=1.1)
    axes.axvline(0.0, color="0.2", linewidth=0.7)
    axes.set(xlabel=f"{label}: median, 95 %", ylabel="cases")


def _where(axes: Axes, found: Comparison, moved: Array, measure: str, label: str) -> None:
    """The differences over the map; over the heading where the place does not vary."""
    import xarray as xr
    from matplotlib.colors import Normalize

    data = next(iter(found.datasets.values()))
    spans = [float(np.ptp(data[name].values)) for name in ("x_m", "y_m")]
    if min(spans) <= 0.0:
        axes.plot(np.degrees(data["yaw_rad"].values), moved, "o", color=COLOURS[0], markersize=1.8,
                  markeredgewidth=0, rasterized=True)  # fmt: skip
        axes.axhline(0.0, color="0.2", linewidth=0.7)
        axes.set(xlabel="heading [°]", ylabel=label)
        return
    better = found.better[measure]
    status = np.where(np.isnan(moved), "none", "settled")
    cells = xr.Dataset(
        {"x_m": data["x_m"], "y_m": data["y_m"], "moved": ("case", moved, {"better": better}),
         "status": ("case", status)}
    )  # fmt: skip
    xs, ys, values, _ = cell_values(cells, "moved", "median")
    finite = np.abs(values[np.isfinite(values)])
    far = float(np.percentile(finite, 98)) if len(finite) and finite.max() > 0.0 else 1.0
    colours: Any = "PuOr" if better == "high" else "PuOr_r"
    image = axes.pcolormesh(
        xs, ys, values, norm=Normalize(-far or -1.0, far or 1.0), cmap=colours, rasterized=True
    )
    axes.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
    axes.figure.colorbar(image, ax=axes, label=label, shrink=0.9)
