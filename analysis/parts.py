"""Finished chunks on disk beside the result, so that a killed run goes on where it stopped."""

from __future__ import annotations

import contextlib
import errno
import json
import re
import shutil
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from rover_pin.analysis.found import Found
from rover_pin.analysis.job import Chunk
from rover_pin.analysis.rows import PLAIN, Columns, count_of, cut, is_list, joined
from rover_pin.analysis.store import atomically, check_place
from rover_pin.errors import StudyError

FINGERPRINT = "study.json"
RESULT = "result.nc"
_NAMES = "all names"  # of a part's columns: a damaged zip may hide some of them
_PART = re.compile(r"^(\d+)-(\d+)\.npz$")
_FULL = (errno.ENOSPC, errno.EDQUOT)


class Parts:
    """Keeps chunks in `<out>.parts/` as they come, each file whole or not there; ends with `out` alone.

    `study.json` there says what the parts belong to: name of an ingredient and its digest. In memory stay
    the parts' names, and in `found` what they have in common.
    """

    def __init__(self, out: Path, fingerprint: Mapping[str, str], *, resume: bool) -> None:
        """Check the place; nothing is written yet.

        Raises:
            StudyError: the place cannot take a file, parts lie there, or belong to another study.
        """
        self.out = out
        self.folder = out.with_name(out.name + ".parts")
        self.found = Found()
        self._kept: dict[Chunk, Path] = {}
        self._fingerprint = dict(fingerprint)
        check_place(out)
        if self.folder.exists():
            if not resume:
                cure = f"add --resume to go on, or delete {self.folder}"
                raise StudyError("an unfinished run lies here", file=self.folder, cure=cure)
            self._match()
            self._read_index()

    def begin(self) -> None:
        """Make the folder, with the fingerprint in it.

        Raises:
            StudyError: the disk is full.
        """
        text = json.dumps(self._fingerprint, indent=1)
        with self._room():
            self.folder.mkdir(exist_ok=True)
            for left in self.folder.glob(".*.tmp"):
                left.unlink()
            (self.folder / RESULT).unlink(missing_ok=True)
            atomically(self.folder / FINGERPRINT, lambda file: file.write(text.encode()))

    def done(self) -> list[Chunk]:
        """Chunks that are kept, in order."""
        return sorted(self._kept)

    def save(self, chunk: Chunk, columns: Columns) -> None:
        """Keep a finished chunk on disk.

        Raises:
            StudyError: the disk is full; the chunks before it are kept.
        """
        path = self.folder / f"{chunk[0]:010d}-{chunk[1]:010d}.npz"
        with self._room():
            told = {_NAMES: np.array(list(columns)), **columns}
            atomically(path, lambda file: np.savez(file, allow_pickle=False, **told))
        self._kept[chunk] = path
        self.found.add(columns)

    def blocks(self, size: int) -> Iterator[Columns]:
        """All rows in order, `size` at a time: no more than that and a part is in memory.

        Raises:
            StudyError: a part cannot be read.
        """
        waiting: list[Columns] = []
        rows = 0
        for chunk in self.done():
            waiting.append(self._load(chunk))
            rows += chunk[1] - chunk[0]
            while rows >= size:
                whole = joined(waiting)
                yield cut(whole, slice(0, size))
                waiting, rows = [cut(whole, slice(size, None))], rows - size
        if rows:
            yield joined(waiting)

    def finish(self, write: Callable[[Path], None]) -> None:
        """Have `write` make the result among the parts, move it to its place, and remove the parts.

        Raises:
            StudyError: the disk is full; the parts are kept.
        """
        draft = self.folder / RESULT
        try:
            with self._room():
                write(draft)
                draft.replace(self.out)
        finally:
            draft.unlink(missing_ok=True)
        shutil.rmtree(self.folder, ignore_errors=True)

    @contextlib.contextmanager
    def _room(self) -> Iterator[None]:
        """Say it plainly where the disk is full."""
        try:
            yield
        except OSError as error:
            if error.errno not in _FULL:
                raise
            cure = "what is finished is kept: make room and go on with --resume"
            raise StudyError("the disk is full", file=self.folder, cure=cure) from None

    def _match(self) -> None:
        """Refuse parts of another study."""
        path = self.folder / FINGERPRINT
        try:
            kept = dict(json.loads(path.read_text()))
        except FileNotFoundError:
            if any(_PART.match(entry.name) for entry in self.folder.iterdir()):
                raise StudyError("says not what it belongs to", file=self.folder, cure="delete it") from None
            return
        except (OSError, ValueError, TypeError):
            raise StudyError("cannot be read", file=path, cure=f"delete {self.folder}") from None
        names = [*self._fingerprint, *(name for name in kept if name not in self._fingerprint)]
        changed = [name for name in names if kept.get(name) != self._fingerprint.get(name)]
        if changed:
            cure = f"put it back, or delete {self.folder} to start anew"
            raise StudyError(
                f"belongs to another study: changed is {', '.join(changed)}", file=self.folder, cure=cure
            )

    def _read_index(self) -> None:
        """Learn which chunks are on disk; one that cannot be opened is run again."""
        for path in sorted(self.folder.iterdir()):
            named = _PART.match(path.name)
            if named:
                with contextlib.suppress(Exception), np.load(path, allow_pickle=False) as file:
                    self.found.add({name: file[name] for name in [PLAIN, *filter(is_list, _names(file))]})
                    self._kept[int(named[1]), int(named[2])] = path

    def _load(self, chunk: Chunk) -> Columns:
        """A part's columns."""
        path = self._kept[chunk]
        try:
            with np.load(path, allow_pickle=False) as file:
                columns = {name: file[name] for name in _names(file)}
            if count_of(columns) != chunk[1] - chunk[0]:
                raise ValueError(f"holds {count_of(columns)} rows")
        except Exception as error:  # zip and numpy raise many kinds on damaged files
            cure = "delete it and go on with --resume"
            raise StudyError(f"this part cannot be read: {error}", file=path, cure=cure) from None
        return columns


def _names(file: Any) -> list[str]:
    """The columns of an open part.

    Raises:
        ValueError: not all are there.
    """
    names = [str(name) for name in file[_NAMES]]
    if [_NAMES, *names] != file.files:
        raise ValueError("not all columns are there")
    return names
