"""A study's dataset as the columns of its page."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rover_pin.viz.page.columns import Column, numbers, words
from rover_pin.viz.page.measured import load_measures, measures_of, values_of

if TYPE_CHECKING:
    import xarray as xr

POSE = ("x_m", "y_m", "z_m", "roll_rad", "pitch_rad", "yaw_rad")


def page_columns(dataset: xr.Dataset) -> dict[str, Column]:
    """Every column of the page by its name: `load_n/fl` for one wheel, `tip_limiting` in words."""
    columns = {"status": words(dataset["status"].values)}
    if "reason" in dataset:
        columns["reason"] = words(dataset["reason"].values)
    for name in POSE:
        columns[name] = numbers(dataset[name].values)
    for name in measures_of(dataset):
        columns[name] = numbers(dataset[name].values)
        if f"{name}_limiting" in dataset:
            columns[f"{name}_limiting"] = words(dataset[f"{name}_limiting"].values)
    loads = np.asarray(dataset["load_n"].values, dtype=np.float64)
    for k, wheel in enumerate(dataset["wheel"].values):
        columns[f"load_n/{wheel}"] = numbers(loads[:, k])
    for k, track in enumerate(dataset["track"].values if "tension_n" in dataset else ()):
        columns[f"tension_n/{track}"] = numbers(dataset["tension_n"].values[:, k])
    for about in load_measures(dataset):
        columns[about["name"]] = numbers(values_of(dataset, about["name"])[0])
    for k, joint in enumerate(dataset["joint"].values):
        columns[f"joint_rad/{joint}"] = numbers(dataset["joint_rad"].values[:, k])
    for name in varied(dataset):
        values = dataset[name].values
        columns[name] = numbers(values) if values.dtype.kind in "fiu" else words(values)
    return columns


def unit_of(dataset: xr.Dataset, column: str) -> str:
    """The SI unit of a column of the page; empty for plain numbers and words."""
    variable = column.split("/")[0]
    if variable in dataset:
        unit = str(dataset[variable].attrs.get("units", ""))
        return "" if unit == "1" else unit
    return "N" if column.endswith("_wheel") else ""


def varied(dataset: xr.Dataset) -> list[str]:
    """What the study varied beside the place: parameters, friction, posture, joints."""
    return [
        str(name)
        for name, values in dataset.data_vars.items()
        if values.dims == ("case",)
        and values.attrs.get("varied")
        and name not in POSE
        and "better" not in values.attrs
    ]
