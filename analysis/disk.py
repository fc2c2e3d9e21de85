"""The disk that a study needs, told before it starts."""

from __future__ import annotations

import shutil
import zlib
from pathlib import Path

import numpy as np

from rover_pin.analysis.schema import Block, Schema
from rover_pin.analysis.vocabulary import Words
from rover_pin.errors import StudyError


def result_bytes(form: Schema, block: Block) -> float:
    """Bytes of a case in the result, from some of its cases: words packed, tables without empty columns."""
    total = 0
    for each in form.variables:
        values = each.take(block)
        if isinstance(values, Words):
            total += len(zlib.compress(values.letters(each.width).tobytes(), 1))
        elif each.sparse:
            total += values.itemsize * len(values) * int(np.count_nonzero(~np.isnan(values).all(axis=0)))
        else:
            total += values.nbytes
    return total / len(block.cases)


def check_room(folder: Path, wanted: float, count: int) -> None:
    """Refuse a study that needs more than is free.

    Args:
        folder: where the result and its parts come to lie.
        wanted: bytes.
        count: cases, for the message.

    Raises:
        StudyError: it does not fit.
    """
    free = shutil.disk_usage(folder).free
    if wanted > free:
        value = f"{told(wanted)} for {count} cases, {told(free)} free"
        cure = "make room, name another place for the result, or ask for fewer cases or measures"
        raise StudyError("needs more disk than there is", file=folder, value=value, cure=cure)


def told(size: float) -> str:
    """Bytes for people."""
    for unit in ("bytes", "kB", "MB", "GB"):
        if size < 1000:
            return f"{size:.3g} {unit}"
        size /= 1000
    return f"{size:.3g} TB"
