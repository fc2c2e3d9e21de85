"""Several named numpy arrays: `.npz` with heights, spacing and origin."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from rover_pin.errors import TerrainError
from rover_pin.terrain.readers.registry import HeightMap, reader


@reader(".npz")
def read_npz(path: Path, spacing_given: bool) -> HeightMap:
    """The array `z`, else the only two-dimensional one; `spacing` and `origin` where the file has them.

    Raises:
        TerrainError: not such a file, no array of heights, or more than one that could be.
    """
    try:
        with np.load(path, allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in archive.files}
    except OSError:
        raise
    except Exception as error:  # numpy and zlib raise many kinds on damaged files
        raise TerrainError("cannot be read as .npz", file=path, value=str(error)) from error
    spacing = _spacing(path, arrays.get("spacing"))
    return HeightMap(_heights(path, arrays), spacing, arrays.get("origin"))


def _heights(path: Path, arrays: dict[str, Any]) -> Any:
    if "z" in arrays:
        return arrays["z"]
    flat = [name for name, array in arrays.items() if array.ndim == 2]
    if len(flat) != 1:
        raise TerrainError(
            "no array `z`, and not just one of two dimensions",
            file=path,
            value=", ".join(f"{name} {array.shape}" for name, array in arrays.items()) or "no arrays",
            cure="name the heights `z`",
        )
    return arrays[flat[0]]


def _spacing(path: Path, value: Any) -> Any:
    if value is None:
        return None
    if value.size != 1:
        raise TerrainError("is not one number", file=path, element="spacing", value=f"shape {value.shape}")
    return value.reshape(())[()]
