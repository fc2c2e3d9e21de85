"""A traverse as files: netCDF, and a table of a place a row."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import TYPE_CHECKING

from rover_pin.analysis.store import atomically, save_netcdf

if TYPE_CHECKING:
    import xarray as xr


def write_netcdf(data: xr.Dataset, path: Path) -> None:
    """Write it as netCDF-4; the file is whole or not there. `xarray.open_dataset` reads it.

    Raises:
        OSError: it cannot be written.
    """
    encoding = {str(n): {"_FillValue": None} for n, v in data.variables.items() if v.dtype.kind in "fi"}
    save_netcdf(data, path, encoding)


def write_csv(data: xr.Dataset, path: Path) -> None:
    """Write what is by place, then by place and wheel or joint (`load_n/fl`), a column each; empty is NaN.

    Raises:
        OSError: it cannot be written; nothing is left behind.
    """
    columns = {str(n): v.values.tolist() for n, v in data.data_vars.items() if v.dims == ("step",)}
    for name, dim in (("load_n", "wheel"), ("torque_nm", "wheel"), ("joint_rad", "joint")):
        for each in data[dim].values.tolist():
            columns[f"{name}/{each}"] = data[name].sel({dim: each}).values.tolist()
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    for row in zip(*columns.values(), strict=True):
        writer.writerow(["" if value != value else value for value in row])
    atomically(path, lambda file: file.write(text.getvalue().encode("utf-8")))
