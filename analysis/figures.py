"""The figures of a study: every number that a case answers with, by its name."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.analysis.rows import TENSION, Layout
from rover_pin.analysis.schema import ABOUT, CARRYING
from rover_pin.numerics import Array
from rover_pin.stability.registry import MEASURES

if TYPE_CHECKING:
    import xarray as xr

ATTITUDE = ("pitch_rad", "roll_rad", "z_m")


def figures(values: Callable[[str], Array], layout: Layout) -> dict[str, Array]:
    """Figures by name, each (n,): attitude, how the wheels carry, tensions, loads, measures.

    What there is one of for each wheel or track is named like `load_n/fl` and `tension_n/left`.

    Args:
        values: the columns of a result by name: (n,) or (n, wheels or tracks).
        layout: the names.
    """
    loads = values("load_n")
    out = {name: values(name) for name in ATTITUDE}
    out |= {name: formula(loads[:, layout.bearing]) for name, (formula, _) in CARRYING.items()}
    if layout.tracks:
        tension = values(TENSION)
        out |= {f"{TENSION}/{name}": tension[:, k] for k, name in enumerate(layout.tracks)}
    out |= {f"load_n/{name}": loads[:, k] for k, name in enumerate(layout.wheels)}
    return out | {name: values(name) for name in layout.margins}


def figures_of(data: xr.Dataset) -> dict[str, Array]:
    """The figures of a result that is small enough for memory."""
    return figures(lambda name: np.asarray(data[name].values, dtype=np.float64), layout_of(data))


def layout_of(data: xr.Dataset) -> Layout:
    """The names in a result."""

    def labels(name: str) -> tuple[str, ...]:
        return tuple(str(each) for each in data[name].values) if name in data.dims else ()

    idle = str(data["load_n"].attrs.get("auxiliary", ""))
    return Layout(
        wheels=labels("wheel"),
        joints=labels("joint"),
        measures=tuple(str(name) for name in data.data_vars if f"{name}_limiting" in data),
        tracks=labels("track"),
        auxiliary=tuple(idle.split(", ")) if idle else (),
    )


def unit(name: str) -> str:
    """A figure's unit, SI."""
    stem = name.partition("/")[0]
    return ABOUT[stem][0] if stem in ABOUT else MEASURES[stem].unit


def parameters_of(data: xr.Dataset) -> dict[str, Array]:
    """The parameters that a result asked for, by their declared names, each (n,)."""
    return {
        str(column.attrs["parameter"]): np.asarray(column.values, dtype=np.float64)
        for column in data.data_vars.values()
        if "parameter" in column.attrs
    }


def parameter_units(data: xr.Dataset) -> dict[str, str]:
    """The unit of each of them, as the sidecar words it."""
    return {
        str(column.attrs["parameter"]): str(column.attrs.get("units", ""))
        for column in data.data_vars.values()
        if "parameter" in column.attrs
    }
