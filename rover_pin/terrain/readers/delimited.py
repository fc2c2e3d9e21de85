"""Numbers in lines of text: `.csv`."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from rover_pin.errors import TerrainError
from rover_pin.terrain.readers.registry import HeightMap, reader


@reader(".csv")
def read_csv(path: Path, spacing_given: bool) -> HeightMap:
    """One row of the map a line, parted by semicolons, commas, tabs or blanks; `#` begins a comment.

    Raises:
        TerrainError: a word that is no number, or rows of different lengths (with the line), or no rows.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise TerrainError("cannot be read as text", file=path, value=str(error)) from error
    rows: list[list[float]] = []
    for number, line in enumerate(text.splitlines(), start=1):
        content = line.partition("#")[0].strip()
        if not content:
            continue
        row = _row(path, number, content)
        if rows and len(row) != len(rows[0]):
            raise TerrainError(
                f"has {len(row)} numbers where the first row has {len(rows[0])}",
                file=path,
                element=f"line {number}",
            )
        rows.append(row)
    if not rows:
        raise TerrainError("holds no numbers", file=path)
    return HeightMap(np.array(rows, dtype=np.float64))


def _row(path: Path, number: int, content: str) -> list[float]:
    delimiter = next((d for d in ";,\t" if d in content), None)
    values = []
    for column, word in enumerate(content.split(delimiter), start=1):
        try:
            if "_" in word or not word.isascii():
                raise ValueError  # digits in groups or of other scripts, which only Python reads
            values.append(float(word))
        except ValueError:
            raise TerrainError(
                "not a number",
                file=path,
                element=f"line {number}, column {column}",
                value=word.strip(),
                cure="a map holds heights only: no header, a point for the decimal mark",
            ) from None
    return values
