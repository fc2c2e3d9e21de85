"""A study's page: where the rover is close to tipping, how margins and loads spread, the worst in 3D."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.errors import StudyError, nearest
from rover_pin.viz.facts import STATUS_WORDS
from rover_pin.viz.page.columns import Column, numbers, words
from rover_pin.viz.page.html import page, write_whole
from rover_pin.viz.page.matters import matters_of
from rover_pin.viz.page.pack import Pack
from rover_pin.viz.page.raster import ground_raster
from rover_pin.viz.page.robots import robot
from rover_pin.viz.page.sweep import sweep_of
from rover_pin.viz.units import ranked, shown, title_of

if TYPE_CHECKING:
    import xarray as xr

    from rover_pin.numerics import Array
    from rover_pin.rover import Rover
    from rover_pin.statics.stance import Stance
    from rover_pin.terrain import Terrain

POSE = ("x_m", "y_m", "z_m", "roll_rad", "pitch_rad", "yaw_rad")


def measures_of(dataset: xr.Dataset) -> list[str]:
    """The measures in a study's dataset: one number a case, and which way is better; tipping first."""
    found = [
        str(name) for name, v in dataset.data_vars.items() if v.dims == ("case",) and "better" in v.attrs
    ]
    return ranked(found)


def main_measure(dataset: xr.Dataset, measure: str | None = None) -> str:
    """The measure asked for, else the one that says most about tipping.

    Raises:
        StudyError: the dataset has no such measure, or none at all.
    """
    found = [*measures_of(dataset), *(about["name"] for about in _load_measures(dataset))]
    if measure is None and found:
        return str(found[0])
    if measure is None or measure not in found:
        raise StudyError(
            "the study has no such measure",
            element="measure",
            value=measure,
            cure=nearest(measure or "", found),
        )
    return measure


def worst_cases(dataset: xr.Dataset, count: int = 10, measure: str | None = None) -> list[int]:
    """Numbers of the settled cases with the worst values of a measure, the worst first.

    Raises:
        StudyError: the dataset has no such measure.
    """
    name = main_measure(dataset, measure)
    values, better = _values(dataset, name)
    usable = (dataset["status"].values.astype(str) == "settled") & ~np.isnan(values)
    keys = values if better == "high" else -values
    order = np.argsort(keys, kind="stable")
    return [int(i) for i in order[usable[order]][:count]]


def _values(dataset: xr.Dataset, name: str) -> tuple[Array, str]:
    """A measure's values and which way is better; the lightest and heaviest wheel are measures too."""
    if name in dataset:
        return np.asarray(dataset[name].values, dtype=np.float64), str(dataset[name].attrs["better"])
    loads = np.asarray(dataset["load_n"].values, dtype=np.float64)[:, _bearing(dataset)]
    return (loads.min(axis=1), "high") if name == "lightest_wheel" else (loads.max(axis=1), "low")


def save_study_page(
    dataset: xr.Dataset,
    path: str | Path,
    *,
    rover: Rover,
    terrain: Terrain,
    stances: Mapping[int, Stance] | None = None,
    measure: str | None = None,
) -> Path:
    """Write the page of a study: one offline HTML file, whole or not at all.

    Args:
        dataset: of a Study: dimensions case, wheel, joint; see `measures_of`.
        path: of the file.
        rover: drawn for every case that `stances` does not hold.
        terrain: the study's ground.
        stances: exact stances of some cases (of `worst_cases`, say): their contacts and, where parameters
            vary, their own rover. For other cases the page places each load where the wheel is nearest
            to the plane of the ground under it.
        measure: shown first; else the one that says most about tipping.

    Raises:
        StudyError: no case, or no such measure.
        InputError: the file cannot be written.
    """
    return write_whole(path, study_page(dataset, rover, terrain, stances or {}, measure).encode("utf-8"))


def study_page(
    dataset: xr.Dataset,
    rover: Rover,
    terrain: Terrain,
    stances: Mapping[int, Stance],
    measure: str | None = None,
) -> str:
    """The page's HTML text; arguments as in `save_study_page`."""
    if not dataset.sizes.get("case"):
        raise StudyError("the study has no case", cure="run it with n of 1 or more")
    columns = page_columns(dataset)
    variants, exact = _variants(rover, stances)
    ground, heights = ground_raster(
        terrain, dataset["x_m"].values, dataset["y_m"].values, float(variants[0][0]["span"])
    )
    title = str(dataset.attrs.get("title") or f"{rover.name} on {terrain.label}")
    header = {
        "title": title,
        "about": {str(key): _text(value) for key, value in dataset.attrs.items()},
        "cases": int(dataset.sizes["case"]),
        "first": main_measure(dataset, measure),
        "measures": [_about_measure(dataset, name) for name in measures_of(dataset)]
        + _load_measures(dataset),
        "wheels": [str(name) for name in dataset["wheel"].values],
        "joints": [str(name) for name in dataset["joint"].values],
        "varied": _varied(dataset),
        "reshaped": any(name.removeprefix("parameter_") in rover.parameters for name in _varied(dataset)),
        "columns": {name: column.about() for name, column in columns.items()},
        "status_words": STATUS_WORDS,
        "sweep": sweep_of(dataset),
        "matters": matters_of(dataset),
        "ground": ground,
        "robots": [about for about, _ in variants],
        "exact": exact,
    }
    segments = {f"column/{name}": column.data for name, column in columns.items()}
    segments |= {"ground": heights, **{f"robot/{i}": stream for i, (_, stream) in enumerate(variants)}}
    return page("study", title, Pack(header, segments))


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
    for about in _load_measures(dataset):
        columns[about["name"]] = numbers(_values(dataset, about["name"])[0])
    for k, joint in enumerate(dataset["joint"].values):
        columns[f"joint_rad/{joint}"] = numbers(dataset["joint_rad"].values[:, k])
    for name in _varied(dataset):
        values = dataset[name].values
        columns[name] = numbers(values) if values.dtype.kind in "fiu" else words(values)
    return columns


def _varied(dataset: xr.Dataset) -> list[str]:
    """What the study varied beside the place: parameters, friction, posture, joints."""
    return [
        str(name)
        for name, values in dataset.data_vars.items()
        if values.dims == ("case",)
        and values.attrs.get("varied")
        and name not in POSE
        and "better" not in values.attrs
    ]


def _about_measure(dataset: xr.Dataset, name: str) -> dict[str, Any]:
    attributes = dataset[name].attrs
    unit, factor = shown(str(attributes.get("units", "")))
    return {
        "name": name,
        "title": title_of(name, attributes),
        "unit": unit,
        "factor": factor,
        "better": str(attributes["better"]),
    }


def _bearing(dataset: xr.Dataset) -> list[int]:
    """Which of the wheels should carry."""
    idle = str(dataset["load_n"].attrs.get("auxiliary", "")).split(", ")
    return [k for k, name in enumerate(dataset["wheel"].values) if str(name) not in idle]


def _load_measures(dataset: xr.Dataset) -> list[dict[str, Any]]:
    if not dataset.sizes.get("wheel") or not _bearing(dataset):
        return []
    pairs = (("lightest_wheel", "Lightest wheel", "high"), ("heaviest_wheel", "Heaviest wheel", "low"))
    return [
        {"name": name, "title": title, "unit": "N", "factor": 1.0, "better": way}
        for name, title, way in pairs
    ]


def _variants(
    rover: Rover, stances: Mapping[int, Stance]
) -> tuple[list[tuple[dict[str, Any], bytes]], dict[int, dict[str, Any]]]:
    """The rovers to draw, each once, and what is known exactly of some cases."""
    variants = [robot(rover)]
    known = {_looks(rover): 0}
    exact: dict[int, dict[str, Any]] = {}
    for case, stance in stances.items():
        looks = _looks(stance.rover)
        if looks not in known:
            known[looks] = len(variants)
            variants.append(robot(stance.rover, len(variants)))
        exact[int(case)] = {
            "robot": known[looks],
            "com": stance.com,
            "contacts": [[c.wheel, *(float(part) for part in c.point), c.load] for c in stance.contacts],
        }
    return variants, exact


def _looks(rover: Rover) -> tuple[tuple[str, float], ...]:
    return tuple(sorted((str(name), float(value)) for name, value in rover.parameters.items()))


def _text(value: Any) -> Any:
    return value.item() if hasattr(value, "item") else value
