"""`rover-pin settle`: how a rover stands at a place."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

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
    place,
)

if TYPE_CHECKING:
    from rover_pin.statics.stance import Stance


def settle(
    robot: Robot,
    sidecar: Sidecar = None,
    package: Packages = None,
    skip_missing_includes: SkipIncludes = False,
    terrain: Annotated[
        str, typer.Option(help="A height map's file, flat, slope:DEG, step:HEIGHT,X or rough:SEED,RMS,HURST.")
    ] = "flat",
    spacing: Spacing = None,
    interpolation: Interpolation = "smooth",
    height_scale: HeightScale = None,
    height_offset: HeightOffset = 0.0,
    at: Annotated[str, typer.Option(help="Place and heading.", metavar="X,Y,YAW_DEG")] = "0,0,0",
    posture: Posture = None,
    joint: Joints = None,
    lock: Locks = None,
    param: Parameters = None,
    gravity: Gravity = "earth",
    payload: Payload = None,
    friction: Friction = None,
    resistance: Annotated[
        str, typer.Option(help="Motion resistance against the heading.", metavar="NEWTON")
    ] = "0",
    html: Annotated[Path | None, typer.Option(help="Write a page that shows it.", metavar="FILE")] = None,
    png: Annotated[
        Path | None, typer.Option(help="Write a picture (needs Chromium).", metavar="FILE")
    ] = None,
    json: Json = False,
) -> int:
    """How a rover stands, what each wheel carries, how close it is to tipping."""
    from rover_pin import settle as stand
    from rover_pin.analysis.words import gravity as parse_gravity
    from rover_pin.analysis.words import posture as parse_posture
    from rover_pin.cli.output import announce_compilation, aside, check_outputs, print_json
    from rover_pin.cli.stance_report import measured, print_stance, stance_object
    from rover_pin.terrain import Terrain

    check_outputs(html, png)
    if png is not None:
        from rover_pin.viz.browser import find_browser

        find_browser()
    x, y, yaw = place(at)
    mu = coefficient(friction)
    ground = Terrain.parse(terrain, spacing, interpolation, height_scale, height_offset)
    rover = loaded(load_rover(robot, sidecar, package, skip_missing_includes, param), payload)
    announce_compilation()
    stance = stand(
        rover,
        ground,
        x=x,
        y=y,
        yaw=yaw,
        posture=None if posture is None else parse_posture(posture),
        joints=numbers(joint, "--joint") or None,
        locks=tuple(lock or ()),
        gravity=parse_gravity(gravity),
        resistance=number(resistance, "--resistance"),
    )
    margins = measured(stance, mu)
    _save(stance, html, png)
    if json:
        print_json(stance_object(stance, margins))
    else:
        print_stance(stance, margins)
    for path in (html, png):
        if path is not None:
            aside(f"wrote {path}")
    return 0 if stance.settled else 1


def _save(stance: Stance, html: Path | None, png: Path | None) -> None:
    if html is None and png is None:
        return
    from rover_pin import viz

    if html is not None:
        viz.save_html(stance, html)
    if png is not None:
        viz.save_png(stance, png)
