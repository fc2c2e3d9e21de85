"""Where finished chunks are kept while a study runs: in memory, for a run without a file."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

from rover_pin.analysis.job import Chunk
from rover_pin.analysis.rows import Columns, joined
from rover_pin.errors import StudyError

if TYPE_CHECKING:
    import xarray as xr


class Memory:
    """Keeps chunks in memory."""

    def __init__(self) -> None:
        self._kept: dict[Chunk, Columns] = {}

    def done(self) -> list[Chunk]:
        """Chunks that are kept, in order."""
        return sorted(self._kept)

    def save(self, chunk: Chunk, columns: Columns) -> None:
        """Keep a finished chunk."""
        self._kept[chunk] = columns

    def columns(self) -> Columns:
        """Every row in order."""
        return joined([self._kept[chunk] for chunk in self.done()])


def missing(done: list[Chunk], count: int, size: int) -> list[Chunk]:
    """The cases of `count` that no chunk in `done` covers, in chunks of at most `size`."""
    chunks: list[Chunk] = []
    start = 0
    for first, last in [*sorted(done), (count, count)]:
        chunks += [(k, min(k + size, first)) for k in range(start, first, size)]
        start = max(start, last)
    return chunks


def check_place(out: Path) -> None:
    """Refuse a place where no file can be written.

    Raises:
        StudyError: it is a folder, or its folder is not there or not writable.
    """
    if out.is_dir():
        raise StudyError("is a folder", file=out, cure="name a file")
    folder = out.parent
    if not folder.is_dir():
        raise StudyError("there is no such folder", file=folder, cure="make it first")
    if not os.access(folder, os.W_OK):
        raise StudyError("this folder cannot be written to", file=folder, cure="choose another")


def atomically(path: Path, write: Callable[[BinaryIO], object]) -> None:
    """Write a file that is whole or not there, whatever happens.

    Raises:
        OSError: it could not be written; nothing is left behind.
    """
    draft = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    try:
        with draft.open("wb") as file:
            write(file)
            file.flush()
            os.fsync(file.fileno())
        draft.replace(path)
    finally:
        draft.unlink(missing_ok=True)


def save_netcdf(data: xr.Dataset, path: Path, encoding: Mapping[str, Any]) -> None:
    """Write a Dataset as netCDF-4: whole or not there.

    Raises:
        OSError: it could not be written; nothing is left behind.
    """
    draft = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    try:
        data.to_netcdf(draft, engine="h5netcdf", encoding=encoding)
        draft.replace(path)
    finally:
        draft.unlink(missing_ok=True)
