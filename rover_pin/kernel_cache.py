"""Compiled formulas on disk that are older than the sources they were compiled from."""

from __future__ import annotations

from pathlib import Path

ROOMS = ("mechanism", "contact", "terrain", "statics", "stability", "stability/measures", "compiled")
"""Folders that hold formulas; one may be compiled into another."""


def is_cold(package: Path) -> bool:
    """Whether the first stance will wait for the compiler (half a minute)."""
    return not any((package / "contact" / "__pycache__").glob("search.find_all*.nbc"))


def is_batch_cold(package: Path) -> bool:
    """Whether the first batch will wait for the compiler (a minute or two)."""
    return not any((package / "compiled" / "__pycache__").glob("kernel.settle_all*.nbc"))


def discard_stale(package: Path) -> int:
    """Remove compiled formulas older than the newest source, and say how many.

    Numba compares a cached function with its own file only. A formula that was compiled into its callers
    would go on in them after its own file has changed, and numbers would be wrong without a sign.

    Args:
        package: the folder of the package.
    """
    folders = [package / room for room in ROOMS]
    sources = [package / "numerics.py", *(path for folder in folders for path in folder.glob("*.py"))]
    newest = max((path.stat().st_mtime_ns for path in sources if path.is_file()), default=0)
    removed = 0
    for folder in folders:
        for compiled in folder.glob("__pycache__/*.nb[ci]"):
            try:
                if compiled.stat().st_mtime_ns < newest:
                    compiled.unlink()
                    removed += 1
            except OSError:  # another process removed it first, or the folder is not ours to write
                continue
    return removed
