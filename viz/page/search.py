"""The page of a search: the best design beside the nominal one, the trials, what was gained where."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.viz.page.html import write_whole
from rover_pin.viz.page.sheet import card, drawing, preformatted, sheet, table
from rover_pin.viz.plots import STYLE, new_figure

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

    from rover_pin.numerics import Array

KEPT, BROKEN, BEST = "#0b57a4", "0.72", "#d6007f"


def save_search_page(data: xr.Dataset, path: str | Path) -> Path:
    """Write the page of a search: one offline HTML file, whole or not at all.

    Args:
        data: of `rover_pin.analysis.search`.
        path: of the file.

    Raises:
        InputError: the file cannot be written.
    """
    return write_whole(path, search_page(data).encode("utf-8"))


def search_page(data: xr.Dataset) -> str:
    """The page's HTML text."""
    from rover_pin.analysis.search_report import compared

    told = compared(data)
    head = ["", "unit", "nominal", "best"]
    best = int(data.attrs["best_trial"])
    title = f"{data.attrs['title']}: search"
    count, kept = data.sizes["trial"], int((data.violation.values <= 0).sum())
    found = f"best is trial {best}" if best >= 0 else "none keeps every bound: the nearest is shown"
    subtitle = f"{count} trials, {kept} keep every bound; {found}"
    cards = [
        card("Design", table(head, told["design"])),
        card("Figures", table(head, told["figures"]), "means over the places, where there are several"),
        card(
            "Trials",
            drawing(history(data), "objective of each trial"),
            "blue keeps every bound, grey does not",
        ),
        card("Parameters", drawing(scatter(data), "objective over each parameter")),
        card("Study file", preformatted(str(data.attrs["study"]))),
    ]
    return sheet(title, subtitle, cards)


def history(data: xr.Dataset) -> Figure:
    """The objective over the trials, and the best so far among those that keep every bound."""
    import matplotlib as mpl

    worth, kept = _worth(data)
    sign = 1.0 if data.attrs["better"] == "low" else -1.0
    with mpl.rc_context(STYLE):
        figure = new_figure(4.6, 2.6)
        axes = figure.add_subplot()
        _points(axes, np.arange(float(len(worth))), worth, kept, int(data.attrs["best_trial"]))
        so_far = sign * np.fmin.accumulate(np.where(kept, sign * worth, np.nan))
        axes.step(np.arange(float(len(worth))), so_far, where="post", color=KEPT, linewidth=1)
        axes.set(xlabel="trial", ylabel=str(data.attrs["goal"]).replace("_", " "))
    return figure


def scatter(data: xr.Dataset) -> Figure:
    """The objective over each parameter that was searched."""
    import matplotlib as mpl

    from rover_pin.analysis.figures import parameter_units, parameters_of

    worth, kept = _worth(data)
    each = int(data.attrs["places"])
    moved = {name: v[::each] for name, v in parameters_of(data).items() if np.ptp(v) > 0}
    units = parameter_units(data)
    columns = min(3, max(len(moved), 1))
    rows = -(-len(moved) // columns) or 1
    with mpl.rc_context(STYLE):
        figure = new_figure(2.3 * columns, 1.9 * rows)
        for k, (name, values) in enumerate(moved.items()):
            axes = figure.add_subplot(rows, columns, k + 1)
            _points(axes, values, worth, kept, int(data.attrs["best_trial"]))
            axes.set(xlabel=f"{name.replace('_', ' ')}{f' [{units[name]}]' if units[name] else ''}")
            if k % columns == 0:
                axes.set(ylabel=str(data.attrs["goal"]).replace("_", " "))
    return figure


def _worth(data: xr.Dataset) -> tuple[Array, Any]:
    """Objectives, NaN where a design never settled, and which keep every bound."""
    from rover_pin.analysis.search_score import NOTHING

    worth = np.array(data.objective.values, dtype=np.float64)
    worth[np.abs(worth) >= NOTHING] = np.nan
    return worth, data.violation.values <= 0


def _points(axes: Any, x: Array, worth: Array, kept: Any, best: int) -> None:
    axes.plot(x[~kept], worth[~kept], "o", color=BROKEN, markersize=2.5, markeredgewidth=0)
    axes.plot(x[kept], worth[kept], "o", color=KEPT, markersize=3, markeredgewidth=0)
    if best >= 0:
        axes.plot(x[best], worth[best], "o", color=BEST, markersize=5, markeredgewidth=0)
