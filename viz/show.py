"""A stance in the browser: a file of its own, or served on this machine."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from rover_pin.viz.facts import edge_label, facts, margins_of
from rover_pin.viz.page.html import page, write_whole
from rover_pin.viz.page.pack import Pack
from rover_pin.viz.record import recording
from rover_pin.viz.scene import draw

if TYPE_CHECKING:
    from rover_pin.stability.margin import Margin
    from rover_pin.statics.stance import Stance
    from rover_pin.viz.serve import Served


def stance_page(stance: Stance, margins: Mapping[str, Margin] | None = None) -> str:
    """The page of one stance as HTML text with no reference to anything outside.

    Args:
        stance: settled or not; one that is not is drawn where it was left, with the reason.
        margins: its measures; every measure is evaluated where none are given.
    """
    known = margins_of(stance) if margins is None else margins
    limiting = next(
        (m.limiting for name in ("polygon", "tip") if (m := known.get(name)) and m.limiting), None
    )
    visualizer, recorder = recording()
    region = next((known[name] for name in ("region", "feasible") if name in known), None)
    outline = getattr(region, "outline", ())
    drawn = draw(visualizer, stance, limiting=limiting, region=outline)
    about = {**facts(stance, known, drawn), "edge": edge_label(stance, limiting), "region": outline}
    pack = Pack({"stance": about}, {"commands": recorder.stream()})
    return page("stance", f"{stance.rover.name} on {stance.terrain.label}", pack)


def save_html(stance: Stance, path: str | Path, *, margins: Mapping[str, Margin] | None = None) -> Path:
    """Write the page of a stance: one offline file, whole or not at all.

    Raises:
        InputError: the file cannot be written.
    """
    return write_whole(path, stance_page(stance, margins).encode("utf-8"))


def show(stance: Stance, *, port: int = 0, open_browser: bool = True) -> Served:
    """Serve a stance's page on this machine only (127.0.0.1), and open the browser on it.

    Args:
        stance: what to show.
        port: of the server; 0 takes a free one.
        open_browser: whether to open the page.

    Returns:
        The running server: `url`, `replace(stance)` for another stance in open pages, `wait()`, `close()`.

    Raises:
        InputError: the port is taken.
    """
    from rover_pin.viz.serve import serve

    return serve(stance_page(stance), port=port, open_browser=open_browser)
