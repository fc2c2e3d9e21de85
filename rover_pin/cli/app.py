"""The application: every command under its name."""

from __future__ import annotations

import typer

from rover_pin.cli.bench import bench
from rover_pin.cli.compare import compare
from rover_pin.cli.info import info
from rover_pin.cli.init import init
from rover_pin.cli.mobility import mobility
from rover_pin.cli.reproduce import reproduce
from rover_pin.cli.robots import robots
from rover_pin.cli.search import search
from rover_pin.cli.settle import settle
from rover_pin.cli.slopes import slopes
from rover_pin.cli.study import study
from rover_pin.cli.traverse import traverse
from rover_pin.cli.view import view

app = typer.Typer(
    name="rover-pin",
    help="How rovers with suspensions that URDF cannot say stand on terrain.",
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
for command in (
    robots,
    info,
    settle,
    study,
    compare,
    search,
    view,
    init,
    mobility,
    slopes,
    traverse,
    reproduce,
    bench,
):
    app.command()(command)
