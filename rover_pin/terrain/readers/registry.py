"""Which reader takes which file: one module of this package each, found by itself."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rover_pin.errors import TerrainError


@dataclass(frozen=True)
class HeightMap:
    """What a file says: heights as they lie in it, and where it says so spacing and origin.

    Attributes:
        heights: (rows, columns) [m], rows along +y in the file's order.
        spacing: [m], or None.
        origin: (x, y) [m] of the first node, or None.
        levels_of: where `heights` are grey levels and no metres, what levels the file has; else None.
    """

    heights: Any
    spacing: Any = None
    origin: Any = None
    levels_of: str | None = None


Reader = Callable[[Path, bool], HeightMap]

_readers: dict[str, Reader] = {}


def reader(*suffixes: str) -> Callable[[Reader], Reader]:
    """Register a reader for file names with these suffixes (lower case, with their dot).

    A reader takes the path and whether the user gave a spacing, so that a file's own spacing is not judged
    where it is not used.
    """

    def register(function: Reader) -> Reader:
        for suffix in suffixes:
            _readers[suffix] = function
        return function

    return register


def suffixes() -> tuple[str, ...]:
    """The suffixes that can be read."""
    package = importlib.import_module(__package__ or "rover_pin.terrain.readers")
    for module in pkgutil.iter_modules(package.__path__):
        importlib.import_module(f"{package.__name__}.{module.name}")
    return tuple(sorted(_readers))


def read_heights(path: Path, spacing_given: bool) -> HeightMap:
    """Read a height map by its suffix.

    Raises:
        TerrainError: no such file, not a file, a suffix that no reader knows, or one that its reader refuses.
    """
    known = suffixes()
    if not path.exists():
        raise TerrainError("no such file", file=path)
    if not path.is_file():
        raise TerrainError("not a file", file=path)
    suffix = path.suffix.lower()
    if suffix not in known:
        raise TerrainError(
            "a height map of unknown kind",
            file=path,
            value=suffix or "no suffix",
            cure=f"known: {', '.join(known)}",
        )
    try:
        return _readers[suffix](path, spacing_given)
    except OSError as error:
        raise TerrainError("cannot be read", file=path, value=error.strerror or str(error)) from error
