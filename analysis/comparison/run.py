"""compare: designs side by side on the same cases; paired: results that are there already."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rover_pin.analysis.comparison.design import designs_of
from rover_pin.analysis.comparison.pairing import check_pairing, shared_measures
from rover_pin.analysis.comparison.result import Comparison, figures
from rover_pin.analysis.comparison.same_cases import DEFAULT, studies
from rover_pin.analysis.study import Progress, Study
from rover_pin.errors import StudyError

if TYPE_CHECKING:
    import xarray as xr


def compare(
    designs: Sequence[Any] | Mapping[str, Any],
    study: Study | str | Path | None = None,
    *,
    engine: str = "serial",
    workers: int | None = None,
    out: Mapping[str, Path] | None = None,
    progress: Progress | None = None,
    seed: int = 0,
    **keys: Any,
) -> Comparison:
    """Designs side by side on the same terrain, at the same places and headings, with the same draws.

    Args:
        designs: two or more: words like `rocker_bogie:track=1.1,posture=home`, loaded rovers, or `Design`s;
            a mapping says what they are called.
        study: a study or its file, whose robot the designs replace; None for 1000 places of rough ground.
        engine: as for `Study.run`.
        workers: likewise.
        out: where each result is kept, by label; None keeps them in memory.
        progress: called with finished and all cases of all designs.
        seed: of the bootstrap.
        keys: further keys of a study file (`terrain`, `cases`, `vary`, `measures`, `gravity`, ...).

    Returns:
        The figures, and each design's Dataset. A measure asked for by the keyword `measures` must be one that
        all designs can have; those of the study that one cannot have are left out and named.

    Raises:
        InputError: less than two designs, one twice, or one that cannot be used; a key likewise.
        SolverError: a case failed in a way that no status describes.
    """
    chosen = designs_of(designs)
    template = _template(study)
    asked = studies(chosen, template, **keys)
    if keys.get("measures") is not None:
        _check_measures(asked)
    results: dict[str, xr.Dataset] = {}
    total = sum(len(each) for each in asked.values())
    for label, each in asked.items():
        before = sum(data.sizes["case"] for data in results.values())
        results[label] = each.run(
            engine=engine,
            workers=workers,
            out=None if out is None else out[label],
            progress=None if progress is None else _shifted(progress, before, total),
        )
    return paired(results, studies=asked, seed=seed)


def paired(
    datasets: Mapping[str, xr.Dataset], *, studies: Mapping[str, Study] | None = None, seed: int = 0
) -> Comparison:
    """Results of studies side by side, case by case.

    Args:
        datasets: two or more by label, of studies with the same terrain and the same cases.
        studies: where they came from, for stances.
        seed: of the bootstrap.

    Raises:
        StudyError: less than two, another terrain, other cases, or no measure in common.
    """
    if len(datasets) < 2:
        raise StudyError("there is nothing to compare with", element="results", value=len(datasets))
    check_pairing(datasets)
    units, better, left_out = shared_measures(datasets)
    singles, pairs = figures(datasets, better, seed)
    known = dict(studies or {})
    return Comparison(dict(datasets), known, units, better, left_out, singles, pairs, _same(known))


def _template(study: Study | str | Path | None) -> Study:
    if isinstance(study, Study):
        return study
    return Study.from_text(DEFAULT) if study is None else Study.from_file(study)


def _check_measures(asked: Mapping[str, Study]) -> None:
    """Refuse measures asked for by name that a design cannot have."""
    for label, study in asked.items():
        for name, why in study.plan.left_out.items():
            cure = "leave it out of the measures"
            raise StudyError(f"cannot have the measure {name}: {why}", element=f"design {label}", cure=cure)


def _same(studies: Mapping[str, Study]) -> tuple[tuple[str, str], ...]:
    """Pairs of designs that are one, said differently: the same numbers go into their cases."""
    prints = {label: _print(study) for label, study in studies.items()}
    return tuple((a, b) for a, b in combinations(prints, 2) if prints[a] == prints[b])


def _print(study: Study) -> tuple[Any, ...]:
    """All that decides a design's answers."""
    job = study.plan.job
    fixed = {name: quantity.ends for name, quantity in job.cases.questions.parameters.items()}
    rover = job.rover if not fixed else job.rover.with_parameters(**{n: e[0] for n, e in fixed.items()})
    return (
        rover.urdf,
        rover.recipe.sidecar_text,
        rover.recipe.payload,
        tuple(sorted(rover.parameters.items())),
        (job.cases.questions.postures or ("home",)),
    )


def _shifted(progress: Progress, before: int, total: int) -> Progress:
    return lambda finished, _: progress(before + finished, total)
