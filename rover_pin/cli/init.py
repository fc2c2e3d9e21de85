"""`rover-pin init`: a commented sidecar to start from."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rover_pin.cli.options import Json, Packages, SkipIncludes, pairs
from rover_pin.errors import InputError


def init(
    urdf: Annotated[str, typer.Argument(help="Path of a URDF or xacro.", metavar="URDF")],
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", "-o", help="Silent: rover.yaml beside the URDF.", metavar="FILE", show_default=False
        ),
    ] = None,
    package: Packages = None,
    skip_missing_includes: SkipIncludes = False,
    json: Json = False,
) -> None:
    """Write a commented sidecar: wheels, passive joints, couplings and loops that the URDF suggests."""
    from rover_pin.cli.output import aside, check_outputs, line, print_json
    from rover_pin.description.catalogue import SIDECAR, locate
    from rover_pin.description.starter import start
    from rover_pin.loader import load_bare

    bundled, path = locate(urdf)
    if bundled is not None:
        raise InputError("has its sidecar already", value=bundled, cure="give the path of a URDF or xacro")
    target = path.parent / SIDECAR if out is None else out
    if target.exists() or target.is_symlink():
        raise InputError("is there already", file=target, cure="move it away, or name another file: -o FILE")
    check_outputs(target)
    rover = load_bare(path, dict(pairs(package, "--package")), skip_missing_includes)
    found = start(rover, target.parent)
    with target.open("x", encoding="utf-8") as file:
        file.write(found.text)
    if json:
        rows = [{"key": g.key, "line": g.line, "reason": g.reason} for g in found.guesses]
        print_json({"file": target, "guesses": rows, "words": found.words})
    else:
        for guess in found.guesses:
            line(f"{guess.key}: {guess.line}  ({guess.reason})")
        for words in found.words:
            line(f"note: {words}")
    aside(f"wrote {target}; every guess is commented out")
