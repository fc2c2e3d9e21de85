"""A search's result as the object and the tables that `search` prints."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from rover_pin.analysis.search_report import compared, shown_trial, trial_object
from rover_pin.cli.output import figure, line, new_table, print_table

if TYPE_CHECKING:
    import xarray as xr


def search_object(data: xr.Dataset, out: Path, html: Path | None, seconds: float) -> dict[str, Any]:
    """What `search --json` prints; `best` is null where no trial keeps every bound."""
    best = int(data.attrs["best_trial"])
    return {
        "robot": data.attrs["robot"],
        "terrain": data.attrs["terrain"],
        "goal": data.attrs["goal"],
        "better": data.attrs["better"],
        "trials": data.sizes["trial"],
        "kept": int((data.violation.values <= 0).sum()),
        "nominal": trial_object(data, 0),
        "best": trial_object(data, best) if best >= 0 else None,
        "nearest": trial_object(data, shown_trial(data)),
        "seconds": seconds,
        "out": str(out),
        "html": None if html is None else str(html),
    }


def print_search(data: xr.Dataset, seconds: float) -> None:
    """The best design beside the nominal one, for people."""
    best, count = int(data.attrs["best_trial"]), data.sizes["trial"]
    kept = int((data.violation.values <= 0).sum())
    line(f"{data.attrs['title']}: {count} trials in {seconds:.1f} s, {kept} keep every bound")
    shown = trial_object(data, shown_trial(data))
    nominal = trial_object(data, 0)
    told = f"{data.attrs['goal']} {figure(shown['objective'])}, nominal {figure(nominal['objective'])}"
    line(
        f"best, trial {best}: {told}"
        if best >= 0
        else f"no trial keeps every bound; the nearest, trial {shown['trial']}: {told}"
    )
    rows = compared(data)
    for title in ("design", "figures"):
        table = new_table(title, "name", "unit", "nominal", "best", left=2)
        for row in rows[title]:
            table.add_row(*row)
        print_table(table)
