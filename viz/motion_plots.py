"""A motion as a figure for papers: constraint indices, loads, clearance, attitude and drift against time."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.numerics import Array
from rover_pin.simulation.check import checked_run
from rover_pin.simulation.series import Span, spans
from rover_pin.viz.page.curves import PANELS, Curve, curves
from rover_pin.viz.page.motion import wheel_sides
from rover_pin.viz.page.thin import line
from rover_pin.viz.plots import STYLE, new_figure

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rover_pin.simulation.run import Run

MANY = (
    "#0b57a4", "#d95f02", "#1b9e77", "#7b3294", "#a6761d", "#d6007f",
    "#3f9fd8", "#4d5a66", "#8c2d04", "#00665e", "#b15fb5",
)  # fmt: skip
LEFT = ("#08417c", "#2f7fcc", "#8dbbe8")
RIGHT = ("#00573f", "#189b74", "#86cdb6")
POINTS = 2400
LABELS = {
    "indices": "index [–]",
    "loads": "load [N]",
    "clearance": "clearance [mm]",
    "attitude": "attitude [°]",
    "drift": "drift [mm]",
}
CUT = 2.0
"""Times the limit: where a panel ends."""

TOGETHER = 0.012
"""Share of the run within which changes of action are named together."""

CROWDED = 14
"""So many changes of action are named by letters, with a key below."""


def plot_run(run: Run) -> Figure:
    """A run against time: what the log has of indices, loads, clearance, attitude and drift, one panel each.

    Triangles on the first panel's axis mark where another action starts, with its name, or where there are
    many with a letter and a key below. An index is the largest of its constraint's parts; the dashed line at
    1 is its limit. Wheels of the left are drawn in blue, of the right in green and dashed, the foremost
    darkest. Values known every so many samples are joined; a line breaks where they are silent for longer.

    Returns:
        A matplotlib Figure; `figure.savefig("run.svg")` writes it.

    Raises:
        InputError: the run has no sample, or parts that do not fit (see `checked_run`).
    """
    import matplotlib as mpl

    checked_run(run)
    drawn: dict[str, list[Curve]] = {}
    for curve in curves(run):
        if curve.part < 0 and not np.isnan(curve.values).all():
            drawn.setdefault(curve.panel, []).append(curve)
    panels = [key for key in PANELS if key in drawn]
    heights = [1.7 if key == "indices" else 1.0 for key in panels]
    with mpl.rc_context(STYLE):
        figure = new_figure(6.4, 0.9 + 1.05 * sum(heights))
        axes = figure.subplots(len(panels), 1, sharex=True, squeeze=False, height_ratios=heights)[:, 0]
        for key, axis in zip(panels, axes, strict=True):
            _panel(axis, run, key, drawn[key])
        axes[-1].set_xlabel("time [s]")
        figure.align_ylabels(list(axes))
        _changes(figure, list(axes), run)
    return figure


def _panel(axes: Axes, run: Run, key: str, lines: Sequence[Curve]) -> None:
    time = np.asarray(run.time, dtype=np.float64)
    styles = _styles(run, key, lines)
    for curve, (colour, dash) in zip(lines, styles, strict=True):
        t, v = line(time, curve.values, POINTS)
        mark: Any = {"marker": "o", "markersize": 2.5} if np.count_nonzero(~np.isnan(v)) == 1 else {}
        label = curve.name.replace("_", " ")
        axes.plot(t, np.ma.masked_invalid(v), dash, color=colour, linewidth=1.0, label=label, **mark)
    axes.set_ylabel(LABELS[key])
    limit = PANELS[key][2]
    if limit is not None:
        axes.axhline(limit, color="#d95f02", linewidth=0.8, linestyle=(0, (4, 2)))
        _cut(axes, lines, limit)
    axes.margins(x=0.01)
    if len(lines) > 1 or key == "indices":
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=6.5,
                    handlelength=1.6, labelspacing=0.25)  # fmt: skip


def _cut(axes: Axes, lines: Sequence[Curve], limit: float) -> None:
    """From 0 to a little above all, at most to twice the limit; what is above is said."""
    finite: Array = np.concatenate([curve.values[np.isfinite(curve.values)] for curve in lines])
    highest = float(finite.max()) if len(finite) else limit
    axes.set_ylim(0.0, min(max(1.15 * limit, 1.05 * highest), CUT * limit))
    if highest > CUT * limit:
        axes.text(0.995, 0.97, f"cut at {CUT * limit:g}; highest {highest:.3g}", ha="right", va="top",
                  transform=axes.transAxes, fontsize=6.5, color="0.25")  # fmt: skip


def _styles(run: Run, key: str, lines: Sequence[Curve]) -> list[tuple[str, str]]:
    """Colour and dash of every line: wheels by side and place, others one after the other."""
    if key not in ("loads", "drift"):
        return [(MANY[k % len(MANY)], "-" if k < len(MANY) else "--") for k in range(len(lines))]
    sides = {shape.name: side for shape, side in zip(run.rover.shapes, wheel_sides(run.rover), strict=True)}
    found = [(sides[curve.name]["left"], min(sides[curve.name]["rank"], 2)) for curve in lines]
    return [(LEFT[rank], "-") if left else (RIGHT[rank], "--") for left, rank in found]


def _changes(figure: Figure, axes: Sequence[Axes], run: Run) -> None:
    """Triangles and names where actions start; a thin line there through every panel."""
    starts = [span for span in spans(run.actions) if span.word]
    if not starts:
        return
    first = axes[0]
    across = first.get_xaxis_transform()
    for span in starts:
        at = float(run.time[span.first])
        first.plot([at], [1.0], "v", color="0.25", markersize=4, transform=across, clip_on=False)
        for axis in axes if span.first else ():
            axis.axvline(at, color="0.85", linewidth=0.6, zorder=0)
    words = list(dict.fromkeys(span.word for span in starts))
    places = _places(run, starts)
    crowded = len(places) > CROWDED or _narrow(run, list(places))
    for at, several in places.items():
        word = " ".join(_letter(words.index(w)) for w in several) if crowded else ", ".join(several)
        turned: Any = {"ha": "center"} if crowded else {"rotation": 30.0, "ha": "left"}
        first.annotate(word, (at, 1.0), (0, 5), xycoords=across, textcoords="offset points", fontsize=6.5,
                       va="bottom", **turned)  # fmt: skip
    if crowded:
        key = "    ".join(f"{_letter(k)}  {word}" for k, word in enumerate(words))
        figure.supxlabel(key, fontsize=6.5, color="0.25", wrap=True)


def _places(run: Run, starts: Sequence[Span[str]]) -> dict[float, list[str]]:
    """Words by the time they stand at; those that start at almost the same time stand together."""
    span = float(run.time[-1] - run.time[0])
    places: dict[float, list[str]] = {}
    at = -np.inf
    for start in starts:
        time = float(run.time[start.first])
        at = time if time - at > TOGETHER * span else at
        places.setdefault(at, []).append(start.word)
    return places


def _narrow(run: Run, places: Sequence[float]) -> bool:
    """Whether names would lie on each other."""
    span = float(run.time[-1] - run.time[0])
    return any(b - a < 0.045 * span for a, b in itertools.pairwise(places))


def _letter(k: int) -> str:
    """a to z, then aa, ab, ..."""
    return (_letter(k // 26 - 1) if k >= 26 else "") + chr(ord("a") + k % 26)
