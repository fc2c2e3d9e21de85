"""A mobility map as an xarray Dataset with units and provenance, and as files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
import xarray as xr

from rover_pin.analysis.measures import title
from rover_pin.analysis.mobility.outcome import OUTCOMES
from rover_pin.analysis.mobility.survey import Survey
from rover_pin.analysis.provenance import made_by, stands_how
from rover_pin.analysis.rows import Columns
from rover_pin.analysis.store import atomically, save_netcdf
from rover_pin.stability.registry import MEASURES

CELL = ("y", "x")
OUTCOME = "outcome"
PIXEL_SCALE_TAG = 33550  # ModelPixelScale of GeoTIFF: three doubles
DOUBLE = 12


def as_dataset(survey: Survey, parts: Sequence[Columns]) -> xr.Dataset:
    """The Dataset from the blocks of rows in order."""
    columns = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    measure = MEASURES[survey.measure]
    value = {"units": measure.unit, "better": measure.better}
    about: Mapping[str, Mapping[str, Any]] = {
        "worst": {**value, "long_name": f"{title(survey.measure)}, worst heading that settles"},
        "best": {**value, "long_name": f"{title(survey.measure)}, best heading that settles"},
        "worst_yaw_rad": {"units": "rad", "long_name": "the worst heading, from +x to the left"},
        "best_yaw_rad": {"units": "rad", "long_name": "the best heading, from +x to the left"},
        "settled_share": {"units": "1", "long_name": "share of the headings that settle"},
        "status": {
            "long_name": "settled where every heading settles, else the commonest other outcome",
            "flag_values": np.arange(len(OUTCOMES), dtype=np.int8),
            "flag_meanings": " ".join(OUTCOMES),
        },
    }
    counts = columns["outcomes"].astype(np.int64).sum(axis=0)
    variables = {name: (CELL, columns[name], attributes) for name, attributes in about.items()}
    return xr.Dataset(
        {**variables, "outcomes": (OUTCOME, counts, {"long_name": "cases that ended so"})},
        coords={
            "y": ("y", survey.y, {"units": "m", "long_name": "y of the root link's origin"}),
            "x": ("x", survey.x, {"units": "m", "long_name": "x of the root link's origin"}),
            OUTCOME: list(OUTCOMES),
        },
        attrs=_attributes(survey, int(columns["to_plain_path"].sum())),
    )


def _attributes(survey: Survey, to_plain_path: int) -> dict[str, Any]:
    """What was asked, and where the numbers come from."""
    rover, terrain = survey.rover, survey.terrain
    return {
        "title": f"{rover.name} on {terrain.label}",
        **stands_how(rover, survey.posture, survey.gravity),
        "terrain": terrain.label,
        "terrain_digest": terrain.digest,
        "interpolation": terrain.interpolation,
        "spacing": float(terrain.spacing),
        "measure": survey.measure,
        "headings": len(survey.yaw),
        "cases": len(survey.y) * survey.cases_a_row,
        "to_plain_path": to_plain_path,
        **made_by(),
    }


def write_netcdf(data: xr.Dataset, path: Path) -> None:
    """Write it as netCDF-4, compressed; the file is whole or not there.

    Raises:
        OSError: it cannot be written.
    """
    encoding = {
        str(name): {"_FillValue": None, **({"zlib": True, "complevel": 1} if values.ndim == 2 else {})}
        for name, values in data.variables.items()
        if values.dtype.kind in "fi"
    }
    save_netcdf(data, path, encoding)


def write_tiff(data: xr.Dataset, path: Path) -> None:
    """Write `worst` as float32, NaN where there is none, rows along +y; the file is whole or not there.

    The distance of pixels is in the tag ModelPixelScale, where `Terrain.from_file` and GIS programs find it.

    Raises:
        OSError: it cannot be written.
    """
    import tifffile

    step = float(data.x[1] - data.x[0]) if data.sizes["x"] > 1 else float(data.attrs["spacing"])
    scale = (PIXEL_SCALE_TAG, DOUBLE, 3, (step, step, 0.0), True)
    pixels = data["worst"].values.astype(np.float32)

    def write(file: BinaryIO) -> None:
        tifffile.imwrite(file, pixels, extratags=[scale], photometric="minisblack")

    atomically(path, write)
