"""Whether a study's result is whole: what every reader of it counts on, and every value readable."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import xarray as xr

from rover_pin.analysis.netcdf import BLOCK
from rover_pin.analysis.rows import PLAIN, POSE, RESIDUALS
from rover_pin.analysis.schema import CASE, JOINT, WHEEL
from rover_pin.errors import StudyError
from rover_pin.stability.registry import MEASURES

_WORDS = ("title", "robot", "terrain", "sampler", "study", "study_folder")
_COUNTS = ("plain_path_cases",)
_NUMBERS = ("x_m", "y_m", "yaw_rad", *POSE, "redundant", *RESIDUALS, PLAIN)
_TABLES = {"load_n": (CASE, WHEEL), "joint_rad": (CASE, JOINT)}
_CURE = "run the study again, or fetch the file anew"


def check_sound(data: xr.Dataset, path: Path) -> None:
    """Refuse a result that is damaged; each value is read once, a block at a time, and not kept.

    Raises:
        StudyError: attributes or variables that are missing or of another kind, or unreadable values.
    """
    for name in _WORDS:
        if not isinstance(data.attrs.get(name), str):
            raise _damaged(path, f"attribute {name}", "is missing or no text")
    for name in _COUNTS:
        try:
            int(data.attrs[name])
        except (KeyError, ValueError, TypeError):
            raise _damaged(path, f"attribute {name}", "is missing or no whole number") from None
    for name, dims, kinds in _wanted(data):
        found = data.variables.get(name)
        if found is None or found.dims != dims or found.dtype.kind not in kinds:
            raise _damaged(path, f"variable {name}", "is missing or of another kind")
    for name in map(str, data.variables):
        _read_through(data, name, path)


def _wanted(data: xr.Dataset) -> Iterator[tuple[str, tuple[str, ...], str]]:
    """Name, dimensions and kinds of what must be there."""
    for name in ("status", "reason"):
        yield name, (CASE,), "SUO"
    for name in _NUMBERS:
        yield name, (CASE,), "fiu"
    for name, across in _TABLES.items():
        yield name, across, "f"
    for name in MEASURES:
        if name in data.variables:
            yield name, (CASE,), "f"
            yield f"{name}_limiting", (CASE,), "SUO"


def _read_through(data: xr.Dataset, name: str, path: Path) -> None:
    try:
        variable = data.variables[name]
        rows = variable.sizes.get(CASE)
        if rows is None:
            _ = variable.copy(deep=False).values
            return
        for start in range(0, rows, BLOCK):
            _ = variable.isel({CASE: slice(start, start + BLOCK)}).values
    except Exception as error:  # HDF5 and the codecs raise whatever a damaged block makes them raise
        raise _damaged(path, f"variable {name}", f"cannot be read: {error}") from error


def _damaged(path: Path, element: str, what: str) -> StudyError:
    return StudyError(f"{what}: the result is damaged", file=path, element=element, cure=_CURE)
