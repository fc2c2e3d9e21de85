"""One numpy array: `.npy`."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from rover_pin.errors import TerrainError
from rover_pin.terrain.readers.registry import HeightMap, reader


@reader(".npy")
def read_npy(path: Path, spacing_given: bool) -> HeightMap:
    """The array of a `.npy` file; it says nothing of spacing.

    Raises:
        TerrainError: not such a file, or one of Python objects, which are not loaded.
    """
    try:
        return HeightMap(np.load(path, allow_pickle=False))
    except OSError:
        raise
    except Exception as error:  # numpy's tokenizer and its allocation raise many kinds on damaged files
        raise TerrainError("cannot be read as .npy", file=path, value=str(error)) from error
