"""Probabilities and Sobol indices as the objects and the tables that `study` prints."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.cli.output import figure, line, new_table, print_table

if TYPE_CHECKING:
    import xarray as xr

    from rover_pin.analysis.chances import Probability

TOLD = 5
"""Inputs a figure in the table: those that matter most."""


def chances_object(found: list[Probability], indices: xr.Dataset | None) -> dict[str, Any]:
    """`probabilities` by event, and `sobol`: figure, then input, to both orders with half-widths."""
    out: dict[str, Any] = {}
    if found:
        out["probabilities"] = {
            each.event: {
                "probability": each.share,
                "low": each.low,
                "high": each.high,
                "count": each.count,
                "cases": each.cases,
                "without_answer": each.silent,
                "rule": each.rule,
                "interval": each.interval,
            }
            for each in found
        }
    if indices is not None:
        kinds = ("first", "first_conf", "total", "total_conf")
        out["sobol"] = {
            str(name): {
                "blocks": int(indices.blocks.values[i]),
                "dropped": int(indices.dropped.values[i]),
                "inputs": {
                    str(each): {kind: float(indices[kind].values[i, k]) for kind in kinds}
                    for k, each in enumerate(indices.input.values)
                },
            }
            for i, name in enumerate(indices.figure.values)
        }
        out["sobol_refused"] = str(indices.attrs["refused"]).splitlines()
    return out


def print_chances(found: list[Probability], indices: xr.Dataset | None) -> None:
    """Each probability in a line, then the inputs that matter for each figure."""
    for each in found:
        said = f"{100 * each.share:.3g} % ({100 * each.low:.3g} to {100 * each.high:.3g} %)"
        left = f"; {each.silent} without an answer left out" if each.silent else ""
        line(f"probability of {each.event}: {said}, {each.count} of {each.cases}: {each.rule}{left}")
    if found:
        line(f"intervals of 95 %: {found[0].interval}")
    if indices is None:
        return
    table = new_table("Sobol indices", "figure", "input", "first", "+-", "total", "+-", left=2)
    for i, name in enumerate(indices.figure.values):
        if "/" in str(name):
            continue  # of each wheel and track: in the object and on the page
        total = np.nan_to_num(indices.total.values[i], nan=-1.0)
        for k in np.argsort(-total, kind="stable")[:TOLD]:
            if total[k] >= 0.005:
                numbers = (
                    indices[kind].values[i, k] for kind in ("first", "first_conf", "total", "total_conf")
                )
                table.add_row(
                    str(name), str(indices.input.values[k]), *(figure(float(v), 2) for v in numbers)
                )
    print_table(table)
    dropped = int(indices.dropped.values.max())
    if dropped:
        line(f"up to {dropped} blocks dropped: {indices.attrs['why_dropped']}")
    for refused in str(indices.attrs["refused"]).splitlines():
        line(f"no indices of {refused}")
