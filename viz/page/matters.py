"""What matters, for the panel of the study's page: Sobol indices with intervals, probabilities in words."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.errors import StudyError
from rover_pin.viz.units import TITLES

if TYPE_CHECKING:
    import xarray as xr

    from rover_pin.analysis.chances import Probability


def matters_of(
    dataset: xr.Dataset,
    chances: Sequence[Probability] | None = None,
    indices: xr.Dataset | str | None = None,
) -> dict[str, Any] | None:
    """`said`: sentences; `figures`: name, title and rows (input, first, +-, total, +-), most telling first.

    None where the study drew nothing at random.

    Args:
        dataset: of a Study.
        chances: of `probabilities`, worked out where silent.
        indices: of `sobol_indices`, or why there are none; worked out where silent.
    """
    from rover_pin.analysis.chances import probabilities

    found = probabilities(dataset) if chances is None else chances
    said = [
        f"Probability of {p.event}: {100 * p.share:.3g} % (95 %: {100 * p.low:.3g} to {100 * p.high:.3g} %), "
        f"{p.count} of {p.cases} cases: {p.rule}."
        + (f" {p.silent} cases without an answer are left out." if p.silent else "")
        for p in found
    ]
    if found:
        said.append(f"Intervals: {found[0].interval}.")
    figures: list[dict[str, Any]] = []
    if dataset.attrs.get("sampler") == "saltelli":
        known = _indices(dataset) if indices is None else indices
        if isinstance(known, str):
            said.append(f"No Sobol indices: {known}.")
        else:
            figures = _figures(known, said)
    return {"said": said, "figures": figures} if said else None


def _indices(dataset: xr.Dataset) -> xr.Dataset | str:
    from rover_pin.analysis.indices import sobol_indices

    try:
        return sobol_indices(dataset)
    except StudyError as error:
        return str(error)


def _figures(found: xr.Dataset, said: list[str]) -> list[dict[str, Any]]:
    """The figures that vary; what was dropped or refused is told."""
    most = int(found.dropped.values.max())
    if most:
        said.append(f"Up to {most} blocks of cases dropped: {found.attrs['why_dropped']}.")
    said += [f"No indices of {line}." for line in str(found.attrs["refused"]).splitlines()]
    out = []
    for i, name in enumerate(found.figure.values):
        table = np.stack(
            [found[key].values[i] for key in ("first", "first_conf", "total", "total_conf")], axis=1
        )
        if np.isnan(table).any():
            continue
        order = np.argsort(-table[:, 2], kind="stable")
        rows = [[str(found.input.values[k]), *np.round(table[k], 4).tolist()] for k in order]
        out.append({"name": str(name), "title": _title(str(name)), "rows": rows})
    return sorted(out, key=lambda each: each["name"] not in TITLES)


def _title(name: str) -> str:
    stem, _, label = name.partition("/")
    title = TITLES.get(stem) or stem.removesuffix("_rad").removesuffix("_n").removesuffix("_m").replace(
        "_", " "
    )
    return f"{title.capitalize() if stem not in TITLES else title}{f' {label}' if label else ''}"
