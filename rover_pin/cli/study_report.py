"""A study's result as the object and the tables that `study` prints."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rover_pin.analysis.summary import SHARES, figure_spreads, largest_residuals, measures, spread
from rover_pin.cli.output import figure, fixed, line, new_table, print_table

if TYPE_CHECKING:
    import xarray as xr

WORST = 10


def study_object(
    data: xr.Dataset, ended: Mapping[str, int], out: Path, html: Path | None, seconds: float
) -> dict[str, Any]:
    """What `study --json` prints; `ended` is how many cases ended in which way."""
    spreads = {name: spread(data, name, WORST) for name in measures(data)}
    return {
        "robot": data.attrs["robot"],
        "terrain": data.attrs["terrain"],
        "gravity": float(data.attrs["gravity"]),
        "payload": data.attrs["payload"],
        "cases": data.sizes["case"],
        "status": ended,
        "plain_path": int(data.attrs["plain_path_cases"]),
        "measures": {
            name: {
                "unit": each.unit,
                "better": each.better,
                "percentiles": each.percentiles,
                "worst": [{"case": w.case, "value": w.value, "limiting": w.limiting} for w in each.worst],
            }
            for name, each in spreads.items()
        },
        "figures": {
            name: {"unit": unit, "percentiles": shares}
            for name, (unit, shares) in figure_spreads(data).items()
        },
        "residuals": largest_residuals(data),
        "seconds": seconds,
        "out": str(out),
        "html": None if html is None else str(html),
    }


def print_study(data: xr.Dataset, ended: Mapping[str, int], seconds: float) -> None:
    """The result for people: how cases ended, each measure's spread, the worst cases."""
    count = data.sizes["case"]
    line(f"{data.attrs['title']}: {count} cases in {seconds:.1f} s")
    line("  ".join(f"{word} {_share(number, count)}" for word, number in ended.items()))
    line(f"answered by the plain path: {_share(int(data.attrs['plain_path_cases']), count)}")
    if "settled" not in ended:
        return
    _print_figures(data)
    names = measures(data)
    if not names:
        return
    table = new_table(
        "", "measure", "unit", "better", *(f"{share} %" for share in SHARES), "worst case", left=3
    )
    for name in names:
        each = spread(data, name, 1)
        shares = (figure(value) for value in each.percentiles.values())
        worst = each.worst[0]
        told = f"{figure(worst.value)} at {worst.case}" + (f" ({worst.limiting})" if worst.limiting else "")
        table.add_row(name, each.unit, each.better, *shares, told)
    print_table(table)
    _print_worst(data, "tip" if "tip" in names else names[0])
    line("largest residuals: " + "  ".join(f"{n} {v:.1e}" for n, v in largest_residuals(data).items()))


def _print_figures(data: xr.Dataset) -> None:
    """How the rover stands and carries."""
    table = new_table("", "figure", "unit", *(f"{share} %" for share in SHARES), left=2)
    for name, (unit, shares) in figure_spreads(data).items():
        turned = 180.0 / math.pi if unit == "rad" else 1.0
        shown = name.replace("_rad", "") if unit == "rad" else name
        table.add_row(shown, "deg" if unit == "rad" else unit, *(figure(turned * v) for v in shares.values()))
    print_table(table)


def _share(number: int, count: int) -> str:
    return f"{number} ({100 * number / count:.1f} %)"


def _print_worst(data: xr.Dataset, measure: str) -> None:
    """Where and how the worst cases of one measure stand."""
    each = spread(data, measure, WORST)
    title = f"worst cases by {measure} [{each.unit}]"
    table = new_table(
        title, "case", "limiting", "value", "x m", "y m", "yaw deg", "roll deg", "pitch deg", left=2
    )
    for worst in each.worst:
        row = data.sel(case=worst.case)
        degrees = [math.degrees(float(row[name])) for name in ("yaw_rad", "roll_rad", "pitch_rad")]
        shown = [
            *(fixed(float(row[name]), 3) for name in ("x_m", "y_m")),
            *(fixed(angle, 2) for angle in degrees),
        ]
        table.add_row(str(worst.case), worst.limiting or "-", figure(worst.value), *shown)
    print_table(table)
