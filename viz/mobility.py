"""The picture of a mobility map: the worst and the best heading at every place, and the rover to scale."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.numerics import Array
from rover_pin.viz.footprint import footprint
from rover_pin.viz.plots import STYLE, colour_scale, new_figure
from rover_pin.viz.units import shown, title_of

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rover_pin.rover import Rover
    from rover_pin.terrain import Terrain

NO_ANSWER: Any = {"facecolor": "0.90", "edgecolor": "0.68", "hatch": "/////", "linewidth": 0.0}
IN_PART = "....."
PANEL = 3.3  # inches, the longer side of the map
CONTOURS = 6


def plot_mobility(dataset: xr.Dataset, rover: Rover | None = None, terrain: Terrain | None = None) -> Figure:
    """Two maps on one scale: each place's worst heading and its best.

    Places where no heading settles are grey and hatched; dots mark, in the map of the worst headings, places
    where some headings do not settle.

    Args:
        dataset: of `rover_pin.analysis.mobility`.
        rover: drawn from above in the corner, to the scale of the map; left out where None.
        terrain: for contours of the ground; none are drawn without it.

    Returns:
        A matplotlib Figure; `figure.savefig("map.png")` writes it.
    """
    import matplotlib as mpl
    from matplotlib.ticker import MaxNLocator

    unit, factor = shown(str(dataset["worst"].attrs["units"]))
    better = str(dataset["worst"].attrs["better"])
    values = {name: factor * dataset[name].values for name in ("worst", "best")}
    edges = _edges(dataset)
    wide = (edges[1] - edges[0]) > 1.6 * (edges[3] - edges[2])
    with mpl.rc_context({**STYLE, "hatch.linewidth": 0.5, "hatch.color": "0.62"}):
        figure, panels = _panels(edges, wide)
        both = np.concatenate([each.ravel() for each in values.values()])
        norm, colours = colour_scale(both, better)
        for axes, (name, each) in zip(panels, values.items(), strict=True):
            axes.patch.set(**NO_ANSWER)
            finite = np.clip(each, norm.vmin, norm.vmax)  # what fails closed is as bad as the scale goes
            image = axes.imshow(
                finite, origin="lower", extent=edges, norm=norm, cmap=colours, interpolation="nearest"
            )
            axes.xaxis.set_major_locator(MaxNLocator(5))
            axes.yaxis.set_major_locator(MaxNLocator(5))
            axes.set(xlabel="x [m]", title=f"{name} heading", aspect="equal")
            step = 0.0 if terrain is None else _contours(axes, edges, terrain)
        for axes in panels[: 2 if wide else 1]:
            axes.set_ylabel("y [m]")
        partly = (dataset["settled_share"].values > 0) & (dataset["settled_share"].values < 1)
        _mark(panels[0], dataset, partly)
        if rover is not None:
            _draw_rover(panels[1], rover, edges)
        _legend(figure, bool(np.isnan(values["best"]).any()), bool(partly.any()), step)
        title = title_of(str(dataset.attrs["measure"]), {"long_name": str(dataset.attrs["measure"])})
        bar = figure.colorbar(image, ax=list(panels), shrink=0.85, aspect=30, extend=_extend(both, norm))
        bar.set_label(f"{title} [{unit}], {better}er is better")
        figure.suptitle(
            f"{title} of {dataset.attrs['robot']} on {dataset.attrs['terrain']}, "
            f"{dataset.attrs['headings']} headings at each place",
            fontsize=9,
        )
    return figure


def _edges(dataset: xr.Dataset) -> tuple[float, float, float, float]:
    """Left, right, lower, upper edge of the cells, m."""
    x, y = (np.asarray(dataset[name].values, dtype=np.float64) for name in ("x", "y"))
    step = float(dataset.attrs["spacing"])
    halves = [0.5 * float(v[1] - v[0]) if len(v) > 1 else 0.5 * step for v in (x, y)]
    return x[0] - halves[0], x[-1] + halves[0], y[0] - halves[1], y[-1] + halves[1]


def _panels(edges: tuple[float, float, float, float], wide: bool) -> tuple[Figure, list[Axes]]:
    """Two panels beside each other; one above the other where the map is wide."""
    across, up = edges[1] - edges[0], edges[3] - edges[2]
    scale = PANEL / max(across, up) * (1.6 if wide else 1.0)
    columns, rows = (1, 2) if wide else (2, 1)
    width, height = (
        max(columns * (scale * across + 0.55) + 0.9, 4.2),
        max(rows * (scale * up + 0.5) + 0.7, 2.6),
    )
    figure = new_figure(width, height)
    made: Any = figure.subplots(rows, columns, sharex=True, sharey=True)
    return figure, list(made.ravel())


def _mark(axes: Axes, dataset: xr.Dataset, partly: Any) -> None:
    """Dots over the places where some headings do not settle."""
    if partly.any() and min(partly.shape) > 1:
        marks = axes.contourf(
            dataset["x"].values,
            dataset["y"].values,
            partly.astype(np.float64),
            levels=[0.5, 1.5],
            colors="none",
            hatches=[IN_PART],
        )
        marks.set(edgecolor="0.95", linewidth=0.0)


def _contours(axes: Axes, edges: tuple[float, float, float, float], terrain: Terrain) -> float:
    """Lines of equal height; returns the step between them, m, or 0 where the ground is level."""
    from matplotlib.ticker import MaxNLocator

    X, Y = np.meshgrid(np.linspace(*edges[:2], 240), np.linspace(*edges[2:], 240))
    heights = terrain.height(X, Y)
    if float(np.ptp(heights)) < 1e-9:
        return 0.0
    levels = MaxNLocator(CONTOURS).tick_values(float(heights.min()), float(heights.max()))
    axes.contour(X, Y, heights, levels=levels, colors="k", linewidths=0.3, linestyles="solid", alpha=0.5)
    return float(levels[1] - levels[0])


def _draw_rover(axes: Axes, rover: Rover, edges: tuple[float, float, float, float]) -> None:
    """The rover from above in the lower left corner, heading along +x."""
    from matplotlib.patches import Circle, Polygon, Rectangle

    shape = footprint(rover)
    xmin, xmax, ymin, ymax = shape.bounds
    pad = 0.02 * (edges[1] - edges[0])
    shift = np.array([edges[0] + 2 * pad - xmin, edges[2] + 2 * pad - ymin])
    corner = edges[0] + pad, edges[2] + pad
    size = xmax - xmin + 2 * pad, ymax - ymin + 2 * pad
    axes.add_patch(Rectangle(corner, *size, facecolor="w", edgecolor="0.3", linewidth=0.5, zorder=4))
    if len(shape.body):
        axes.add_patch(
            Polygon(shape.body + shift, facecolor="0.75", edgecolor="0.35", linewidth=0.4, zorder=5)
        )
    for corners in shape.wheels:
        axes.add_patch(Polygon(corners + shift, facecolor="0.15", linewidth=0.0, zorder=6))
    for x, y, radius in shape.feet:
        axes.add_patch(
            Circle((x + shift[0], y + shift[1]), radius, facecolor="0.15", linewidth=0.0, zorder=6)
        )
    axes.annotate(
        "rover, to scale",
        (corner[0] + size[0], corner[1] + 0.5 * size[1]),
        xytext=(4, 0),
        textcoords="offset points",
        va="center",
        fontsize=7,
        zorder=6,
        bbox={"facecolor": "w", "edgecolor": "none", "alpha": 0.8, "pad": 1.0},
    )


def _legend(figure: Figure, none: bool, partly: bool, step: float) -> None:
    """What grey, dots and lines mean, where they occur."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    marks: list[Any] = []
    if none:
        marks.append(Patch(**NO_ANSWER, label="no heading settles"))
    if partly:
        words = "some headings do not settle"
        marks.append(Patch(facecolor="w", edgecolor="0.5", linewidth=0.0, hatch=IN_PART, label=words))
    if step:
        label = f"heights of the ground, {step:.3g} m apart"
        marks.append(Line2D([], [], color="0.3", linewidth=0.5, label=label))
    if marks:
        figure.legend(handles=marks, loc="outside lower center", ncols=3, frameon=False, fontsize=7)


def _extend(values: Array, norm: Any) -> Any:
    """Which ends of the colour bar stand for more than they say."""
    known = values[~np.isnan(values)]
    low, high = bool((known < norm.vmin).any()), bool((known > norm.vmax).any())
    return {(True, True): "both", (True, False): "min", (False, True): "max"}.get((low, high), "neither")
