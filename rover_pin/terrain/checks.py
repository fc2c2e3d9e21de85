"""What a terrain's numbers must be, said once."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from rover_pin.errors import TerrainError, nearest
from rover_pin.numerics import Array
from rover_pin.terrain.probe import UNBOUNDED, Extent

INTERPOLATIONS = {"smooth": 3, "linear": 2}
"""Interpolation: the least number of nodes along each side of a grid."""

HIGHEST = 1e9  # m; such a number is a damaged file or another mark for no data


def finite(name: str, value: Any, file: object = None) -> float:
    """`value` as a finite float.

    Raises:
        TerrainError: it is none.
    """
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise TerrainError(f"{name} is not a number", file=file, value=value) from None
    if not math.isfinite(number):
        raise TerrainError(f"{name} is not finite", file=file, value=value)
    return number


def positive(name: str, value: Any, file: object = None) -> float:
    """`value` as a finite float above zero.

    Raises:
        TerrainError: it is none.
    """
    number = finite(name, value, file)
    if number <= 0.0:
        raise TerrainError(f"{name} must be positive", file=file, value=value)
    return number


def pair(name: str, value: Any, file: object = None) -> tuple[float, float]:
    """`value` as two finite floats.

    Raises:
        TerrainError: it is none.
    """
    if isinstance(value, str) or np.ndim(value) != 1 or len(value) != 2:
        raise TerrainError(f"{name} must be two numbers, x and y [m]", file=file, value=value)
    return finite(f"{name} x", value[0], file), finite(f"{name} y", value[1], file)


def grid_spacing(value: Any, file: object = None) -> float:
    """The spacing of a map [m].

    Raises:
        TerrainError: it is missing, not a number or not positive.
    """
    if value is None:
        raise TerrainError(
            "the map has no spacing",
            file=file,
            cure="give the metres from node to node: --spacing, or spacing=",
        )
    return positive("the map's spacing", value, file)


def interpolation_name(value: str) -> str:
    """A known way to interpolate.

    Raises:
        TerrainError: unknown.
    """
    if value not in INTERPOLATIONS:
        raise TerrainError("unknown interpolation", value=value, cure=nearest(str(value), INTERPOLATIONS))
    return value


def heights(values: Any, interpolation: str, file: object = None) -> Array:
    """A map's heights, C-contiguous float64 (rows, columns) [m].

    Raises:
        TerrainError: not numbers, not two-dimensional, too small, or not finite somewhere.
    """
    try:
        array = np.asanyarray(values)
    except ValueError:
        raise TerrainError("the map's rows differ in length", file=file) from None
    if isinstance(array, np.ma.MaskedArray):
        hidden = np.ma.getmaskarray(array)
        require_no_gaps(hidden, "no data (masked)", file)
        array = np.asarray(array)
    if array.dtype.kind not in "fiu":
        raise TerrainError("the map does not hold real numbers", file=file, value=array.dtype)
    if array.ndim != 2:
        cure = "give one height for each place; export a single band" if array.ndim > 2 else None
        raise TerrainError("the map is not two-dimensional", file=file, value=array.shape, cure=cure)
    least = INTERPOLATIONS[interpolation_name(interpolation)]
    if min(array.shape) < least:
        raise TerrainError(
            f"the map of {array.shape[0]} x {array.shape[1]} nodes is too small",
            file=file,
            cure=f"interpolation {interpolation!r} needs at least {least} x {least}",
        )
    result: Array = np.ascontiguousarray(array, dtype=np.float64)
    require_no_gaps(np.isnan(result), "NaN", file)
    require_no_gaps(np.isinf(result), "infinite heights", file)
    require_no_gaps(np.abs(result) > HIGHEST, f"heights beyond {HIGHEST:g} m", file)
    return result


def height_unit(levels_of: str | None, scale: Any, offset: Any, file: object = None) -> tuple[float, float]:
    """Metres a unit of what a file holds, and the height [m] where it holds 0.

    Args:
        levels_of: what grey levels those are, or None where they are metres.
        scale: metres a unit, or None where nobody said.
        offset: m.
        file: for messages.

    Raises:
        TerrainError: grey levels without a scale, or a scale that is none.
    """
    if scale is None and levels_of is not None:
        raise TerrainError(
            "a picture does not say how high a grey level is",
            file=file,
            value=levels_of,
            cure="give the metres a level: --height-scale (and --height-offset), or height_scale=",
        )
    factor = 1.0 if scale is None else finite("the height scale", scale, file)
    if factor == 0.0:
        raise TerrainError("the height scale must not be zero", file=file, value=scale)
    return factor, finite("the height offset", offset, file)


def require_no_gaps(gaps: np.ndarray[Any, np.dtype[np.bool_]], name: str, file: object = None) -> None:
    """Refuse a map in which `gaps` (rows, columns) marks any cell.

    Raises:
        TerrainError: with the count and the first place.
    """
    count = int(np.count_nonzero(gaps))
    if count:
        row, column = (int(k) for k in np.argwhere(gaps)[0])
        raise TerrainError(
            f"the map holds {name} in {count} of {gaps.size} cells, the first at row {row}, column {column}",
            file=file,
            cure="fill them or cut them off",
        )


def extent_of(value: Sequence[float] | None) -> Extent:
    """(xmin, xmax, ymin, ymax) [m]; infinite where None.

    Raises:
        TerrainError: not four numbers, or an end before its beginning.
    """
    if value is None:
        return UNBOUNDED
    cure = "give (xmin, xmax, ymin, ymax) in metres"
    try:
        xmin, xmax, ymin, ymax = (float(v) for v in value)
    except (TypeError, ValueError):
        raise TerrainError("the extent is not four numbers", value=value, cure=cure) from None
    if not (xmin < xmax and ymin < ymax):
        raise TerrainError("the extent is empty", value=tuple(value), cure=cure)
    return xmin, xmax, ymin, ymax
