"""`rover-pin traverse`: loads, friction, torque, margins and posture along a line, and where it stops."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rover_pin.cli.options import (
    Friction,
    Gravity,
    HeightOffset,
    HeightScale,
    Interpolation,
    Joints,
    Json,
    Locks,
    Packages,
    Parameters,
    Payload,
    Posture,
    Robot,
    Sidecar,
    SkipIncludes,
    Spacing,
    coefficient,
    load_rover,
    loaded,
    number,
    numbers,
)
from rover_pin.errors import InputError

if TYPE_CHECKING:
    import xarray as xr

    from rover_pin.analysis.traverse import LargestStep
    from rover_pin.rover import Rover
    from rover_pin.terrain import Terrain


def traverse(
    robot: Robot,
    sidecar: Sidecar = None,
    package: Packages = None,
    skip_missing_includes: SkipIncludes = False,
    path: Annotated[
        str | None, typer.Option(help="Waypoints in m, or a CSV file of them.", metavar="X1,Y1;X2,Y2")
    ] = None,
    terrain: Annotated[
        str | None,
        typer.Option(help="A height map's file, flat, slope:DEG, step:HEIGHT,X or rough:SEED,RMS,HURST."),
    ] = None,
    spacing: Spacing = None,
    interpolation: Interpolation = "smooth",
    height_scale: HeightScale = None,
    height_offset: HeightOffset = 0.0,
    step: Annotated[
        str | None,
        typer.Option(help="Between places; silent: a fifth of a wheel's radius.", metavar="M"),
    ] = None,
    crab: Annotated[str, typer.Option(help="Heading from the path's direction.", metavar="DEG")] = "0",
    reverse: Annotated[bool, typer.Option("--reverse", help="Drive backwards.")] = False,
    until_stop: Annotated[bool, typer.Option("--until-stop", help="End where it stops.")] = False,
    largest_step: Annotated[
        bool,
        typer.Option(
            "--largest-step", help="The largest step it climbs; step:HEIGHT,X is the highest tried."
        ),
    ] = False,
    measures: Annotated[
        str | None, typer.Option(help="Margins along the path, by commas; silent: tip.", metavar="NAMES")
    ] = None,
    friction: Friction = None,
    posture: Posture = None,
    joint: Joints = None,
    lock: Locks = None,
    param: Parameters = None,
    gravity: Gravity = "earth",
    payload: Payload = None,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Write the places, netCDF.", metavar="OUT.nc")
    ] = None,
    csv: Annotated[Path | None, typer.Option(help="Write a table, a place a row.", metavar="FILE")] = None,
    plot: Annotated[
        Path | None, typer.Option(help="Write a figure: .png, .svg or .pdf.", metavar="FILE")
    ] = None,
    html: Annotated[Path | None, typer.Option(help="Write a page that plays it.", metavar="FILE")] = None,
    json: Json = False,
) -> int:
    """Drive along a line, quasi-statically: loads, friction and torque asked for, margins, where it stops."""
    from rover_pin.analysis.words import gravity as parse_gravity
    from rover_pin.analysis.words import posture as parse_posture
    from rover_pin.cli.output import announce_compilation, check_outputs

    files = {"--out": out, "--csv": csv, "--plot": plot, "--html": html}
    check_outputs(*files.values())
    if plot is not None:
        from rover_pin.viz.traverse import plot_format

        plot_format(plot)
    _fits(largest_step, path, terrain, {**files, "--measures": measures or None})
    how: dict[str, Any] = {
        "step": None if step is None else number(step, "--step"),
        "crab": math.radians(number(crab, "--crab")),
        "reverse": reverse,
        "friction": coefficient(friction),
        "posture": None if posture is None else parse_posture(posture),
        "joints": numbers(joint, "--joint") or None,
        "locks": tuple(lock or ()),
        "gravity": parse_gravity(gravity),
    }
    ground = None
    if not largest_step:
        from rover_pin.terrain import Terrain

        ground = Terrain.parse(terrain or "flat", spacing, interpolation, height_scale, height_offset)
    rover = loaded(load_rover(robot, sidecar, package, skip_missing_includes, param), payload)
    announce_compilation()
    if ground is None:
        return _largest(rover, terrain, spacing, path, how, json)
    names = [name.strip() for name in ("tip" if measures is None else measures).split(",") if name.strip()]
    return _drive(
        rover, ground, path or "", {**how, "measures": names, "until_stop": until_stop}, files, json
    )


def _fits(largest: bool, path: str | None, terrain: str | None, others: dict[str, Path | str | None]) -> None:
    """Refuse options that do not go together."""
    if not largest:
        if path is None:
            raise InputError("is missing", element="--path", cure="write --path 0,0;2,0 or a CSV file's name")
        return
    for option, value in others.items():
        if value is not None:
            cure = "leave it out, or traverse the step of the height that comes out"
            raise InputError("does not go with --largest-step", element=option, value=str(value), cure=cure)
    if terrain is not None and not terrain.startswith("step:"):
        raise InputError(
            "is no step, so it has no largest height",
            element="--terrain",
            value=terrain,
            cure="write step:HEIGHT,X with the highest to try, or leave it out",
        )


def _drive(
    rover: Rover, ground: Terrain, path: str, how: dict[str, Any], files: dict[str, Path | None], json: bool
) -> int:
    from rover_pin.analysis import traverse as drive
    from rover_pin.cli.output import aside, print_json
    from rover_pin.cli.progress import progress_bar
    from rover_pin.cli.traverse_report import print_traverse, traverse_object

    with progress_bar("places") as progress:
        data = drive(rover, ground, path, progress=progress, **how)
    _save(data, rover, ground, files)
    if json:
        print_json(traverse_object(data))
    else:
        print_traverse(data)
    for file in files.values():
        if file is not None:
            aside(f"wrote {file}")
    return 0 if data.attrs["passed"] else 1


def _save(data: xr.Dataset, rover: Rover, ground: Terrain, files: dict[str, Path | None]) -> None:
    from rover_pin import viz
    from rover_pin.analysis.traverse.files import write_csv, write_netcdf

    if (file := files["--out"]) is not None:
        write_netcdf(data, file)
    if (file := files["--csv"]) is not None:
        write_csv(data, file)
    if (file := files["--plot"]) is not None:
        viz.save_traverse_plot(data, file)
    if (file := files["--html"]) is not None:
        viz.save_traverse_html(data, rover, ground, file)


def _largest(
    rover: Rover,
    terrain: str | None,
    spacing: float | None,
    path: str | None,
    how: dict[str, Any],
    json: bool,
) -> int:
    from rover_pin.analysis import largest_step
    from rover_pin.cli.output import print_json
    from rover_pin.cli.progress import progress_bar
    from rover_pin.cli.traverse_report import largest_object, print_largest
    from rover_pin.terrain.words import split_word

    told = None if terrain is None else split_word(terrain)
    height, edge = (None, 0.0) if told is None else told[1]
    for element, value in (("--terrain, HEIGHT", height), ("--spacing", spacing)):
        if value is not None and not 0.0 < value < math.inf:
            raise InputError("must be a finite number above 0", element=element, value=value, cure="give m")
    if not math.isfinite(edge):
        raise InputError("is not a finite number", element="--terrain, X", value=edge, cure="give m")
    more: dict[str, Any] = {} if spacing is None else {"riser": spacing}
    with progress_bar("heights") as progress:
        found: LargestStep = largest_step(
            rover, height, edge=edge, path=path, progress=progress, **more, **how
        )
    if json:
        print_json(largest_object(rover, found))
    else:
        print_largest(rover, found)
    return 0 if found.climbed > 0 else 1
