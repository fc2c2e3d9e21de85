"""A study's result written as netCDF-4, block after block, so that no table is ever whole in memory."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import h5netcdf
import numpy as np

from rover_pin.analysis.dataset import VARIED
from rover_pin.analysis.patient import PatientFile
from rover_pin.analysis.schema import CASE, Block, Schema, Variable
from rover_pin.analysis.vocabulary import Words, longest

BLOCK = 1 << 16
"""Cases a block, and a chunk of the file."""

CHECKED: dict[str, Any] = {"fletcher32": True}
"""Every block with its checksum, so that a damaged file says so."""

PACKED: dict[str, Any] = {**CHECKED, "compression": "gzip", "compression_opts": 1, "shuffle": True}
"""For words and small whole numbers, which shrink to a tenth. Measured floats do not shrink by more than a
tenth and would take longer to pack than to compute, so they are stored as they are."""


def write(
    path: Path, form: Schema, blocks: Iterable[Block], count: int, attributes: Mapping[str, Any]
) -> None:
    """Write the result of `count` cases; `blocks` come in order, `BLOCK` cases each but for the last.

    Raises:
        OSError: the file cannot be written.
    """
    with PatientFile(path) as disk:
        with h5netcdf.File(disk, "w") as file:
            _fill(file, disk, form, blocks, count, attributes)
        disk.keep()


def _fill(
    file: Any,
    disk: PatientFile,
    form: Schema,
    blocks: Iterable[Block],
    count: int,
    attributes: Mapping[str, Any],
) -> None:
    """Dimensions and names, then the blocks, then what is only known at the end."""
    _name_dimensions(file, form, count)
    for name, value in attributes.items():
        file.attrs[name] = value
    numbers = file.create_variable(CASE, (CASE,), "i8", chunks=(_rows(count),), **PACKED)
    made = {each.name: _create(file, each, count) for each in form.variables}
    first: dict[str, Any] = {}
    varied = {each.name: 0 for each in form.variables if each.asked}
    start = 0
    for block in blocks:
        stop = start + len(block.cases)
        numbers[start:stop] = np.arange(start, stop)
        for each in form.variables:
            values = each.take(block)
            stored = values.letters(each.width) if isinstance(values, Words) else values
            _store(made[each.name], each, start, stop, stored)
            if each.asked:
                differs = stored != first.setdefault(each.name, stored[0])
                varied[each.name] |= int(bool(differs.any()))
        disk.check()
        start = stop
    for name, whether in varied.items():
        made[name].attrs[VARIED] = whether


def _name_dimensions(file: Any, form: Schema, count: int) -> None:
    """The dimensions, each but the case with its names."""
    names = {dim: _letters(labels) for dim, labels in form.labels.items()}
    widths = {each.width for each in form.variables if each.width}
    widths |= {letters.shape[1] for letters in names.values()}
    file.dimensions = {
        CASE: count,
        **{dim: len(labels) for dim, labels in form.labels.items()},
        **{_letter_dim(width): width for width in sorted(widths)},
    }
    for dim, letters in names.items():
        made = file.create_variable(dim, (dim, _letter_dim(letters.shape[1])), "S1", data=letters)
        made.attrs["_Encoding"] = "utf-8"


def _create(file: Any, each: Variable, count: int) -> Any:
    """An empty variable with its attributes."""
    rows = _rows(count)
    if each.width:
        dims = (*each.dims, _letter_dim(each.width))
        made = file.create_variable(each.name, dims, "S1", chunks=(rows, each.width), **PACKED)
        made.attrs["_Encoding"] = "utf-8"
    elif each.kind == "i1":
        made = file.create_variable(each.name, each.dims, "i1", chunks=(rows,), **PACKED)
    else:
        sizes = [len(file.dimensions[dim]) for dim in each.dims[1:]]
        # Column by column: what is never written takes no room on the disk and reads as NaN.
        chunks = (rows, *(1 if each.sparse else max(size, 1) for size in sizes))
        fill = np.nan if each.sparse else None
        made = file.create_variable(each.name, each.dims, "f8", chunks=chunks, fillvalue=fill, **CHECKED)
    for name, value in each.attrs.items():
        made.attrs[name] = value
    return made


def _store(made: Any, each: Variable, start: int, stop: int, values: Any) -> None:
    if not each.sparse:
        if values.size:
            made[start:stop] = values
        return
    for k, column in enumerate(values.T):
        if not np.isnan(column).all():
            made[start:stop, k] = np.ascontiguousarray(column)


def _rows(count: int) -> int:
    return max(1, min(count, BLOCK))


def _letter_dim(width: int) -> str:
    return f"string{width}"


def _letters(labels: list[str]) -> Any:
    """(names, width) single bytes."""
    words = Words.of(labels)
    return words.letters(longest(words.known))
