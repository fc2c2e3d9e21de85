"""ESRI's ASCII grid: `.asc`, a header of cells and corner above rows of heights, the northernmost first."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from rover_pin.errors import TerrainError, nearest
from rover_pin.terrain.checks import require_no_gaps
from rover_pin.terrain.readers.registry import HeightMap, reader

_NEEDED = ("ncols", "nrows", "cellsize")
_CORNERS = ("xllcorner", "xllcenter", "yllcorner", "yllcenter")
_SIDES = ("dx", "dy")
_KEYS = (*_SIDES, *_NEEDED, *_CORNERS, "nodata_value")


@reader(".asc")
def read_asc(path: Path, spacing_given: bool) -> HeightMap:
    """Heights [m] with rows along +y, so the file's last row first; spacing and the first cell's centre.

    The format is that of ArcGIS ("Esri ASCII raster format"): `ncols`, `nrows`, `xllcorner` or `xllcenter`
    (likewise y) of the south-west cell, `cellsize` (or GDAL's `dx` and `dy`, if equal), and where the file
    has it `NODATA_value`.

    Raises:
        TerrainError: a header that is incomplete, heights that are too few or too many or no numbers (with
            the line), or cells without data (with the row and column as they stand in the file, from 0).
    """
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except UnicodeDecodeError as error:
        raise TerrainError("cannot be read as text", file=path, value=str(error)) from error
    header, start = _header(path, lines)
    rows, columns = (_count(path, key, header[key]) for key in ("nrows", "ncols"))
    heights = _body(path, lines, start, rows * columns).reshape(rows, columns)
    missing = header.get("nodata_value", -9999.0)
    gaps = np.isnan(heights) if math.isnan(missing) else heights == missing
    require_no_gaps(gaps, f"no data (NODATA_value {missing:g})", path)
    cell = header["cellsize"]
    if cell <= 0:
        raise TerrainError("must be positive", file=path, element="cellsize", value=cell)
    return HeightMap(heights[::-1], cell, tuple(_centre(header, axis, cell) for axis in "xy"))


def _header(path: Path, lines: list[str]) -> tuple[dict[str, float], int]:
    """Key: number; and the index of the first line of heights."""
    header: dict[str, float] = {}
    for i, text in enumerate(lines):
        words = text.split()
        if not words:
            continue
        key = words[0].lower()
        if not key[0].isalpha() or key in ("nan", "inf", "infinity"):
            return _complete(path, header), i
        where = f"line {i + 1}"
        if key not in _KEYS:
            raise TerrainError(
                "unknown key", file=path, element=where, value=words[0], cure=nearest(key, _KEYS)
            )
        if key in header:
            raise TerrainError("stands twice", file=path, element=f"{where}, {key}", cure="keep one")
        header[key] = _number(path, f"{where}, {key}", " ".join(words[1:]), finite=key != "nodata_value")
    return _complete(path, header), len(lines)


def _complete(path: Path, header: dict[str, float]) -> dict[str, float]:
    if "cellsize" not in header and all(key in header for key in _SIDES):
        if not math.isclose(header["dx"], header["dy"], rel_tol=1e-6):
            raise TerrainError(
                "cells that are not square",
                file=path,
                element="dx, dy",
                value=f"{header['dx']:g} x {header['dy']:g}",
                cure="resample to square cells",
            )
        header["cellsize"] = header["dx"]
    for key in _NEEDED:
        if key not in header:
            raise TerrainError(
                "missing", file=path, element=key, cure=f"write `{key} NUMBER` above the heights"
            )
    for axis in "xy":
        if f"{axis}llcorner" in header and f"{axis}llcenter" in header:
            what = "both the corner and the centre of the first cell are given"
            raise TerrainError(what, file=path, element=f"{axis}llcorner", cure="keep one")
    return header


def _count(path: Path, key: str, value: float) -> int:
    if value < 1 or value != int(value):
        raise TerrainError("not a whole number above zero", file=path, element=key, value=value)
    return int(value)


def _body(
    path: Path, lines: list[str], start: int, wanted: int
) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """The heights in a row; where the file breaks its lines is no matter."""
    values: list[float] = []
    for i in range(start, len(lines)):
        words = lines[i].split()
        try:
            if "_" in lines[i] or not lines[i].isascii():
                raise ValueError  # digits in groups or of other scripts, which only Python reads
            values += map(float, words)
        except ValueError:
            for column, word in enumerate(words, start=1):
                _number(path, f"line {i + 1}, column {column}", word, finite=False)
    if len(values) != wanted:
        raise TerrainError(
            f"holds {len(values)} heights where nrows x ncols is {wanted}",
            file=path,
            cure="mend the header, or fetch the whole file",
        )
    return np.array(values)


def _centre(header: dict[str, float], axis: str, cell: float) -> float:
    """Of the south-west cell [m]; half a cell from its corner, the corner at 0 where none is stated."""
    if f"{axis}llcenter" in header:
        return header[f"{axis}llcenter"]
    return header.get(f"{axis}llcorner", 0.0) + 0.5 * cell


def _number(path: Path, where: str, word: str, *, finite: bool = True) -> float:
    try:
        if "_" in word or not word.isascii():
            raise ValueError
        value = float(word)
    except ValueError:
        cure = "write a point for the decimal mark" if "," in word else "write a number"
        raise TerrainError("not a number", file=path, element=where, value=word, cure=cure) from None
    if finite and not math.isfinite(value):
        raise TerrainError("not finite", file=path, element=where, value=word, cure="write a finite number")
    return value
