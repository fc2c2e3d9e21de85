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
    from rover_pin.viz import save_result_page

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
    slopes, chances = _slopes(asked, data), probabilities(data)
    indices, refused = _indices(asked, data)
    if html is not None:
        known = refused if indices is None else indices
        save_result_page(data, html, study=asked, slopes=slopes, chances=chances, indices=known)
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


def _indices(asked: Study, data: xr.Dataset) -> tuple[xr.Dataset | None, str | None]:
    """The Sobol indices, where the study drew a sample for them, or why there are none."""
    from rover_pin.analysis import sobol_indices
    from rover_pin.cli.output import aside
    from rover_pin.errors import StudyError

    if asked.spec.cases.sampler != "saltelli":
        return None, None
    try:
        return sobol_indices(data), None
    except StudyError as error:
        aside(f"no Sobol indices: {error}")
        return None, str(error)
