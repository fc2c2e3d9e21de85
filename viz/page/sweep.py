"""A sweep on a study's page: which one or two quantities vary, and the charts over them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.viz.units import ranked, shown, title_of

if TYPE_CHECKING:
    import xarray as xr

PLACE = {"x_m": "x", "y_m": "y", "yaw_rad": "Yaw"}
FIXED = (("pitch_rad", "Pitch"), ("roll_rad", "Roll"), ("z_m", "Height of the root link"))


def sweep_of(dataset: xr.Dataset) -> dict[str, Any] | None:
    """What the page draws instead of the map: axes and charts; None where the study is no sweep.

    A sweep varies one quantity, or two in every combination, and not just the place on the map.
    """
    axes = _varied(dataset)
    if not 1 <= len(axes) <= 2 or set(axes) == {"x_m", "y_m"}:
        return None
    if any(dataset[name].dtype.kind not in "fiu" for name in axes):
        return None
    sizes = [len(np.unique(dataset[name].values)) for name in axes]
    if dataset.sizes["case"] != np.prod(sizes) or min(sizes) < 2:
        return None
    return {"axes": [_axis(dataset, name) for name in axes], "charts": _charts(dataset)}


def _varied(dataset: xr.Dataset) -> list[str]:
    return [
        str(name)
        for name, values in dataset.data_vars.items()
        if values.dims == ("case",) and values.attrs.get("varied") and "better" not in values.attrs
    ]


def _axis(dataset: xr.Dataset, name: str) -> dict[str, Any]:
    unit, factor = _unit(dataset, name)
    words = PLACE.get(name) or str(dataset[name].attrs.get("parameter", name)).replace("_", " ")
    return {"name": name, "title": words[0].upper() + words[1:], "unit": unit, "factor": factor}


def _unit(dataset: xr.Dataset, name: str) -> tuple[str, float]:
    unit = str(dataset[name].attrs.get("units", ""))
    return ("", 1.0) if unit in ("", "1") else shown(unit)


def _charts(dataset: xr.Dataset) -> list[dict[str, Any]]:
    """Attitude, how the wheels carry, tensions, loads, measures; a chart has a line or several.

    A wheel or track that never carries has none.
    """
    charts = [_chart(dataset, name, title) for name, title in FIXED if _moves(dataset, name)]
    charts += [
        _chart(dataset, name, title_of(name)) for name in ("touching", "load_spread") if name in dataset
    ]
    for name, title, dim in (("tension_n", "Track tension", "track"), ("load_n", "Wheel loads", "wheel")):
        if name in dataset:
            labels = [str(each) for each in dataset[dim].values]
            lines = [
                {"name": f"{name}/{label}", "label": label}
                for k, label in enumerate(labels)
                if np.nanmax(np.abs(dataset[name].values[:, k]), initial=0.0) > 0.0
            ]
            charts += [{**_chart(dataset, name, title), "lines": lines}] if lines else []
    measures = [
        str(name)
        for name in dataset.data_vars
        if f"{name}_limiting" in dataset and np.isfinite(dataset[name].values).any()
    ]
    return charts + [_chart(dataset, name, title_of(name, dataset[name].attrs)) for name in ranked(measures)]


def _moves(dataset: xr.Dataset, name: str) -> bool:
    """Whether a figure is worth a chart: a flat line of rounding is not."""
    values = dataset[name].values
    finite = values[np.isfinite(values)]
    return bool(len(finite) and np.ptp(finite) > 1e-9)


def _chart(dataset: xr.Dataset, name: str, title: str) -> dict[str, Any]:
    unit, factor = _unit(dataset, name)
    better = str(dataset[name].attrs.get("better", ""))
    lines = [{"name": name, "label": ""}]
    return {"title": title, "unit": unit, "factor": factor, "better": better, "lines": lines}
