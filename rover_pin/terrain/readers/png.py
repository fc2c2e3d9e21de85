"""Pictures of heights, one grey level a pixel: `.png`."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np

from rover_pin.errors import TerrainError
from rover_pin.terrain.readers.registry import HeightMap, reader

_GREY = {"L": "8", "I;16": "16", "I": "16"}
_COLOURS = {"1": "black and white", "P": "a palette", "LA": "grey with transparency"}


@reader(".png")
def read_png(path: Path, spacing_given: bool) -> HeightMap:
    """The grey levels as they are stored (0 to 255, or 0 to 65535), in the file's order, not flipped.

    What a level means in metres the file does not say: `Terrain.from_file` asks for it.

    Raises:
        TerrainError: not such a file, or colours, a palette or transparency instead of one grey level.
    """
    from PIL import Image, UnidentifiedImageError

    try:
        with Image.open(path, formats=["PNG"]) as picture:
            mode = picture.mode
            levels = np.array(picture) if mode in _GREY else None
    except UnidentifiedImageError as error:
        raise TerrainError(
            "cannot be read as PNG", file=path, value="no PNG, or damaged at its beginning"
        ) from error
    except (SyntaxError, ValueError, EOFError, struct.error) as error:
        raise TerrainError("cannot be read as PNG", file=path, value=str(error)) from error
    except Image.DecompressionBombError as error:
        raise TerrainError("is too large a picture", file=path, value=str(error)) from error
    except OSError as error:
        if error.errno is not None:
            raise
        raise TerrainError("cannot be read as PNG", file=path, value=str(error)) from error
    if levels is None:
        raise TerrainError(
            "is not a picture of one grey level a pixel",
            file=path,
            value=_COLOURS.get(mode, f"colours, {mode}"),
            cure="export heights as greyscale, best of 16 bits",
        )
    return HeightMap(levels, levels_of="8 bits: 0 to 255" if mode == "L" else "16 bits: 0 to 65535")
