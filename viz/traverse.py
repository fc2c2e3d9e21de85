"""A traverse as a figure along the path."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.errors import InputError
from rover_pin.viz.motion_plots import LEFT, MANY, RIGHT
from rover_pin.viz.plots import STYLE, new_figure
from rover_pin.viz.units import shown, title_of

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rover_pin.numerics import Array

STOP, LIMIT = "#b5400f", "#d95f02"

GHOSTS = 5
"""Places of the rover in the terrain's profile."""


def plot_traverse(dataset: xr.Dataset) -> Figure:
    """Loads, friction, torque, margins and posture of `rover_pin.analysis.traverse` along the path.

    Beneath is the terrain's profile on the path (filled) and under the wheels (lines) with the paths of the
    wheels' centres, seen from the side, heights and lengths on one scale. Dashed lines are limits; the red
    line is where the rover stops.

    Returns:
        A matplotlib Figure; `figure.savefig("traverse.svg")` writes it.
    """
    import matplotlib as mpl

    way = _stretched(dataset)
    measures = [name for name in str(dataset.attrs["measures"]).split(", ") if name in dataset]
    rows = [_loads, _friction]
    if np.isfinite(dataset["torque_nm"].values).any():
        rows.append(_torque)
    heights = [1.2, 1.0, 1.0][: len(rows)] + [1.0] * len(measures) + [1.1, 1.4]
    with mpl.rc_context(STYLE):
        figure = new_figure(7.0, 0.6 + 1.15 * sum(heights))
        axes = list(figure.subplots(len(heights), 1, sharex=True, height_ratios=heights))
        for draw, axis in zip(rows, axes, strict=False):
            draw(axis, dataset, way)
        for name, axis in zip(measures, axes[len(rows) :], strict=False):
            _margin(axis, dataset, way, name)
        _posture(axes[-2], dataset, way)
        _profile(axes[-1], dataset, way)
        for axis in axes:
            axis.margins(x=0.01)
            if not dataset.attrs["passed"]:
                axis.axvline(float(dataset.attrs["stop_m"]), color=STOP, lw=0.9)
            _, names = axis.get_legend_handles_labels()
            if names:
                axis.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=6.5,
                            handlelength=1.6, labelspacing=0.25)  # fmt: skip
        axes[-1].set_xlabel("along the path [m]")
        figure.align_ylabels(axes)
        figure.suptitle(heading(dataset), fontsize=9)
    return figure


def heading(dataset: xr.Dataset) -> str:
    """What was driven, and whether it is passed."""
    about = dataset.attrs
    ended = "passed"
    if not about["passed"]:
        at = f" at {about['stop_at']}" if about["stop_at"] else ""
        ended = f"stops after {float(about['stop_m']):.3f} m: {about['stop_limit']}{at}"
    return f"{about['robot']} on {about['terrain']}: {ended}"


def _stretched(dataset: xr.Dataset) -> Array:
    """(steps,) m along the path."""
    return np.asarray(dataset["way_m"].values, dtype=np.float64)


def _loads(axis: Axes, dataset: xr.Dataset, way: Array) -> None:
    for (colour, dash), name in zip(_colours(dataset), dataset["wheel"].values, strict=True):
        axis.plot(
            way, dataset["load_n"].sel(wheel=name).values, dash, color=colour, lw=1.0, label=_word(name)
        )
    axis.set_ylabel("load [N]")
    axis.set_ylim(bottom=0.0)


def _friction(axis: Axes, dataset: xr.Dataset, way: Array) -> None:
    needed = np.array(dataset["friction_needed"].values, dtype=np.float64)
    needed[~np.isfinite(needed)] = np.nan
    axis.plot(way, needed, color=MANY[0], lw=1.1, label="needed")
    given = dataset.attrs["friction"]
    there = dataset["friction_declared"].values if isinstance(given, str) else np.array([float(given)])
    for value in sorted(set(there.tolist())):
        axis.axhline(value, color=LIMIT, lw=0.8, ls=(0, (4, 2)))
    axis.plot([], [], color=LIMIT, lw=0.8, ls=(0, (4, 2)), label="given")
    axis.set_ylabel("friction [–]")
    axis.set_ylim(bottom=0.0)


def _torque(axis: Axes, dataset: xr.Dataset, way: Array) -> None:
    for (colour, dash), name in zip(_colours(dataset), dataset["wheel"].values, strict=True):
        values = dataset["torque_nm"].sel(wheel=name).values
        if np.isfinite(values).any():
            axis.plot(way, values, dash, color=colour, lw=0.7)
    axis.plot(way, dataset["torque_needed"].values, color="0.1", lw=1.1, label="needed by the most")
    efforts = sorted({value for value in dataset["effort_nm"].values.tolist() if math.isfinite(value)})
    top = float(np.nanmax(dataset["torque_nm"].values, initial=0.0))
    for value in efforts:
        if value < 2.5 * top:
            axis.axhline(value, color=LIMIT, lw=0.8, ls=(0, (4, 2)), label="effort")
    beyond = [value for value in efforts if value >= 2.5 * top]
    if beyond:
        axis.text(0.995, 0.95, f"efforts {beyond[0]:g} N m and more, not drawn", ha="right", va="top",
                  transform=axis.transAxes, fontsize=6.5, color="0.35")  # fmt: skip
    axis.set_ylabel("torque [N m]")
    axis.set_ylim(bottom=0.0)


def _margin(axis: Axes, dataset: xr.Dataset, way: Array, name: str) -> None:
    unit, factor = shown(str(dataset[name].attrs["units"]))
    values = factor * np.asarray(dataset[name].values, dtype=np.float64)
    values[~np.isfinite(values)] = np.nan
    axis.plot(way, values, color=MANY[2], lw=1.1)
    axis.set_ylabel(f"{title_of(name)}\n[{unit}]")
    if np.nanmin(values, initial=0.0) < 0:
        axis.axhline(0.0, color=LIMIT, lw=0.8, ls=(0, (4, 2)))


def _posture(axis: Axes, dataset: xr.Dataset, way: Array) -> None:
    for k, name in enumerate(("roll", "pitch")):
        axis.plot(way, np.degrees(dataset[f"{name}_rad"].values), color=("0.1", "0.5")[k], lw=1.1, label=name)
    lengths = str(dataset["joint_rad"].attrs["in_m"]).split(", ")
    k = 0
    for name in dataset["joint"].values.tolist():
        values = np.asarray(dataset["joint_rad"].sel(joint=name).values, dtype=np.float64)
        if name in lengths or not np.isfinite(values).any() or np.nanmax(values) - np.nanmin(values) < 1e-4:
            continue
        dash = "-" if k < len(MANY) else "--"
        axis.plot(way, np.degrees(values), dash, color=MANY[k % len(MANY)], lw=0.8, label=_word(name))
        k += 1
    axis.set_ylabel("posture [°]")


def _profile(axis: Axes, dataset: xr.Dataset, way: Array) -> None:
    """The ground on the path, and each wheel's centre as far along as it is ahead of the root link."""
    ground = np.asarray(dataset["ground_m"].values, dtype=np.float64)
    floor = float(np.nanmin(ground))
    legs = _directions(dataset)
    ahead = np.einsum("swi,si->sw", _offsets(dataset), legs)
    centres = np.asarray(dataset["wheel_m"].values, dtype=np.float64)
    under = np.asarray(dataset["under_m"].values, dtype=np.float64)
    floor = min(floor, float(np.nanmin(under, initial=floor)))
    for j in range(under.shape[1]):
        axis.plot(way + ahead[:, j], under[:, j], color="#8d8474", lw=0.5)
    axis.fill_between(way, ground, floor - 0.02, color="#d9cdb8", lw=0)
    axis.plot(way, ground, color="#8d8474", lw=0.8)
    radius = dataset["radius_m"].values
    standing = np.flatnonzero(np.isfinite(centres[:, :, 2]).all(axis=1))
    for k in (
        standing[np.unique(np.linspace(0, len(standing) - 1, GHOSTS).astype(int))] if len(standing) else []
    ):
        for (colour, _), x, z, r in zip(
            _colours(dataset), way[k] + ahead[k], centres[k, :, 2], radius, strict=True
        ):
            turn = np.linspace(0.0, math.tau, 40)
            axis.plot(x + r * np.cos(turn), z + r * np.sin(turn), color=colour, lw=0.6)
    for (colour, dash), j in zip(_colours(dataset), range(centres.shape[1]), strict=True):
        axis.plot(way + ahead[:, j], centres[:, j, 2], dash, color=colour, lw=0.6, alpha=0.7)
    axis.set_ylabel("height [m]")
    axis.set_aspect("equal", adjustable="datalim")


def _offsets(dataset: xr.Dataset) -> Array:
    """(steps, wheels, 2) m: from the root link to wheels in plan."""
    here = np.stack([dataset["x_m"].values, dataset["y_m"].values], axis=-1)
    centres = np.asarray(dataset["wheel_m"].values, dtype=np.float64)
    return np.asarray(centres[:, :, :2] - here[:, None, :])


def _directions(dataset: xr.Dataset) -> Array:
    """(steps, 2) unit: the way it drives."""
    angle = np.asarray(dataset["yaw_rad"].values) - float(dataset.attrs["crab_rad"])
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def _colours(dataset: xr.Dataset) -> list[tuple[str, str]]:
    """Blue on the left, green and dashed on the right, the foremost darkest."""
    places = dataset["home_m"].values
    left = places[:, 1] > 0
    rank = [
        sum(1 for there, side in zip(places, left, strict=True) if side == mine and there[0] > at[0])
        for at, mine in zip(places, left, strict=True)
    ]
    count = 1 + max(rank)
    return [
        (_shade(LEFT, k, count), "-") if side else (_shade(RIGHT, k, count), "--")
        for k, side in zip(rank, left.tolist(), strict=True)
    ]


def _shade(shades: tuple[str, ...], k: int, count: int) -> str:
    """The k-th of some wheels' colours; between the shades where there are more wheels than shades."""
    if count <= len(shades):
        return shades[k]
    from matplotlib.colors import LinearSegmentedColormap, to_hex

    return to_hex(LinearSegmentedColormap.from_list("side", shades)(k / (count - 1)))


def _word(name: object) -> str:
    return str(name).replace("_", " ")


def save_traverse_plot(dataset: xr.Dataset, path: str | Path) -> Path:
    """Write the figure, whole or not at all; the suffix says how.

    Raises:
        InputError: neither .png, .svg nor .pdf, or the place cannot be written to.
    """
    from rover_pin.analysis.store import atomically

    file = Path(path)
    kind = plot_format(file)
    figure = plot_traverse(dataset)
    atomically(file, lambda stream: figure.savefig(stream, format=kind))
    return file


def plot_format(file: Path) -> str:
    """What a figure's suffix says.

    Raises:
        InputError: no known one.
    """
    kind = file.suffix.lower().removeprefix(".")
    if kind not in ("png", "svg", "pdf"):
        raise InputError("is no picture", file=file, element="plot", cure="name it .png, .svg or .pdf")
    return kind
