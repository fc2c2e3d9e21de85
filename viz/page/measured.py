"""The measures of a study's dataset: which there are, which comes first, which cases are worst by one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.errors import StudyError, nearest
from rover_pin.viz.units import ranked, shown, title_of

if TYPE_CHECKING:
    import xarray as xr

    from rover_pin.numerics import Array


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
    found = [about["name"] for about in about_measures(dataset)]
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
    values, better = values_of(dataset, name)
    usable = (dataset["status"].values.astype(str) == "settled") & ~np.isnan(values)
    keys = values if better == "high" else -values
    order = np.argsort(keys, kind="stable")
    return [int(i) for i in order[usable[order]][:count]]


def values_of(dataset: xr.Dataset, name: str) -> tuple[Array, str]:
    """A measure's values and which way is better; the lightest and heaviest wheel are measures too."""
    if name in dataset:
        return np.asarray(dataset[name].values, dtype=np.float64), str(dataset[name].attrs["better"])
    loads = np.asarray(dataset["load_n"].values, dtype=np.float64)[:, _bearing(dataset)]
    return (loads.min(axis=1), "high") if name == "lightest_wheel" else (loads.max(axis=1), "low")


def about_measures(dataset: xr.Dataset) -> list[dict[str, Any]]:
    """Each measure for the page: `name, title, unit, factor, better, whole`; factor goes from SI to unit."""
    return [_about(dataset, name) for name in measures_of(dataset)] + load_measures(dataset)


def _about(dataset: xr.Dataset, name: str) -> dict[str, Any]:
    attributes = dataset[name].attrs
    unit, factor = shown(str(attributes.get("units", "")))
    return {
        "name": name,
        "title": title_of(name, attributes),
        "unit": unit,
        "factor": factor,
        "better": str(attributes["better"]),
        "whole": _whole(values_of(dataset, name)[0]),
    }


def _whole(values: Array) -> bool:
    """Whether values are counts."""
    finite = values[np.isfinite(values)]
    return bool(len(finite) and (finite == np.rint(finite)).all() and finite.any())


def load_measures(dataset: xr.Dataset) -> list[dict[str, Any]]:
    """The lightest and the heaviest wheel, told as `about_measures` does."""
    if not dataset.sizes.get("wheel") or not _bearing(dataset):
        return []
    pairs = (("lightest_wheel", "Lightest wheel", "high"), ("heaviest_wheel", "Heaviest wheel", "low"))
    return [
        {"name": name, "title": title, "unit": "N", "factor": 1.0, "better": way, "whole": False}
        for name, title, way in pairs
    ]


def _bearing(dataset: xr.Dataset) -> list[int]:
    """Which of the wheels should carry."""
    idle = str(dataset["load_n"].attrs.get("auxiliary", "")).split(", ")
    return [k for k, name in enumerate(dataset["wheel"].values) if str(name) not in idle]
