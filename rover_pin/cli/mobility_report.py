"""A mobility map as the object and the tables that `mobility` prints."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.cli.output import figure, fixed, line, new_table, print_table

if TYPE_CHECKING:
    import xarray as xr

    from rover_pin.numerics import Array

SHARES = (0, 1, 5, 50, 95, 99, 100)
ENDS = ("worst", "best")


def mobility_object(
    data: xr.Dataset, seconds: float, out: Path, tiff: Path | None, png: Path | None
) -> dict[str, Any]:
    """What `mobility --json` prints."""
    value = data["worst"].attrs
    return {
        **{
            name: data.attrs[name]
            for name in ("robot", "terrain", "gravity", "payload", "measure", "headings", "cases")
        },
        "unit": value["units"],
        "better": value["better"],
        "cells": {
            "rows": data.sizes["y"],
            "columns": data.sizes["x"],
            "settled": int((data["settled_share"] == 1).sum()),
            "settled_in_part": int(((data["settled_share"] > 0) & (data["settled_share"] < 1)).sum()),
        },
        "outcomes": _outcomes(data),
        "to_plain_path": data.attrs["to_plain_path"],
        **{end: _spread(data, end) for end in ENDS},
        "seconds": seconds,
        "out": str(out),
        "tiff": None if tiff is None else str(tiff),
        "png": None if png is None else str(png),
    }


def print_mobility(data: xr.Dataset, seconds: float) -> None:
    """The result for people: how cases ended, how the two headings spread, where the worst cell is."""
    cases, value = int(data.attrs["cases"]), data["worst"].attrs
    line(
        f"{data.attrs['title']}: {data.sizes['y']} x {data.sizes['x']} places, "
        f"{data.attrs['headings']} headings, {cases} cases in {seconds:.1f} s"
    )
    told = (f"{word} {count} ({100 * count / cases:.1f} %)" for word, count in _outcomes(data).items())
    line("  ".join(told))
    line(f"sent to the plain path: {100 * data.attrs['to_plain_path'] / cases:.3g} %")
    if not bool((data["settled_share"] > 0).any()):
        return
    line(f"{data.attrs['measure']} [{value['units']}], {value['better']} is better, over the places")
    table = new_table("", "heading", *(f"{share} %" for share in SHARES))
    for end in ENDS:
        table.add_row(end, *(figure(each) for each in _percentiles(data[end].values).values()))
    print_table(table)
    worst = _spread(data, "worst")["worst_place"]
    line(
        f"worst place: x {fixed(worst['x_m'], 3)}  y {fixed(worst['y_m'], 3)} m, "
        f"heading {fixed(worst['yaw_deg'], 1)} deg: {figure(worst['value'])} {value['units']}"
    )


def _outcomes(data: xr.Dataset) -> dict[str, int]:
    """Cases by how they ended, those that occur."""
    names = (str(name) for name in data["outcome"].values)
    return {name: int(n) for name, n in zip(names, data["outcomes"].values, strict=True) if n}


def _spread(data: xr.Dataset, end: str) -> dict[str, Any]:
    """Percentiles over the places, and the place where it is worst; nothing where nothing settles."""
    values = data[end].values
    if np.isnan(values).all():
        return {"percentiles": {}, "worst_place": None}
    pick = np.nanargmin if data[end].attrs["better"] == "high" else np.nanargmax
    row, column = np.unravel_index(int(pick(values)), values.shape)
    place = {
        "x_m": float(data["x"][column]),
        "y_m": float(data["y"][row]),
        "yaw_deg": math.degrees(float(data[f"{end}_yaw_rad"][row, column])),
        "value": float(values[row, column]),
    }
    return {"percentiles": _percentiles(values), "worst_place": place}


def _percentiles(values: Array) -> dict[str, float]:
    """Of the places that have a value."""
    known = values[~np.isnan(values)]
    found = np.percentile(known, SHARES, method="lower")
    return {str(share): float(each) for share, each in zip(SHARES, found, strict=True)}
