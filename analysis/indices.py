"""Which of the things that vary matter: Sobol indices of every figure, by SALib from a Saltelli sample.

First order: the share of a figure's variance that is gone when an input is known. Total: the share that is
left when all the others are known. Estimators of Saltelli et al. 2010 (doi:10.1016/j.cpc.2009.09.018),
intervals by bootstrap.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.analysis.figures import figures_of, unit
from rover_pin.analysis.saltelli import problem_of, salib
from rover_pin.errors import StudyError
from rover_pin.numerics import Array

if TYPE_CHECKING:
    import xarray as xr

MOST_DROPPED = 0.1
"""Share of blocks that may be without an answer: what is left is not what was asked."""

RESAMPLES = 200
CONFIDENCE = 0.95

STILL = 1e-9
"""Standard deviation of a figure, over its size, that is as good as none."""


def sobol_indices(data: xr.Dataset, figures: Mapping[str, Array] | None = None) -> xr.Dataset:
    """First and total order indices of figures over what a study with the sampler `saltelli` varied.

    A block with a case that has no number is dropped.

    Args:
        data: its result.
        figures: (cases,) numbers by name; silent: those of the study.

    Returns:
        Dimensions figure, input. `first`, `total`; `first_conf`, `total_conf`: half-widths of their 95 %
        intervals, all [-]; NaN where a figure does not vary. `blocks`, `dropped` (figure). Attribute
        `refused`: figures of which more than a tenth of the blocks are dropped, one a line.

    Raises:
        StudyError: another study's result, or one in which every figure is refused.
    """
    import xarray as xr

    if data.attrs.get("sampler") != "saltelli" or "inputs" not in data.attrs:
        cure = "run a study with cases: {sampler: saltelli, n: 1024}"
        raise StudyError("is no result of a Saltelli sample", element="cases.sampler", cure=cure)
    inputs = tuple(str(data.attrs["inputs"]).split("\n"))
    asked = figures_of(data) if figures is None else figures
    keys = ("first", "first_conf", "total", "total_conf")
    rows: dict[str, Array] = {}
    counts: dict[str, tuple[int, int]] = {}
    refused: dict[str, str] = {}
    for name, values in asked.items():
        blocks = np.asarray(values, dtype=np.float64).reshape(-1, len(inputs) + 2)
        kept = blocks[np.isfinite(blocks).all(axis=1)]
        dropped = len(blocks) - len(kept)
        if dropped > MOST_DROPPED * len(blocks):
            refused[name] = f"{name}: {dropped} of {len(blocks)} blocks dropped ({_why(data)})"
            continue
        rows[name] = _read(kept, inputs, int(data.attrs.get("seed", 0)))
        counts[name] = len(kept), dropped
    if not rows:
        what = "too many blocks have a case without an answer"
        cure = "narrow what varies: at most a tenth may be dropped"
        raise StudyError(what, element="indices", value=next(iter(refused.values()), "no figure"), cure=cure)
    table = np.array(list(rows.values()))
    return xr.Dataset(
        {key: (("figure", "input"), table[:, k]) for k, key in enumerate(keys)}
        | {
            "blocks": ("figure", [kept for kept, _ in counts.values()]),
            "dropped": ("figure", [dropped for _, dropped in counts.values()]),
            "figure_unit": ("figure", [unit(name) if figures is None else "" for name in rows]),
        },
        coords={"figure": list(rows), "input": list(inputs)},
        attrs={"refused": "\n".join(refused.values()), "why_dropped": _why(data), "confidence": CONFIDENCE},
    )


def _why(data: xr.Dataset) -> str:
    """How many cases ended without a stance, in which way."""
    words, counts = np.unique(data["status"].values.astype(str), return_counts=True)
    return ", ".join(f"{n} {word}" for word, n in zip(words, counts, strict=True) if word != "settled") or (
        "a figure without a number"
    )


def _read(blocks: Array, inputs: tuple[str, ...], seed: int) -> Array:
    """(4, inputs): first, its half-width, total, its half-width."""
    spread = blocks.std()
    if not spread > STILL * max(1.0, float(np.abs(blocks).max())):
        return np.full((4, len(inputs)), np.nan)
    told = salib()[1].analyze(
        problem_of(inputs),
        blocks.ravel(),
        calc_second_order=False,
        num_resamples=RESAMPLES,
        conf_level=CONFIDENCE,
        seed=seed + 1,  # SALib takes 0 for none
    )
    return np.array([told[key] for key in ("S1", "S1_conf", "ST", "ST_conf")])
