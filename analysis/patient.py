"""A file for HDF5 that keeps its troubles to itself until it is asked.

When a write fails under HDF5 (a full disk, say), the library can no longer close the file: it complains at
every object that is dropped, and may take the process with it. So failed writes are passed over here, and
the first trouble is raised between two blocks, where everything can still be closed.
"""

from __future__ import annotations

import io
import os
from pathlib import Path


class PatientFile(io.FileIO):
    """A file to write and to read back; after a failed write nothing more is written."""

    def __init__(self, path: Path) -> None:
        super().__init__(path, "w+")
        self.trouble: OSError | None = None

    def write(self, data: object) -> int:
        """All of `data` (bytes-like), or what the disk takes of it; the answer is its length all the same."""
        view = memoryview(data).cast("B")  # type: ignore[arg-type]
        done = 0
        try:
            while self.trouble is None and done < len(view):
                done += os.write(self.fileno(), view[done:])
        except OSError as trouble:
            self.trouble = trouble
        return len(view)

    def truncate(self, size: int | None = None) -> int:
        """As of any file, but for troubles."""
        try:
            return super().truncate(size)
        except OSError as trouble:
            self.trouble = self.trouble or trouble
            return size or 0

    def check(self) -> None:
        """Say what is wrong.

        Raises:
            OSError: the first write that failed.
        """
        if self.trouble is not None:
            raise self.trouble

    def keep(self) -> None:
        """Have the disk hold all that was written.

        Raises:
            OSError: it cannot.
        """
        self.check()
        os.fsync(self.fileno())
