"""A search in numbers for people: the best design beside the nominal one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.analysis.figures import figures_of, parameter_units, parameters_of, unit
from rover_pin.analysis.search_score import NOTHING

if TYPE_CHECKING:
    import xarray as xr


def shown_trial(data: xr.Dataset) -> int:
    """The best trial, or the one nearest to its bounds where none keeps them."""
    best = int(data.attrs["best_trial"])
    return best if best >= 0 else int(np.argmin(data.violation.values))


def trial_object(data: xr.Dataset, trial: int) -> dict[str, Any]:
    """A trial: design, figures (means over the places that settled, SI), objective, violation."""
    each = int(data.attrs["places"])
    cases = slice(trial * each, (trial + 1) * each)
    worth = float(data.objective[trial])
    return {
        "trial": trial,
        "objective": None if abs(worth) >= NOTHING else worth,
        "violation": float(data.violation[trial]),
        "parameters": {name: float(values[cases][0]) for name, values in parameters_of(data).items()},
        "figures": {name: _mean(values[cases]) for name, values in figures_of(data).items()},
    }


def compared(data: xr.Dataset) -> dict[str, list[list[str]]]:
    """Rows of `design` and `figures`: name, unit, nominal, best, in words."""
    nominal, best = trial_object(data, 0), trial_object(data, shown_trial(data))
    units = parameter_units(data)
    design = [
        [name, units[name], f"{value:.6g}", f"{best['parameters'][name]:.6g}"]
        for name, value in nominal["parameters"].items()
    ]
    figures = [
        [name, unit(name), _told(value), _told(best["figures"][name])]
        for name, value in nominal["figures"].items()
    ]
    return {"design": design, "figures": figures}


def _mean(values: Any) -> float:
    there = values[~np.isnan(values)]
    return float(there.mean()) if len(there) else float("nan")


def _told(value: float) -> str:
    return "-" if np.isnan(value) else f"{value:.4g}" if abs(value) > 1e-9 else "0"
