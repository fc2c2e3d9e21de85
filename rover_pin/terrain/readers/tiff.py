"""TIFF and GeoTIFF with one height a pixel: `.tif`, `.tiff`."""

from __future__ import annotations

import itertools
import logging
import math
from pathlib import Path
from typing import Any

import numpy as np

from rover_pin.errors import TerrainError
from rover_pin.terrain.checks import require_no_gaps
from rover_pin.terrain.readers.registry import HeightMap, reader

_GEOGRAPHIC = 2
_METRE = 9001
_PAGES = 64  # looked at; a damaged file may have as many as it has bytes
_BYTES = 1 << 32  # of heights; a damaged file may state any size


@reader(".tif", ".tiff")
def read_tiff(path: Path, spacing_given: bool) -> HeightMap:
    """The pixels in the order in which they lie, and the spacing of ModelPixelScale where there is one.

    The tie point of a GeoTIFF is not used: it belongs to an image whose rows run south, and here rows run
    along +y, so the first pixel stands at the origin unless the user says otherwise.

    Raises:
        TerrainError: not such a file; several pages or bands; pixels marked as without data; and, where the
            user gave no spacing, pixel scales that are unequal or not in metres.
    """
    import tifffile

    logging.getLogger("tifffile").addHandler(logging.NullHandler())
    try:
        with tifffile.TiffFile(path) as file:
            page: Any = file.pages[0]
            full = [p for p in itertools.islice(file.pages, _PAGES) if not _is_overview(p)]
            if page.nbytes > _BYTES:
                raise ValueError(f"{page.nbytes} bytes of heights, more than {_BYTES}")
            heights = page.asarray()
            tags = {
                name: page.tags[name].value
                for name in ("ModelPixelScaleTag", "GDAL_NODATA")
                if name in page.tags
            }
            geo = dict(page.geotiff_tags) if page.is_geotiff else {}
    except OSError:
        raise
    except Exception as error:  # tifffile raises many kinds on damaged files and missing codecs
        raise TerrainError(
            "cannot be read as TIFF", file=path, value=str(error), cure=_cure(error)
        ) from error
    if len(full) > 1:
        raise TerrainError("holds several images", file=path, value=len(full), cure="write the heights alone")
    _check_nodata(path, heights, tags.get("GDAL_NODATA"))
    scale = tags.get("ModelPixelScaleTag")
    spacing = None if scale is None or spacing_given else _spacing(path, scale, geo)
    return HeightMap(heights, spacing)


def _is_overview(page: Any) -> bool:
    return bool(getattr(page, "is_reduced", False) or getattr(page, "is_mask", False))


def _cure(error: Exception) -> str | None:
    if "imagecodecs" in str(error):
        return "pip install imagecodecs, or write the file without compression"
    return None


def _check_nodata(path: Path, heights: Any, text: Any) -> None:
    try:
        value = float(str(text).strip("\x00 "))
    except ValueError:
        return
    if heights.ndim == 2 and math.isfinite(value):
        gaps = heights == np.asarray(value).astype(heights.dtype)
        require_no_gaps(gaps, f"no data (GDAL_NODATA {value:g})", path)


def _spacing(path: Path, scale: Any, geo: dict[str, Any]) -> float:
    width, height = float(scale[0]), float(scale[1])
    cure = "resample to square pixels in metres, or give the spacing"
    if not math.isclose(width, height, rel_tol=1e-6):
        raise TerrainError("unequal pixel scales", file=path, value=f"{width:g} x {height:g}", cure=cure)
    if geo.get("GTModelTypeGeoKey") == _GEOGRAPHIC:
        raise TerrainError("the pixel scale is an angle", file=path, value=f"{width:g} deg", cure=cure)
    unit = geo.get("ProjLinearUnitsGeoKey", _METRE)
    if unit != _METRE:
        raise TerrainError(
            "the pixel scale is not in metres", file=path, value=f"unit {int(unit)}", cure=cure
        )
    return width
