"""What each parameter does to each figure at one design: slopes, and whether they can be trusted as such."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rover_pin.analysis.figures import figures_of, parameter_units, parameters_of, unit
from rover_pin.analysis.one_by_one import MOVES
from rover_pin.errors import StudyError
from rover_pin.numerics import Array

if TYPE_CHECKING:
    import xarray as xr

NOISE = 1e-7
"""Share of a figure's size below which a change is what solving leaves."""


def sensitivity(data: xr.Dataset) -> xr.Dataset:
    """Slopes of every figure over every parameter, from the result of a study with the sampler `sensitivity`.

    Central differences of second order, over the two near cases; one-sided ones of second order where a bound
    is in the way.

    Returns:
        Dimensions figure, parameter. `slope`: derivative, SI unit of the figure a unit of the parameter.
        `per_percent`: the figure's change a hundredth of the parameter's value (NaN where that is 0).
        `nonlinearity`: difference of the slopes over the far and the near cases, over the larger [-]: 0 where
        the figure is a line. `kink`: difference of the slopes to both sides, likewise; NaN where one-sided.
        `nominal_figure`, `nominal` (of the parameter), `step`. NaN where a case did not settle: `answered`
        (parameter) counts the neighbours that did.

    Raises:
        StudyError: another study's result, or a nominal design that does not settle.
    """
    import xarray as xr

    values, nominal, near = _moves(data)
    if str(data["status"].values[0]) != "settled":
        word = str(data["status"].values[0])
        raise StudyError("the nominal design does not settle", element="case 0", value=word)
    names, table = list(figures_of(data)), np.array(list(figures_of(data).values()))
    settled = data["status"].values.astype(str) == "settled"
    out = {key: np.full((len(names), len(nominal)), np.nan) for key in ("slope", "nonlinearity", "kink")}
    for k in range(len(nominal)):
        cases = slice(1 + MOVES * k, 1 + MOVES * (k + 1))
        slopes = _slopes(values[k, cases] - nominal[k], table[:, cases] - table[:, :1])
        for key, column in zip(out, _judged(*slopes, near[k], np.abs(table[:, 0])), strict=True):
            out[key][:, k] = column
    share = np.where(nominal == 0.0, np.nan, np.abs(nominal) / 100.0)
    dims = ("figure", "parameter")
    parameters, units = list(parameter_units(data)), parameter_units(data)
    probed = [name for name in parameters if name in _probed(data)]
    neighbours = settled[1:].reshape(len(nominal), MOVES).sum(axis=1)
    return xr.Dataset(
        {
            **{key: (dims, value) for key, value in out.items()},
            "per_percent": (dims, out["slope"] * share),
            "nominal_figure": ("figure", table[:, 0]),
            "nominal": ("parameter", nominal),
            "step": ("parameter", near),
            "answered": ("parameter", neighbours),
            "figure_unit": ("figure", [unit(name) for name in names]),
            "parameter_unit": ("parameter", [units[name] for name in probed]),
        },
        coords={"figure": names, "parameter": probed},
        attrs={key: data.attrs[key] for key in ("title", "robot", "terrain", "study", "created", "gravity")},
    )


def is_sensitivity(data: xr.Dataset) -> bool:
    """Whether a result is one that `sensitivity` reads."""
    probed = _probed(data)
    return bool(probed) and data.attrs.get("sampler") == "sensitivity"


def _probed(data: xr.Dataset) -> dict[str, Array]:
    return {name: each for name, each in parameters_of(data).items() if np.ptp(each) > 0}


def _moves(data: xr.Dataset) -> tuple[Array, Array, Array]:
    """(p, n) values of the probed parameters, (p,) their nominal values and lesser moves."""
    if not is_sensitivity(data):
        cure = "run a study with cases: sensitivity"
        raise StudyError("is no result of a study of sensitivity", element="cases", cure=cure)
    values = np.array(list(_probed(data).values()))
    nominal = values[:, 0]
    near = np.array([np.min(np.abs(v[1 + MOVES * k :][:MOVES] - v[0])) for k, v in enumerate(values)])
    return values, nominal, near


def _slopes(moves: Array, changes: Array) -> tuple[Array, Array, Array]:
    """(f,) slopes at the nominal value over the far and over the near pair; (f, 2) slopes to either side.

    Args:
        moves: (4,) of the parameter: the far pair, then the near one.
        changes: (f, 4) of the figures.
    """
    far, near = (_parabola(moves[pair], changes[:, pair]) for pair in (slice(0, 2), slice(2, 4)))
    one_sided = moves[2] * moves[3] > 0
    return far, near, np.full_like(changes[:, 2:], np.nan) if one_sided else changes[:, 2:] / moves[2:]


def _parabola(moves: Array, changes: Array) -> Array:
    """(f,) slope at 0 of the parabola through 0 and two points."""
    a, b = moves
    slope: Array = (changes[:, 0] * b**2 - changes[:, 1] * a**2) / (a * b * (b - a))
    return slope


def _judged(far: Array, near: Array, sides: Array, step: float, size: Array) -> tuple[Array, Array, Array]:
    """The slope, how far it is from a line's, and how far apart the sides are."""
    least = NOISE * np.maximum(size, NOISE) / step
    curved = np.abs(far - near) / np.maximum(np.maximum(np.abs(far), np.abs(near)), least)
    broken = np.abs(sides[:, 1] - sides[:, 0]) / np.maximum(np.abs(sides).max(axis=1), least)
    return near, curved, broken
