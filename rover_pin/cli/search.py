"""`rover-pin search`: the design that is best in one figure and keeps bounds on others."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated

import typer

from rover_pin.cli.options import Json, OwnGravity, Payload, altered


def search(
    spec: Annotated[Path, typer.Argument(help="Study file with a `search` entry.", metavar="SPEC")],
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Result, netCDF; silent: SPEC.nc here.", metavar="OUT.nc"),
    ] = None,
    html: Annotated[Path | None, typer.Option(help="Write the search's page.", metavar="FILE")] = None,
    gravity: OwnGravity = None,
    payload: Payload = None,
    json: Json = False,
) -> int:
    """A search for the best design under bounds; exit status 1 where none keeps them."""
    from rover_pin.analysis import Study
    from rover_pin.analysis.search import search as run
    from rover_pin.analysis.store import atomically
    from rover_pin.cli.output import announce_compilation, aside, check_outputs, print_json
    from rover_pin.cli.progress import progress_bar
    from rover_pin.cli.search_report import print_search, search_object

    path = out or Path(f"{spec.stem}.nc")
    check_outputs(path, html)
    study = altered(Study.from_file(spec), gravity, payload)
    started = time.perf_counter()
    announce_compilation(batch=True)
    with progress_bar("trials") as progress:
        data = run(study, progress)
    seconds = time.perf_counter() - started
    atomically(path, lambda file: file.write(bytes(data.to_netcdf(engine="h5netcdf"))))
    if html is not None:
        from rover_pin.viz.page.search import save_search_page

        save_search_page(data, html)
    if json:
        print_json(search_object(data, path, html, seconds))
    else:
        print_search(data, seconds)
    for written in (path, html):
        if written is not None:
            aside(f"wrote {written}")
    return 0 if int(data.attrs["best_trial"]) >= 0 else 1
