"""`rover-pin mobility`: every place and heading of a height map, as files and a picture."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rover_pin.cli.options import (
    Gravity,
    HeightOffset,
    HeightScale,
    Interpolation,
    Json,
    Packages,
    Parameters,
    Payload,
    Posture,
    Sidecar,
    SkipIncludes,
    Spacing,
    load_rover,
    loaded,
)

if TYPE_CHECKING:
    import xarray as xr

    from rover_pin.rover import Rover
    from rover_pin.terrain import Terrain


def mobility(
    map_file: Annotated[
        str, typer.Argument(help="A height map's file, or rough:SEED,RMS,HURST.", metavar="MAP")
    ],
    robot: Annotated[
        str, typer.Option(help="Bundled name, or path of a URDF or xacro.", metavar="ROBOT")
    ] = "rocker_bogie",
    sidecar: Sidecar = None,
    package: Packages = None,
    skip_missing_includes: SkipIncludes = False,
    param: Parameters = None,
    posture: Posture = None,
    spacing: Spacing = None,
    interpolation: Interpolation = "smooth",
    height_scale: HeightScale = None,
    height_offset: HeightOffset = 0.0,
    headings: Annotated[int, typer.Option(help="How many, evenly over the circle.", metavar="N")] = 16,
    measure: Annotated[str, typer.Option(help="Of each stance: tip, clearance, loads, ...")] = "tip",
    every: Annotated[int, typer.Option(help="Take every N-th node along x and y.", metavar="N")] = 1,
    engine: Annotated[str, typer.Option(help="serial or process.")] = "process",
    workers: Annotated[
        int | None, typer.Option(help="Worker processes; silent: one a core.", metavar="N")
    ] = None,
    gravity: Gravity = "earth",
    payload: Payload = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Result, netCDF; silent: MAP_mobility.nc here.", metavar="OUT.nc"),
    ] = None,
    tiff: Annotated[
        Path | None, typer.Option(help="Write the worst heading's value as TIFF.", metavar="FILE")
    ] = None,
    png: Annotated[Path | None, typer.Option(help="Write a picture.", metavar="FILE")] = None,
    json: Json = False,
) -> int:
    """The worst and the best heading of a rover at every node of a height map."""
    from rover_pin.analysis import mobility as survey
    from rover_pin.analysis.words import gravity as parse_gravity
    from rover_pin.analysis.words import posture as parse_posture
    from rover_pin.cli.mobility_report import mobility_object, print_mobility
    from rover_pin.cli.output import INTERRUPTED, announce_compilation, aside, check_outputs, print_json
    from rover_pin.cli.progress import progress_bar
    from rover_pin.terrain import Terrain

    path = out or Path(f"{_stem(map_file)}mobility.nc")
    check_outputs(path, tiff, png)
    pull = parse_gravity(gravity)
    ground = Terrain.parse(map_file, spacing, interpolation, height_scale, height_offset)
    rover = loaded(load_rover(robot, sidecar, package, skip_missing_includes, param), payload)
    announce_compilation(batch=True)
    started = time.perf_counter()
    try:
        with progress_bar("cases") as progress:
            data = survey(
                rover,
                ground,
                headings,
                measure,
                posture=None if posture is None else parse_posture(posture),
                every=every,
                gravity=pull,
                engine=engine,
                workers=workers,
                progress=progress,
            )
    except KeyboardInterrupt:
        aside("interrupted; nothing is written")
        return INTERRUPTED
    seconds = time.perf_counter() - started
    _save(data, rover, ground, path, tiff, png)
    if json:
        print_json(mobility_object(data, seconds, path, tiff, png))
    else:
        print_mobility(data, seconds)
    for written in (path, tiff, png):
        if written is not None:
            aside(f"wrote {written}")
    return 0 if bool((data["settled_share"] > 0).any()) else 1


def _stem(map_file: str) -> str:
    """What the result's name begins with: the map's where that is a file."""
    path = Path(map_file)
    return f"{path.stem}_" if path.is_file() else ""


def _save(
    data: xr.Dataset, rover: Rover, ground: Terrain, out: Path, tiff: Path | None, png: Path | None
) -> None:
    from rover_pin import viz
    from rover_pin.analysis.mobility.result import write_netcdf, write_tiff
    from rover_pin.analysis.store import atomically

    write_netcdf(data, out)
    if tiff is not None:
        write_tiff(data, tiff)
    if png is not None:
        figure = viz.plot_mobility(data, rover, ground)
        atomically(png, lambda file: figure.savefig(file, format="png"))
