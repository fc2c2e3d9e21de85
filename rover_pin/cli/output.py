"""What commands print: one JSON object without NaN, or tables."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rover_pin.kernel_cache import is_batch_cold, is_cold

if TYPE_CHECKING:
    from rich.table import Table

INTERRUPTED = 130
"""The exit code of what Ctrl-C ended."""


def plain(value: Any) -> Any:
    """`value` as JSON can carry it: numbers that are not finite become null."""
    if isinstance(value, Mapping):
        return {str(key): plain(each) for key, each in value.items()}
    if isinstance(value, str) or value is None:
        return None if value is None else str(value)
    if hasattr(value, "tolist"):
        return plain(value.tolist())
    if isinstance(value, Sequence | set | frozenset):
        return [plain(each) for each in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value if isinstance(value, bool | int | float) else str(value)


def print_json(value: Any) -> None:
    """One JSON value on stdout."""
    sys.stdout.write(json.dumps(plain(value), indent=1, allow_nan=False) + "\n")


def print_table(table: Table) -> None:
    """A table on stdout, as wide as the terminal; wide enough for every column where there is none."""
    from rich.console import Console

    Console(width=None if sys.stdout.isatty() else 160, highlight=False).print(table)


def new_table(title: str, *columns: str, left: int = 1) -> Table:
    """An unboxed table; the first `left` columns are words, the others numbers."""
    from rich import box
    from rich.table import Table

    table = Table(title=title or None, box=box.SIMPLE_HEAD, title_justify="left", pad_edge=False)
    for k, name in enumerate(columns):
        table.add_column(name, justify="left" if k < left else "right", no_wrap=k == 0)
    return table


def line(text: str) -> None:
    """A line on stdout."""
    sys.stdout.write(text + "\n")


def announce_compilation(*, batch: bool = False) -> None:
    """Tell somebody who waits at a terminal why the first stance, or the first batch, takes its time."""
    package = Path(__file__).resolve().parents[1]
    if not sys.stderr.isatty():
        return
    if batch and is_batch_cold(package):
        aside("compiling formulas, once: a minute or two")
    elif is_cold(package):
        aside("compiling formulas, once: about half a minute")


def aside(text: str) -> None:
    """A line on stderr, where it does not disturb an object on stdout."""
    sys.stderr.write(text + "\n")


def figure(value: float | None, digits: int = 4) -> str:
    """A number for a table: `digits` significant, a dash where there is none, 0 for what rounding left."""
    if value is None or math.isnan(value):
        return "-"
    return f"{value:.{digits}g}" if abs(value) > 1e-9 else "0"


def fixed(value: float, decimals: int) -> str:
    """A number with so many decimals, never minus nothing."""
    return f"{round(float(value), decimals) + 0.0:.{decimals}f}"


def check_outputs(*paths: Path | None) -> None:
    """Refuse places that cannot take a file, before any work is done.

    Raises:
        InputError: a folder that is not there or not writable.
    """
    from rover_pin.analysis.store import check_place

    for path in paths:
        if path is not None:
            check_place(path)
