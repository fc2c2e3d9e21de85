"""Slopes at tip and at slip against heading: the polar plot and its page."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.viz.page.html import write_whole
from rover_pin.viz.page.sheet import card, drawing, sheet, table
from rover_pin.viz.plots import STYLE, new_figure

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

    from rover_pin.numerics import Array

TIP, SLIP, STANDS = "#b5400f", "#0b57a4", "#dbe9d8"


def plot_slopes(dataset: xr.Dataset) -> Figure:
    """Polar plot of `rover_pin.analysis.slopes`: slope outwards [deg], heading round, uphill at the top.

    Green is where the rover stands; it tips at the orange line and slips at the blue one. Where it tips
    before it slips there is no blue line.

    Returns:
        A matplotlib Figure; `figure.savefig("slopes.png")` writes it.
    """
    import matplotlib as mpl

    angles = _round(dataset["heading_rad"].values, math.tau)
    tip, slip, stands = (
        _round(np.degrees(dataset[f"{name}_rad"].values)) for name in ("tip", "slip", "stands_to")
    )
    with mpl.rc_context(STYLE):
        figure = new_figure(4.2, 4.6)
        axes: Any = figure.add_subplot(projection="polar")
        axes.set_theta_zero_location("N")
        axes.fill(angles, np.nan_to_num(stands), color=STANDS, lw=0)
        axes.plot(angles, tip, color=TIP, lw=1.6, label="tips")
        if np.isfinite(slip).any():
            axes.plot(angles, slip, color=SLIP, lw=1.6, label="slips")
        largest = float(np.nanmax(np.fmax(tip, slip), initial=1.0))
        axes.set_ylim(0.0, 5.0 * math.ceil(1.05 * largest / 5.0))
        axes.set_rlabel_position(22.5)
        axes.yaxis.set_major_formatter("{x:g}°")
        degrees = range(0, 360, 45)
        words = {0: "0°\nuphill", 180: "180°\ndownhill"}
        axes.set_thetagrids(degrees, [words.get(each, f"{each}°") for each in degrees])
        axes.grid(color="0.85", lw=0.6)
        axes.legend(loc="lower right", bbox_to_anchor=(1.12, -0.1), frameon=False)
        figure.suptitle(
            f"{dataset.attrs['robot']}: slope at tip and at slip, friction {_friction(dataset)}", fontsize=9
        )
    return figure


def save_slopes_html(dataset: xr.Dataset, path: str | Path) -> Path:
    """Write the plot and its numbers as one offline page.

    Raises:
        InputError: the place cannot be written to.
    """
    robot = str(dataset.attrs["robot"])
    note = (
        "The heading is counted in the slope from straight uphill, counterclockwise from above, wheels"
        " braked. It tips at the least slope without a stance, and slips at the least slope that friction"
        " does not hold."
    )
    cards = [
        card(
            "Slope at tip and at slip",
            drawing(plot_slopes(dataset), "polar plot of slopes against heading"),
            note,
        ),
        card("Numbers", table(HEAD, rows(dataset))),
    ]
    asked = dataset.attrs
    subtitle = f"friction {_friction(dataset)}, gravity {asked['gravity']:g} m/s2, posture {asked['posture']}"
    return write_whole(path, sheet(f"{robot} on slopes", subtitle, cards).encode("utf-8"))


WIDE = 1e-3
"""deg; a bracket wider than what is printed is told."""

HEAD = ("heading deg", "tips deg", "by", "how", "slips deg", "at")


def rows(dataset: xr.Dataset) -> list[list[str]]:
    """The numbers for people, a heading each, in the order of `HEAD`."""
    told = []
    for k, heading in enumerate(np.degrees(dataset["heading_rad"].values)):
        words = [
            str(dataset[name].values[k]) or "-" for name in ("tip_limiting", "tip_status", "slip_limiting")
        ]
        told.append(
            [f"{heading:g}", _slope(dataset, "tip", k), *words[:2], _slope(dataset, "slip", k), words[2]]
        )
    return told


def _slope(dataset: xr.Dataset, name: str, k: int) -> str:
    """A slope in degrees, and how much steeper it might be where that is more than what is printed."""
    value, width = (math.degrees(float(dataset[f"{name}{part}_rad"][k])) for part in ("", "_open"))
    if math.isnan(value):
        return "-"
    return f"{value:.3f}" if width <= WIDE else f"{value:.3f} to {value + width:.3f}"


def _friction(dataset: xr.Dataset) -> str:
    given = dataset.attrs["friction"]
    return given if isinstance(given, str) else f"{float(given):g}"


def _round(values: Array, more: float = 0.0) -> Array:
    """Closed: the first value again at the end."""
    return np.append(values, values[0] + more)
