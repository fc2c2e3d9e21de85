"""Figures of a study for papers: a map of a margin, and how margins and loads spread."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.errors import InputError, StudyError
from rover_pin.numerics import Array
from rover_pin.viz.page.measured import main_measure, measures_of
from rover_pin.viz.units import shown, title_of

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rover_pin.terrain import Terrain

STYLE: Any = {
    "font.size": 8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.7,
    "svg.fonttype": "none",  # text stays text
}
STATISTICS = {"worst": 0.0, "median": 0.5, "best": 1.0}


def new_figure(width: float, height: float) -> Figure:
    """A figure on its own Agg canvas: no window system, no pyplot, nothing to close."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure as MatplotlibFigure

    figure = MatplotlibFigure(figsize=(width, height), layout="constrained", dpi=200)
    FigureCanvasAgg(figure)
    return figure


def cell_values(
    dataset: xr.Dataset, measure: str, statistic: str = "worst"
) -> tuple[Array, Array, Array, Array]:
    """A measure over cells of the map that are square or nearly so, five cases a cell on average.

    Returns:
        Edges along x (nx + 1,) and y (ny + 1,) in m; values (ny, nx) in the measure's SI unit, NaN where no
        case of the cell has an answer; number of cases (ny, nx).
    """
    x, y = (np.asarray(dataset[name].values, dtype=np.float64) for name in ("x_m", "y_m"))
    reach = max(float(np.ptp(x)), float(np.ptp(y)), 1e-3)
    area = max(float(np.ptp(x) * np.ptp(y)), 1e-6)
    size = max(np.sqrt(area / max(min(len(x) / 5, 4000), 1)), reach / 160)
    xs, ys = (_edges(v, size) for v in (x, y))
    nx, ny = len(xs) - 1, len(ys) - 1
    i, j = (np.clip(np.searchsorted(e, v, "right") - 1, 0, len(e) - 2) for e, v in ((xs, x), (ys, y)))
    cell = j * nx + i
    sign = 1.0 if dataset[measure].attrs["better"] == "high" else -1.0
    values = sign * np.asarray(dataset[measure].values, dtype=np.float64)
    usable = (dataset["status"].values.astype(str) == "settled") & ~np.isnan(values)
    out = np.full(nx * ny, np.nan)
    order = np.lexsort((values[usable], cell[usable]))
    sorted_cell, sorted_values = cell[usable][order], values[usable][order]
    for k, group in zip(*_groups(sorted_cell), strict=True):
        out[k] = sorted_values[group.start + int(STATISTICS[statistic] * (group.stop - group.start - 1))]
    counts = np.bincount(cell, minlength=nx * ny).astype(np.float64)
    return xs, ys, (sign * out).reshape(ny, nx), counts.reshape(ny, nx)


def _edges(v: Array, size: float) -> Array:
    """Edges of cells of about this size that just cover the values."""
    count = max(1, round(float(np.ptp(v)) / size))
    return np.linspace(v.min(), v.max() if np.ptp(v) > 0 else v.min() + size, count + 1)


def _groups(keys: Any) -> tuple[list[int], list[slice]]:
    """Runs of equal keys in a sorted array."""
    found, starts = np.unique(keys, return_index=True)
    ends = [*starts[1:], len(keys)][: len(starts)]
    return [int(k) for k in found], [slice(int(a), int(b)) for a, b in zip(starts, ends, strict=True)]


def plot_map(
    dataset: xr.Dataset,
    measure: str | None = None,
    *,
    statistic: str = "worst",
    terrain: Terrain | None = None,
) -> Figure:
    """A map of a measure: square cells, crosses where no case has an answer, contours of the ground.

    Args:
        dataset: of a Study.
        measure: its name; None takes the one that says most about tipping.
        statistic: `worst`, `median` or `best` of a cell's cases.
        terrain: for contours; none are drawn without it.

    Returns:
        A matplotlib Figure; `figure.savefig("map.svg")` writes it.

    Raises:
        StudyError: the dataset has no such measure, or none.
        InputError: no such statistic.
    """
    import matplotlib as mpl

    name = main_measure(dataset, measure)
    if name not in dataset:
        raise StudyError("the study has no measure to map", cure="run it with measures: [tip]")
    if statistic not in STATISTICS:
        raise InputError(
            "no such statistic", element="statistic", value=statistic, cure="use worst, median or best"
        )
    xs, ys, values, counts = cell_values(dataset, name, statistic)
    unit, factor = shown(str(dataset[name].attrs.get("units", "")))
    better = str(dataset[name].attrs["better"])
    with mpl.rc_context(STYLE):
        figure = new_figure(4.2, 3.6)
        axes = figure.add_subplot()
        norm, colours = colour_scale(factor * values, better)
        image = axes.pcolormesh(xs, ys, factor * values, norm=norm, cmap=colours, rasterized=True)
        _crosses(axes, xs, ys, values, counts)
        if terrain is not None:
            X, Y = np.meshgrid(np.linspace(xs[0], xs[-1], 240), np.linspace(ys[0], ys[-1], 240))
            axes.contour(X, Y, terrain.height(X, Y), levels=12, colors="k", linewidths=0.3, alpha=0.5)
        axes.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
        worse = "low" if better == "high" else "high"
        label = f"{title_of(name, dataset[name].attrs)} [{unit}], {statistic} of a cell, {worse} is worse"
        figure.colorbar(image, ax=axes, label=label, shrink=0.85)
    return figure


def colour_scale(values: Array, better: str) -> tuple[Any, str]:
    """Norm and colour map: PuOr about zero for both signs (orange is worse), else cividis (dark is worse)."""
    from matplotlib.colors import Normalize

    finite = values[np.isfinite(values)]
    low, high = (float(v) for v in np.percentile(finite, [1, 99])) if len(finite) else (0.0, 1.0)
    turned = "" if better == "high" else "_r"
    if low < 0 < high:
        far = max(-low, high)
        return Normalize(-far, far), "PuOr" + turned
    return Normalize(low, high if high > low else low + 1.0), "cividis" + turned


def _crosses(axes: Axes, xs: Array, ys: Array, values: Array, counts: Array) -> None:
    middle_x, middle_y = np.meshgrid((xs[1:] + xs[:-1]) / 2, (ys[1:] + ys[:-1]) / 2)
    none = np.isnan(values) & (counts > 0)
    if none.any():
        axes.plot(middle_x[none], middle_y[none], "x", color="0.55", markersize=2.5, markeredgewidth=0.6)
        axes.plot([], [], "x", color="0.55", markersize=3.5, label="no answer")
        axes.legend(
            loc="lower left", bbox_to_anchor=(0.0, 1.0), frameon=False, borderpad=0, handletextpad=0.2
        )


def plot_distributions(dataset: xr.Dataset) -> Figure:
    """Histograms of every measure over the settled cases, and each wheel's load as a box (5 to 95 %).

    Returns:
        A matplotlib Figure; `figure.savefig("spread.svg")` writes it.
    """
    import matplotlib as mpl

    names = measures_of(dataset)
    settled = dataset["status"].values.astype(str) == "settled"
    panels = len(names) + 1
    columns = min(3, panels)
    rows = -(-panels // columns)
    with mpl.rc_context(STYLE):
        figure = new_figure(2.25 * columns, 1.55 * rows)
        for k, name in enumerate(names):
            _histogram(figure.add_subplot(rows, columns, k + 1), dataset[name], settled)
        _boxes(figure.add_subplot(rows, columns, panels), dataset, settled)
    return figure


def _histogram(axes: Axes, values: xr.DataArray, settled: Any) -> None:
    unit, factor = shown(str(values.attrs.get("units", "")))
    kept = factor * np.asarray(values.values, dtype=np.float64)[settled]
    kept = kept[np.isfinite(kept)]
    better = {"high": "→ better", "low": "← better"}[str(values.attrs["better"])]
    axes.set(xlabel=f"{title_of(str(values.name), values.attrs)} [{unit}]  {better}", yticks=[])
    axes.spines["left"].set_visible(False)
    if not len(kept):
        axes.text(0.5, 0.5, "no settled case has it", ha="center", transform=axes.transAxes, color="0.4")
        return
    low, high = np.percentile(kept, [0.5, 99.5])
    axes.hist(kept, bins=40, range=(low, high), color="0.55")
    for share in (5, 50):
        axes.axvline(
            float(np.percentile(kept, share)),
            color="#0b57a4",
            linewidth=0.9,
            linestyle=":" if share == 5 else "-",
        )


def _boxes(axes: Axes, dataset: xr.Dataset, settled: Any) -> None:
    loads = np.asarray(dataset["load_n"].values, dtype=np.float64)[settled]
    names = [str(name) for name in dataset["wheel"].values]
    columns = [column[np.isfinite(column)] for column in loads.T]
    boxes = axes.boxplot(columns, whis=(5, 95), showfliers=False, widths=0.55, patch_artist=True)
    for box in boxes["boxes"]:
        box.set(facecolor="0.85", edgecolor="0.35", linewidth=0.7)
    for line in boxes["medians"]:
        line.set(color="#0b57a4", linewidth=1.2)
    axes.set_xticks(range(1, len(names) + 1), names)
    axes.set(ylabel="load [N]", xlabel="wheel")
    axes.set_ylim(bottom=0)
