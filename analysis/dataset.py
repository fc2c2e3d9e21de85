"""A study's result as an xarray Dataset with units and provenance: made in memory or read from its file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import xarray as xr

from rover_pin.analysis.cases import Cases
from rover_pin.analysis.found import Found, found_in
from rover_pin.analysis.provenance import git_state, made_by
from rover_pin.analysis.rows import Columns
from rover_pin.analysis.schema import CASE, Block, schema
from rover_pin.analysis.vocabulary import Words
from rover_pin.errors import StudyError
from rover_pin.payload import told

if TYPE_CHECKING:
    from rover_pin.analysis.study import Study

VARIED = "varied"


def dataset(study: Study, columns: Columns, cases: Cases | None = None) -> xr.Dataset:
    """The Dataset of a study from all its rows, in memory; `cases` where they are not those it draws."""
    job = study.plan.job
    found = found_in(columns)
    drawn = job.cases.drawer().run(0, len(job.cases)) if cases is None else cases
    block = Block(drawn, columns)
    form = schema(job.layout, block.cases, found)
    variables: dict[str, Any] = {}
    for each in form.variables:
        values = each.take(block)
        spelled = values.spelled() if isinstance(values, Words) else values
        varied = {VARIED: int(bool((spelled != spelled[0]).any()))} if each.asked else {}
        variables[each.name] = (each.dims, spelled, {**each.attrs, **varied})
    labels = {dim: np.array(names, dtype=np.str_) for dim, names in form.labels.items()}
    return xr.Dataset(
        variables, coords={CASE: pd.RangeIndex(found.cases), **labels}, attrs=attributes(study, found)
    )


def attributes(study: Study, found: Found) -> dict[str, Any]:
    """Where the numbers come from."""
    ready = study.plan
    commit, state = git_state(study.folder)
    return {
        "title": f"{ready.rover.name} on {ready.job.terrain.label}",
        "robot": study.spec.robot,
        "terrain": ready.job.terrain.label,
        "terrain_digest": ready.job.terrain.digest,
        "sampler": study.spec.cases.sampler,
        "seed": study.spec.cases.seed,
        **({"inputs": "\n".join(ready.job.cases.inputs)} if study.spec.cases.sampler == "saltelli" else {}),
        "study": study.text,
        "study_file": "" if study.file is None else str(study.file),
        "study_folder": str(study.folder),
        "gravity": study.spec.gravity,
        "payload": told(ready.rover.recipe.payload),
        "left_out": "; ".join(f"{name}: {why}" for name, why in ready.left_out.items()),
        "plain_path_cases": found.plain,
        "git_commit": commit,
        "git_state": state,
        **made_by(),
    }


def read(path: Path) -> xr.Dataset:
    """A study's result from its file: looked through once for damage, then read where values are used.

    A variable that is used whole stays in memory; `data.isel(case=slice(a, b))` reads that much and keeps
    nothing.

    Raises:
        StudyError: no such file, not the result of a study, or a damaged one.
    """
    from rover_pin.analysis.sound import check_sound

    data = opened(path)
    try:
        check_sound(data, path)
    except StudyError:
        data.close()
        raise
    return data


def opened(path: Path) -> xr.Dataset:
    """As `read`, but not looked through: for a result that was just written.

    Raises:
        StudyError: no such file, or not the result of a study.
    """
    if not path.is_file():
        raise StudyError("no such file", file=path, cure="make one with rover-pin study -o")
    try:
        data = xr.open_dataset(path, engine="h5netcdf", drop_variables=[CASE])
    except Exception as error:  # HDF5 raises whatever a damaged file makes it raise
        raise StudyError(f"is no netCDF file, or a damaged one: {error}", file=path) from None
    if "study" not in data.attrs or "status" not in data or CASE not in data.sizes:
        data.close()
        raise StudyError("is not the result of a study", file=path, cure="make one with rover-pin study -o")
    # A range index: the numbers of the cases take no memory, however many there are.
    return data.assign_coords({CASE: pd.RangeIndex(data.sizes[CASE])})
