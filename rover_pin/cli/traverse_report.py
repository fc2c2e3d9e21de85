"""A traverse, and a largest step, as objects and as what people read."""

from __future__ import annotations

import math
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.cli.output import figure, fixed, line, new_table, print_table

if TYPE_CHECKING:
    import xarray as xr

    from rover_pin.analysis.traverse import LargestStep
    from rover_pin.rover import Rover

ABOUT = (
    "robot", "terrain", "path", "length_m", "step_m", "crab_rad", "friction", "gravity", "payload", "posture",
)  # fmt: skip


def traverse_object(data: xr.Dataset) -> dict[str, Any]:
    """What `traverse --json` prints; SI units, rad, null where there is none."""
    about = data.attrs
    stop = None
    if not about["passed"]:
        stop = {"way_m": about["stop_m"], "limit": about["stop_limit"], "why": about["stop_why"],
                "limiting": about["stop_at"] or None}  # fmt: skip
    return {
        **{name: about[name] for name in ABOUT},
        "passed": bool(about["passed"]),
        "unresolved_m": about["unresolved_m"],
        "stop": stop,
        "worst": worst(data),
        "steps": [_step(data, k) for k in range(data.sizes["step"])],
    }


def _step(data: xr.Dataset, k: int) -> dict[str, Any]:
    """One place."""
    wheels, joints = ([str(name) for name in data[dim].values] for dim in ("wheel", "joint"))
    plain = [str(n) for n, v in data.data_vars.items() if v.dims == ("step",)]
    told: dict[str, Any] = {}
    for name in plain:
        value = data[name].values[k]
        told[name] = (str(value) or None) if isinstance(value, str) else value
    for name in ("turning", "followed"):
        told[name] = bool(told[name])
    told["load_n"] = dict(zip(wheels, data["load_n"].values[k].tolist(), strict=True))
    told["torque_nm"] = dict(zip(wheels, data["torque_nm"].values[k].tolist(), strict=True))
    told["joint_rad"] = dict(zip(joints, data["joint_rad"].values[k].tolist(), strict=True))
    return told


def worst(data: xr.Dataset) -> dict[str, dict[str, Any]]:
    """Quantity: its worst `value` along the path, `unit`, where (`way_m`) and at what (`limiting`)."""
    found = {}
    wheels = [str(name) for name in data["wheel"].values]
    loads = np.asarray(data["load_n"].values)
    if np.isfinite(loads).any():
        k, j = np.unravel_index(int(np.nanargmax(loads)), loads.shape)
        found["load_n"] = _entry(data, int(k), float(loads[k, j]), "N", "low", wheels[int(j)])
    for name, at in (("friction_needed", ""), ("torque_needed", ""), ("effort_share", "")):
        entry = _extreme(data, name, "low", at)
        if entry is not None:
            found[name] = entry
    names = [name for name in str(data.attrs["measures"]).split(", ") if name]
    for name in names:
        entry = _extreme(data, name, str(data[name].attrs["better"]), f"{name}_limiting")
        if entry is not None:
            found[name] = entry
    return found


def _extreme(data: xr.Dataset, name: str, better: str, at: str) -> dict[str, Any] | None:
    values = np.asarray(data[name].values, dtype=np.float64)
    if np.isnan(values).all():
        return None
    k = int(np.nanargmin(values) if better == "high" else np.nanargmax(values))
    limiting = str(data[at].values[k]) if at else ""
    return _entry(data, k, float(values[k]), str(data[name].attrs["units"]), better, limiting)


def _entry(data: xr.Dataset, k: int, value: float, unit: str, better: str, at: str) -> dict[str, Any]:
    place = {name: float(data[name].values[k]) for name in ("way_m", "x_m", "y_m")}
    return {"value": value, "unit": unit, "better": better, "limiting": at or None, **place}


WORDS = {
    "load_n": "largest load",
    "friction_needed": "friction needed",
    "torque_needed": "torque needed",
    "effort_share": "share of efforts",
}


def print_traverse(data: xr.Dataset) -> None:
    """The worst of everything and where, and whether the path is passed."""
    about = data.attrs
    line(
        f"{about['robot']} on {about['terrain']}: {float(about['length_m']):.3f} m,"
        f" {data.sizes['step']} places, friction {about['friction']}"
    )
    table = new_table("", "worst along the path", "at", "value", "unit", "after m", "x m", "y m", left=2)
    for name, entry in worst(data).items():
        table.add_row(
            WORDS.get(name, name),
            entry["limiting"] or "-",
            "none" if math.isinf(entry["value"]) else figure(entry["value"]),
            "-" if entry["unit"] == "1" else entry["unit"],
            *(fixed(entry[key], 3) for key in ("way_m", "x_m", "y_m")),
        )
    print_table(table)
    if (data["status"].values.astype(str) == "settled").any():
        angles = [np.degrees(data[f"{name}_rad"].values) for name in ("roll", "pitch")]
        (low, high), (down, up) = ((np.nanmin(each), np.nanmax(each)) for each in angles)
        line(f"roll {fixed(low, 2)} to {fixed(high, 2)} deg, pitch {fixed(down, 2)} to {fixed(up, 2)} deg")
    if about["unresolved_m"]:
        gap = 1e3 * float(about["unresolved_m"])
        line(f"something changes within {gap:.2g} mm where the solver has no answer: a peak may be missed")
    if about["passed"]:
        line("passed")
        return
    at = f" at {about['stop_at']}" if about["stop_at"] else ""
    line(f"stops after {float(about['stop_m']):.3f} m: {about['stop_limit']}{at}: {about['stop_why']}")


def largest_object(rover: Rover, found: LargestStep) -> dict[str, Any]:
    """What `traverse --largest-step --json` prints."""
    told = asdict(found)
    for name in ("limit", "why", "limiting"):
        told[name] = told[name] or None
    trials = [
        {"height_m": height, "climbed": climbed}
        for height, climbed in zip(found.trials, found.climbs, strict=True)
    ]
    told.pop("climbs")
    renamed = {"climbed": "climbed_m", "stopped": "stopped_m", "torque_needed": "torque_needed_nm"}
    return {"robot": rover.name, **{renamed.get(k, k): v for k, v in told.items()}, "trials": trials}


def print_largest(rover: Rover, found: LargestStep) -> None:
    """The two heights, and what makes the difference."""
    if found.climbed:
        asks = f"asks for friction {figure(found.friction_needed)}"
        if not math.isnan(found.torque_needed):
            asks += f" and {figure(found.torque_needed)} N m"
        if not math.isnan(found.effort_share):
            asks += f", {100 * found.effort_share:.0f} % of the efforts"
        line(f"{rover.name} climbs a step of {1e3 * found.climbed:.1f} mm, which {asks}")
    else:
        line(f"{rover.name} climbs no step that was tried")
    if found.unresolved_m:
        gap = f"{1e3 * found.unresolved_m:.2g} mm"
        line(f"over {gap} of its way the solver has no answer: a peak may be missed")
    if math.isinf(found.stopped):
        line("that is the highest that was tried: give a higher --terrain step:HEIGHT,X")
        return
    at = f" at {found.limiting}" if found.limiting else ""
    line(f"{1e3 * found.stopped:.1f} mm stops it after {found.stop_m:.3f} m: {found.limit}{at}: {found.why}")
