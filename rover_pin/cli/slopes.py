"""`rover-pin slopes`: the slope at tip and at slip against heading."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rover_pin.cli.options import (
    Friction,
    Gravity,
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
    coefficient,
    load_rover,
    loaded,
    numbers,
)

if TYPE_CHECKING:
    import xarray as xr


def slopes(
    robot: Robot,
    sidecar: Sidecar = None,
    package: Packages = None,
    skip_missing_includes: SkipIncludes = False,
    headings: Annotated[int, typer.Option(help="How many, evenly over the circle.", metavar="N")] = 24,
    friction: Friction = None,
    posture: Posture = None,
    joint: Joints = None,
    lock: Locks = None,
    param: Parameters = None,
    gravity: Gravity = "earth",
    payload: Payload = None,
    html: Annotated[Path | None, typer.Option(help="Write a page that shows it.", metavar="FILE")] = None,
    png: Annotated[Path | None, typer.Option(help="Write the polar plot.", metavar="FILE")] = None,
    json: Json = False,
) -> int:
    """The slope at which a rover tips and at which it slips, in every heading."""
    from rover_pin.analysis import slopes as tilt
    from rover_pin.analysis.words import gravity as parse_gravity
    from rover_pin.analysis.words import posture as parse_posture
    from rover_pin.cli.output import announce_compilation, aside, check_outputs, print_json
    from rover_pin.cli.progress import progress_bar

    check_outputs(html, png)
    mu = coefficient(friction)
    rover = loaded(load_rover(robot, sidecar, package, skip_missing_includes, param), payload)
    announce_compilation()
    with progress_bar("headings") as progress:
        data = tilt(
            rover,
            headings,
            friction=mu,
            posture=None if posture is None else parse_posture(posture),
            joints=numbers(joint, "--joint") or None,
            locks=tuple(lock or ()),
            gravity=parse_gravity(gravity),
            progress=progress,
        )
    _save(data, html, png)
    if json:
        print_json(slopes_object(data))
    else:
        _print(data)
    for path in (html, png):
        if path is not None:
            aside(f"wrote {path}")
    return 0 if bool(data["tip_rad"].notnull().all()) else 1


def slopes_object(data: xr.Dataset) -> dict[str, Any]:
    """What `slopes --json` prints; angles in rad, null where there is none."""
    names = [str(name) for name in data.data_vars]
    each = [
        {
            "heading_rad": float(heading),
            **{name: _value(data[name].values[k]) for name in names},
        }
        for k, heading in enumerate(data["heading_rad"].values)
    ]
    return {
        **{name: data.attrs[name] for name in ("robot", "friction", "gravity", "payload", "posture")},
        "worst": _worst(each),
        "headings": each,
    }


def _value(told: Any) -> float | str | None:
    """A number, or a word where there is one."""
    return str(told) or None if isinstance(told, str) else float(told)


def _worst(each: list[dict[str, Any]]) -> dict[str, Any] | None:
    """The heading in which it stands to the least slope, the first of several alike to 1e-7 rad.

    None where it does not stand on level ground.
    """
    if any(math.isnan(one["stands_to_rad"]) for one in each):
        return None
    return min(each, key=lambda one: round(one["stands_to_rad"], 7))


def _save(data: xr.Dataset, html: Path | None, png: Path | None) -> None:
    if html is None and png is None:
        return
    from rover_pin import viz
    from rover_pin.analysis.store import atomically

    if html is not None:
        viz.save_slopes_html(data, html)
    if png is not None:
        figure = viz.plot_slopes(data)
        atomically(png, lambda file: figure.savefig(file, format="png"))


def _print(data: xr.Dataset) -> None:
    from rover_pin.cli.output import line, new_table, print_table
    from rover_pin.viz.slopes import HEAD, rows

    line(
        f"{data.attrs['robot']} on slopes, friction {data.attrs['friction']}, posture {data.attrs['posture']}"
    )
    table = new_table("", *HEAD)
    for row in rows(data):
        table.add_row(*row)
    print_table(table)
    worst = slopes_object(data)["worst"]
    if worst is not None:
        slope, heading = (math.degrees(worst[name]) for name in ("stands_to_rad", "heading_rad"))
        line(f"stands to {slope:.3f} deg in every heading; least at {heading:g} deg")
