"""A traverse as a motion, and as a page that plays it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.errors import InputError
from rover_pin.simulation.run import Run
from rover_pin.viz.motion import save_motion_html

if TYPE_CHECKING:
    import xarray as xr

    from rover_pin.numerics import Array
    from rover_pin.rover import Rover
    from rover_pin.terrain import Terrain

PACE = 0.1
"""m/s at which the page plays a path."""

TURNING = 0.5
"""rad/s at which it turns on the spot."""


def traverse_run(dataset: xr.Dataset, rover: Rover, terrain: Terrain) -> Run:
    """The places up to the first without a stance, as a motion at `PACE`, wheels turning.

    Indices are friction needed over given, where that is one for all contacts, and share of the efforts: 1 is
    the limit.

    Args:
        dataset: of `rover_pin.analysis.traverse`.
        rover: that was driven.
        terrain: that it was driven on.

    Raises:
        InputError: it does not stand at the first place.
    """
    settled = dataset["status"].values.astype(str) == "settled"
    count = int(np.argmin(settled)) if not settled.all() else len(settled)
    if count == 0:
        raise InputError(
            "does not stand where the path starts, so there is nothing to play",
            element=str(dataset.attrs["robot"]),
            value=str(dataset["status"].values[0]),
            cure="start elsewhere, or leave the page out",
        )
    data = dataset.isel(step=slice(0, count))
    way, yaw = (np.asarray(data[name].values, dtype=np.float64) for name in ("way_m", "yaw_rad"))
    time = np.concatenate([[0.0], np.cumsum(np.diff(way) / PACE + np.abs(np.diff(yaw)) / TURNING)])
    q = _configurations(data, rover)
    indices: dict[str, Array] = {}
    if (given := _given(data, rover)) is not None:
        needed = np.asarray(data["friction_needed"].values, dtype=np.float64)
        grip = np.where(np.isfinite(needed), needed / given, np.nan)
        indices["friction needed of given"] = grip.reshape(-1, 1)
    if np.isfinite(data["effort_share"].values).any():
        share = np.asarray(data["effort_share"].values, dtype=np.float64)
        indices["torque needed of effort"] = np.where(np.isfinite(share), share, np.nan).reshape(-1, 1)
    passed = bool(dataset.attrs["passed"])
    loads = {str(name): np.asarray(data["load_n"].sel(wheel=name).values) for name in data["wheel"].values}
    return Run(
        rover,
        terrain,
        time,
        q,
        np.zeros_like(q),
        tuple(_actions(data)),
        ((),) * count,
        indices,
        {},
        loads,
        status="done" if passed else "stops",
        reason="" if passed else f"{dataset.attrs['stop_limit']}: {dataset.attrs['stop_why']}",
    )


def _given(data: xr.Dataset, rover: Rover) -> float | None:
    """The friction of all contacts, or None where it differs."""
    if data.attrs["friction"] != "as declared":
        return float(data.attrs["friction"])
    declared = {shape.friction for shape in rover.shapes}
    return declared.pop() if len(declared) == 1 else None


def _configurations(data: xr.Dataset, rover: Rover) -> Array:
    """(steps, nv) q; drives turned by the way, forwards as far as the heading lies along it."""
    way = np.asarray(data["way_m"].values, dtype=np.float64)
    forward = math.cos(float(data.attrs["crab_rad"]))
    q = np.tile(np.array(rover.neutral), (len(way), 1))
    for column, name in enumerate(("x_m", "y_m", "z_m", "yaw_rad", "pitch_rad", "roll_rad")):
        q[:, column] = data[name].values
    for name in data["joint"].values.tolist():
        q[:, rover.column[name]] = data["joint_rad"].sel(joint=name).values
    for wheel in rover.wheels:
        if wheel.drive is not None:
            q[:, rover.column[wheel.drive]] = way * forward / wheel.radius
    return q


def _actions(data: xr.Dataset) -> Sequence[str]:
    """What is done at each step; beyond its stop that is said."""
    stop = float(data.attrs["stop_m"])
    words = []
    stopped = False
    limits: Any = data["limit"].values
    for way, turning, limit in zip(data["way_m"].values, data["turning"].values, limits, strict=True):
        stopped = stopped or (way >= stop and bool(str(limit)))
        words.append("beyond its stop" if stopped else "turn" if turning else "drive")
    return words


def save_traverse_html(dataset: xr.Dataset, rover: Rover, terrain: Terrain, path: str | Path) -> Path:
    """Write a page that plays the path, loads and indices beside it: one offline file, whole or not at all.

    Raises:
        InputError: as `traverse_run`, or the file cannot be written.
    """
    run = traverse_run(dataset, rover, terrain)
    return save_motion_html({"traverse": run}, path, title=f"{dataset.attrs['robot']} along a line")
