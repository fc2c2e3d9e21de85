"""`rover-pin reproduce`: a paper's figures beside ours."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rover_pin.cli.options import Json

if TYPE_CHECKING:
    from rover_pin.analysis.papers import Paper, Results


def reproduce(
    paper: Annotated[
        str | None, typer.Argument(help="Key of the paper; none lists them.", metavar="[PAPER]")
    ] = None,
    html: Annotated[
        Path | None, typer.Option(help="Write a page with the table and the figures.", metavar="FILE")
    ] = None,
    png: Annotated[
        Path | None, typer.Option(help="Write each figure as a picture there.", metavar="DIR")
    ] = None,
    motion: Annotated[
        Path | None, typer.Option(help="Write a page that plays the paper's motions.", metavar="FILE")
    ] = None,
    json: Json = False,
) -> int:
    """A paper's figures beside ours, and which are not reproduced and why."""
    from rover_pin.analysis.papers import paper as find
    from rover_pin.cli.output import announce_compilation, aside, check_outputs, print_json
    from rover_pin.cli.reproduce_report import print_papers, print_results
    from rover_pin.errors import InputError

    if paper is None:
        if html or png or motion:
            raise InputError(
                "a page or pictures of which paper", cure="rover-pin reproduce PAPER --html FILE"
            )
        print_papers(as_json=json)
        return 0
    found = find(paper)
    check_outputs(html)
    check_outputs(motion)
    if png is not None and png.exists() and not png.is_dir():
        raise InputError("is not a folder", file=png, cure="name a folder for the pictures")
    announce_compilation(batch=True)
    results = found.results()
    if motion is not None and not results.runs:
        raise InputError("has no motions", element=found.key, cure="leave --motion out")
    written = _save(found, results, html, png) if html or png else []
    if motion is not None:
        from rover_pin.viz import save_motion_html

        written.append(save_motion_html(results.runs, motion, title=found.title))
    if json:
        print_json([finding.as_row() for finding in results.findings])
    else:
        print_results(found, results)
    for path in written:
        aside(f"wrote {path}")
    return 0


def _save(found: Paper, results: Results, html: Path | None, png: Path | None) -> list[Path]:
    from rover_pin.viz.papers import save_paper_page, save_paper_pictures

    written = []
    if html is not None:
        written.append(save_paper_page(found, results, html))
    if png is not None:
        written += save_paper_pictures(results, png)
    return written
