"""The page of a study's result as `study --html` writes it and `view` shows it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from rover_pin.viz.page.html import write_whole
from rover_pin.viz.page.matters import matters_of
from rover_pin.viz.page.sensitivity import sensitivity_page
from rover_pin.viz.page.several import exact_cases
from rover_pin.viz.page.study import study_page

if TYPE_CHECKING:
    import xarray as xr

    from rover_pin.analysis.chances import Probability
    from rover_pin.analysis.study import Study

DRAWN = 50
"""Designs at most that a page draws each in its own shape."""


def save_result_page(
    data: xr.Dataset,
    path: str | Path,
    *,
    study: Study | None = None,
    cases: Sequence[int] = (),
    slopes: xr.Dataset | None = None,
    chances: Sequence[Probability] | None = None,
    indices: xr.Dataset | str | None = None,
) -> Path:
    """Write the page of a study's result, whole or not at all; arguments as in `result_page`.

    Raises:
        InputError: the file cannot be written.
    """
    text = result_page(data, study=study, cases=cases, slopes=slopes, chances=chances, indices=indices)
    return write_whole(path, text.encode("utf-8"))


def result_page(
    data: xr.Dataset,
    *,
    study: Study | None = None,
    cases: Sequence[int] = (),
    slopes: xr.Dataset | None = None,
    chances: Sequence[Probability] | None = None,
    indices: xr.Dataset | str | None = None,
) -> str:
    """The page's HTML text: of sensitivities where the study takes them, else of all its cases.

    Its worst cases and bad ones in which a wheel touches in several places, or each design of a small sweep,
    are settled anew for their contacts.

    Args:
        data: the result.
        study: that it came from; the one in the result where silent.
        cases: further ones to settle anew.
        slopes: of `sensitivity`, where known.
        chances: of `probabilities`, where known.
        indices: of `sobol_indices`, where known, or why there are none.

    Raises:
        StudyError: the study is not in the result, or there is no such case.
    """
    from rover_pin.analysis.sensitivity import sensitivity
    from rover_pin.analysis.study import Study

    sampler, nominal = data.attrs.get("sampler"), str(data["status"].values[0])
    if slopes is None and sampler == "sensitivity" and nominal == "settled":
        slopes = sensitivity(data)
    if slopes is not None:
        return sensitivity_page(slopes)
    asked = Study.from_dataset(data) if study is None else study
    ready = asked.plan
    each = len(asked) <= DRAWN and ready.job.cases.questions.parameters
    exact = range(len(asked)) if each else exact_cases(data, ready.rover, ready.job.terrain)
    stances = {case: asked.stance(case) for case in dict.fromkeys([*cases, *exact])}
    matters = matters_of(data, chances, indices)
    return study_page(data, ready.rover, ready.job.terrain, stances, matters=matters)
