"""Whether results belong together case by case, and which measures they share."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.errors import StudyError

if TYPE_CHECKING:
    import xarray as xr

PLACE = ("x_m", "y_m", "yaw_rad")


def check_pairing(datasets: Mapping[str, xr.Dataset]) -> None:
    """Refuse results on different terrains or of different cases.

    Raises:
        StudyError: so they are; names the result and what differs.
    """
    (name, first), *others = datasets.items()
    for label, data in others:
        if data.attrs["terrain_digest"] != first.attrs["terrain_digest"]:
            value = f"{data.attrs['terrain']}, {name} on {first.attrs['terrain']}"
            cure = "run both on the same ground"
            raise StudyError("stands on another terrain", element=label, value=value, cure=cure)
        differing = _differing(first, data)
        if differing:
            cure = "run both with the same sampler, seed and vary: rover-pin compare ROBOT ROBOT does so"
            raise StudyError(f"its cases are not those of {name}", element=label, value=differing, cure=cure)


def _differing(first: xr.Dataset, other: xr.Dataset) -> str:
    """What was asked otherwise, or nothing."""
    counts = first.sizes["case"], other.sizes["case"]
    if counts[0] != counts[1]:
        return f"{counts[1]} cases, not {counts[0]}"
    for column in PLACE:
        if not np.array_equal(first[column].values, other[column].values):
            return f"{column} differs"
    for column in map(str, first.data_vars):
        varied = [column in data and data[column].attrs.get("varied") for data in (first, other)]
        if all(varied) and not np.array_equal(first[column].values, other[column].values):
            return f"{column} differs"
    return ""


def shared_measures(
    datasets: Mapping[str, xr.Dataset],
) -> tuple[dict[str, str], dict[str, str], dict[str, dict[str, str]]]:
    """Unit and better side of what all have; what a design lacks, by label, and why."""
    found = {label: _measures(data) for label, data in datasets.items()}
    every = list(dict.fromkeys(name for names in found.values() for name in names))
    common = [name for name in every if all(name in names for names in found.values())]
    left_out: dict[str, dict[str, str]] = {}
    for label, data in datasets.items():
        why = dict(part.split(": ", 1) for part in str(data.attrs["left_out"]).split("; ") if ": " in part)
        for name in every:
            if name not in found[label]:
                why.setdefault(name, "it was not asked for")
        if why:
            left_out[label] = why
    any_data = next(iter(datasets.values()))
    units = {name: str(any_data[name].attrs.get("units", "")) for name in common}
    return units, {name: str(any_data[name].attrs["better"]) for name in common}, left_out


def _measures(data: xr.Dataset) -> list[str]:
    """One number a case that says which way is better."""
    return [str(name) for name, v in data.data_vars.items() if v.dims == ("case",) and "better" in v.attrs]
