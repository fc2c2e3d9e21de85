"""`rover-pin study`: many cases into one file, a page and a summary."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rover_pin.cli.options import Json, OwnGravity, Payload, altered

if TYPE_CHECKING:
    import xarray as xr

    from rover_pin.analysis.study import Study

DRAWN = 50
"""Designs at most that a page draws each in its own shape."""


def study(
    spec: Annotated[
        Path | None, typer.Argument(help="Study file; silent: the default study.", metavar="SPEC")
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Result, netCDF; silent: SPEC.nc here.", metavar="OUT.nc"),
    ] = None,
    engine: Annotated[str, typer.Option(help="serial, process, ...")] = "process",
    workers: Annotated[
        int | None, typer.Option(help="Worker processes; silent: one a core.", metavar="N")
    ] = None,
    scheduler: Annotated[str | None, typer.Option(help="Of a cluster's engine.", metavar="ADDRESS")] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Go on with a run that was stopped.")] = False,
    html: Annotated[Path | None, typer.Option(help="Write the study's page.", metavar="FILE")] = None,
    gravity: OwnGravity = None,
    payload: Payload = None,
    json: Json = False,
) -> int:
    """Many cases of one question, each a row of a dataset."""
    from rover_pin.analysis import Study, probabilities
    from rover_pin.analysis.summary import statuses
    from rover_pin.cli.chance_report import chances_object, print_chances
    from rover_pin.cli.output import INTERRUPTED, announce_compilation, aside, check_outputs, print_json
    from rover_pin.cli.progress import progress_bar
    from rover_pin.cli.sensitivity_report import print_slopes, slopes_object
    from rover_pin.cli.study_report import print_study, study_object

    path = out or Path(f"{spec.stem if spec else 'study'}.nc")
    check_outputs(path, html)
    asked = altered(Study.default() if spec is None else Study.from_file(spec), gravity, payload)
    started = time.perf_counter()
    try:
        announce_compilation(batch=True)
        with progress_bar("cases") as progress:
            data = asked.run(
                engine=engine,
                workers=workers,
                scheduler=scheduler,
                out=path,
                resume=resume,
                progress=progress,
            )
    except KeyboardInterrupt:
        kept = path.with_name(f"{path.name}.parts")
        if kept.is_dir():
            aside(f"interrupted; what is finished is kept in {kept}: go on with --resume")
        else:
            aside("interrupted before anything was finished")
        return INTERRUPTED
    seconds = time.perf_counter() - started
    ended = statuses(data)
    slopes, indices, chances = _slopes(asked, data), _indices(asked, data), probabilities(data)
    if html is not None:
        _save_page(asked, data, slopes, html)
    if json:
        print_json(
            {
                **study_object(data, ended, path, html, seconds),
                **slopes_object(slopes),
                **chances_object(chances, indices),
            }
        )
    else:
        print_study(data, ended, seconds)
        print_slopes(slopes)
        print_chances(chances, indices)
    for written in (path, html):
        if written is not None:
            aside(f"wrote {written}")
    return 0 if ended.get("settled") else 1


def _slopes(asked: Study, data: xr.Dataset) -> xr.Dataset | None:
    """The sensitivities, where the study takes them and its nominal design settles."""
    from rover_pin.analysis.sensitivity import sensitivity

    wanted = asked.spec.cases.sampler == "sensitivity" and str(data["status"].values[0]) == "settled"
    return sensitivity(data) if wanted else None


def _indices(asked: Study, data: xr.Dataset) -> xr.Dataset | None:
    """The Sobol indices, where the study drew a sample for them and enough of it has answers."""
    from rover_pin.analysis import sobol_indices
    from rover_pin.cli.output import aside
    from rover_pin.errors import StudyError

    if asked.spec.cases.sampler != "saltelli":
        return None
    try:
        return sobol_indices(data)
    except StudyError as error:
        aside(f"no Sobol indices: {error}")
        return None


def _save_page(asked: Study, data: xr.Dataset, slopes: xr.Dataset | None, html: Path) -> None:
    """The study's page; its worst cases, or each design of a small sweep, settled anew for their contacts."""
    from rover_pin import viz

    if slopes is not None:
        viz.save_sensitivity_page(slopes, html)
        return
    each = len(asked) <= DRAWN and asked.plan.job.cases.questions.parameters
    ready = asked.plan
    cases = range(len(asked)) if each else viz.exact_cases(data, ready.rover, ready.job.terrain)
    stances = {case: asked.stance(case) for case in cases}
    viz.save_study_page(data, html, rover=ready.rover, terrain=ready.job.terrain, stances=stances)
