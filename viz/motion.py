"""Motions in the browser: one offline file for one run or several, and pictures of moments."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.errors import InputError
from rover_pin.simulation.check import checked_run
from rover_pin.simulation.run import Run
from rover_pin.viz.browser import find_browser, picture
from rover_pin.viz.page.html import page, write_whole
from rover_pin.viz.page.motion import motion_pack

if TYPE_CHECKING:
    from typing import TypeAlias

Runs: TypeAlias = "Run | Sequence[Run] | Mapping[str, Run]"

MOMENTS = 6
"""Of a film strip for which none are named."""

MOST_MOMENTS = 24


def motion_page(runs: Runs, title: str | None = None) -> str:
    """The page of one or several motions as HTML text with no reference to anything outside.

    The picture has at most some 2000 samples of each run, and goes straight between them; the plots keep the
    extremes of what is left out. The page says so.

    Args:
        runs: a run, several, or several by the name under which they are chosen.
        title: of the page; the rover's name where None.

    Raises:
        InputError: no run, or one whose parts do not fit (see `checked_run`).
    """
    named = _named(runs)
    heading = next(iter(named.values())).rover.name if title is None else title
    return page("motion", heading, motion_pack(named, heading))


def save_motion_html(runs: Runs, path: str | Path, *, title: str | None = None) -> Path:
    """Write the page of one or several motions: one offline file, whole or not at all.

    Raises:
        InputError: as `motion_page`, or the file cannot be written.
    """
    return write_whole(path, motion_page(runs, title).encode("utf-8"))


def save_motion_png(
    run: Run,
    path: str | Path,
    *,
    at: float | Sequence[float] | None = None,
    view: str = "Iso",
    width: int = 1600,
    height: int = 900,
) -> Path:
    """Write a picture of a motion, whole or not at all.

    Args:
        run: the motion.
        path: of the PNG.
        at: s; one time gives the page at it, several a film strip of them, None a strip of six from the first
            to the last.
        view: `Iso`, `Side`, `Front` or `Top`.
        width: px.
        height: px.

    Raises:
        BrowserError: no Chromium or Chrome is installed, or it made no picture.
        InputError: as `motion_page`; a time outside the run, too many of them, an unknown view; the file
            cannot be written.
    """
    views = ("Iso", "Side", "Front", "Top")
    if view not in views:
        raise InputError("no such view", element="view", value=view, cure=f"use one of {', '.join(views)}")
    checked_run(run)
    first, last = float(run.time[0]), float(run.time[-1])
    even = np.linspace(first, last, MOMENTS if last > first else 1)
    times = _times(even if at is None else at, first, last)
    find_browser()  # before the work of drawing
    word = "film" if at is None or isinstance(at, (Sequence, np.ndarray)) else "t"
    fragment = f"{word}={','.join(f'{time - first:.6g}' for time in times)}&view={view}"
    return write_whole(path, picture(motion_page(run), width=width, height=height, fragment=fragment))


def _times(wanted: object, first: float, last: float) -> list[float]:
    try:
        times = [float(time) for time in np.asarray(wanted, dtype=np.float64).ravel()]
    except (TypeError, ValueError) as error:
        raise InputError("is no time", element="at", value=str(wanted), cure="give seconds") from error
    if not 1 <= len(times) <= MOST_MOMENTS:
        raise InputError(
            "as many moments as a strip has no room for",
            element="at",
            value=len(times),
            cure=f"name between 1 and {MOST_MOMENTS}",
        )
    slack = 1e-9 * max(abs(first), abs(last), 1.0)
    for time in times:
        if not first - slack <= time <= last + slack:
            raise InputError(
                "is outside the run", element="at", value=time, cure=f"between {first:g} and {last:g} s"
            )
    return times


def _named(runs: Runs) -> Mapping[str, Run]:
    """Runs by name, every one checked."""
    if isinstance(runs, Run):
        named: dict[str, Run] = {"run": runs}
    elif isinstance(runs, Mapping):
        named = {str(name): run for name, run in runs.items()}
    else:
        named = {f"run {k}": run for k, run in enumerate(runs, 1)}
    if not named:
        raise InputError("there is none to show", element="runs", cure="give a Run, or several")
    for name, run in named.items():
        if not isinstance(run, Run):
            raise InputError(
                "is no run", element=name, value=type(run).__name__, cure="give what a simulation returned"
            )
        try:
            checked_run(run)
        except InputError as error:
            if len(named) == 1:
                raise
            element = f"{name}: {error.element}"
            raise InputError(error.what, element=element, value=error.value, cure=error.cure) from error
    return named
