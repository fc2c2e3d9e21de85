"""Finished chunks on disk beside the result, so that a killed run goes on where it stopped."""

from __future__ import annotations

import contextlib
import json
import os
import re
import shutil
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import BinaryIO

import numpy as np

from rover_pin.analysis.job import Chunk
from rover_pin.analysis.rows import Columns
from rover_pin.errors import StudyError

FINGERPRINT = "study.json"
_UNREADABLE = (OSError, ValueError, EOFError, KeyError, zipfile.BadZipFile)
_PART = re.compile(r"^(\d+)-(\d+)\.npz$")


class Memory:
    """Keeps chunks in memory: a run without a file."""

    def __init__(self) -> None:
        self._kept: dict[Chunk, Columns] = {}

    def begin(self) -> None:
        """Nothing to make ready."""

    def done(self) -> list[Chunk]:
        """Chunks that are kept, in order."""
        return sorted(self._kept)

    def save(self, chunk: Chunk, columns: Columns) -> None:
        """Keep a finished chunk."""
        self._kept[chunk] = columns

    def columns(self) -> list[Columns]:
        """Every chunk in order."""
        return [self._kept[chunk] for chunk in self.done()]

    def finish(self, write: Callable[[Path], None]) -> None:
        """Nothing to write."""


class Parts(Memory):
    """Keeps chunks in `<out>.parts/` as they come, each file whole or not there; ends with `out` alone.

    `study.json` there says what the parts belong to: name of an ingredient and its digest.
    """

    def __init__(self, out: Path, fingerprint: Mapping[str, str], *, resume: bool) -> None:
        """Check the place; nothing is written yet.

        Raises:
            StudyError: the place cannot take a file, parts lie there, or belong to another study.
        """
        super().__init__()
        self.out = out
        self.folder = out.with_name(out.name + ".parts")
        self._fingerprint = dict(fingerprint)
        check_place(out)
        if self.folder.exists():
            if not resume:
                cure = f"add --resume to go on, or delete {self.folder}"
                raise StudyError("an unfinished run lies here", file=self.folder, cure=cure)
            self._match()
            self._kept = self._read()

    def begin(self) -> None:
        """Make the folder, with the fingerprint in it."""
        self.folder.mkdir(exist_ok=True)
        text = json.dumps(self._fingerprint, indent=1)
        atomically(self.folder / FINGERPRINT, lambda file: _discard(file.write(text.encode())))

    def save(self, chunk: Chunk, columns: Columns) -> None:
        """Keep a finished chunk, here and on disk."""
        super().save(chunk, columns)
        path = self.folder / f"{chunk[0]:08d}-{chunk[1]:08d}.npz"
        atomically(path, lambda file: np.savez(file, allow_pickle=False, **columns))

    def finish(self, write: Callable[[Path], None]) -> None:
        """Have `write` make the result among the parts, move it to its place, and remove the parts."""
        draft = self.folder / "result.nc"
        write(draft)
        draft.replace(self.out)
        shutil.rmtree(self.folder, ignore_errors=True)

    def _match(self) -> None:
        """Refuse parts of another study."""
        path = self.folder / FINGERPRINT
        try:
            kept = json.loads(path.read_text())
        except FileNotFoundError:
            if any(_PART.match(entry.name) for entry in self.folder.iterdir()):
                raise StudyError("says not what it belongs to", file=self.folder, cure="delete it") from None
            return
        except (OSError, ValueError):
            raise StudyError("cannot be read", file=path, cure=f"delete {self.folder}") from None
        names = [*self._fingerprint, *(name for name in kept if name not in self._fingerprint)]
        changed = [name for name in names if kept.get(name) != self._fingerprint.get(name)]
        if changed:
            cure = f"put it back, or delete {self.folder} to start anew"
            raise StudyError(
                f"belongs to another study: changed is {', '.join(changed)}", file=self.folder, cure=cure
            )

    def _read(self) -> dict[Chunk, Columns]:
        """The chunks on disk; one that cannot be read is run again."""
        kept: dict[Chunk, Columns] = {}
        for path in sorted(self.folder.iterdir()):
            found = _PART.match(path.name)
            if found:
                with contextlib.suppress(*_UNREADABLE), np.load(path, allow_pickle=False) as file:
                    kept[int(found[1]), int(found[2])] = {name: file[name] for name in file.files}
        return kept


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


def atomically(path: Path, write: Callable[[BinaryIO], None]) -> None:
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


def _discard(_: object) -> None:
    return None
