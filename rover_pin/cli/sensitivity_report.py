"""Sensitivities as the object and the table that `study` prints."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.cli.output import figure, new_table, print_table

if TYPE_CHECKING:
    import xarray as xr

TOLD = 5
"""Parameters a figure in the table: the strongest."""


def slopes_object(slopes: xr.Dataset | None) -> dict[str, Any]:
    """`sensitivities`: figure, then parameter, to slope, change a per cent, nonlinearity and kink."""
    if slopes is None:
        return {}
    kinds = ("slope", "per_percent", "nonlinearity", "kink")
    table = {
        str(name): {
            str(parameter): {kind: float(slopes[kind].values[i, k]) for kind in kinds}
            for k, parameter in enumerate(slopes.parameter.values)
        }
        for i, name in enumerate(slopes.figure.values)
    }
    nominal = dict(zip(slopes.parameter.values.tolist(), slopes.nominal.values.tolist(), strict=True))
    return {"sensitivities": table, "nominal": nominal}


def print_slopes(slopes: xr.Dataset | None) -> None:
    """The strongest parameters of each figure."""
    if slopes is None:
        return
    table = new_table("sensitivities", "figure", "parameter", "nominal", "slope", "for +1 %", "kink", left=2)
    for i, name in enumerate(slopes.figure.values):
        strength = np.nan_to_num(np.abs(slopes.per_percent.values[i]))
        unit = str(slopes.figure_unit.values[i]).replace("-", "1")
        for k in np.argsort(-strength, kind="stable")[:TOLD]:
            if strength[k] > 1e-9:
                each = slopes.isel(figure=i, parameter=int(k))
                per = str(each.parameter_unit.item()) or "1"
                table.add_row(
                    str(name),
                    str(each.parameter.item()),
                    f"{figure(float(each.nominal))} {per}",
                    f"{figure(float(each.slope))} {unit}/({per})",
                    figure(float(each.per_percent)),
                    figure(float(each.kink), 2),
                )
    print_table(table)
