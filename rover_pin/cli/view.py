"""`rover-pin view`: a robot, or a case of a study, in the browser of this machine."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rover_pin.cli.options import (
    OwnGravity,
    Packages,
    Parameters,
    Payload,
    Sidecar,
    SkipIncludes,
    load_rover,
    loaded,
)
from rover_pin.errors import InputError

if TYPE_CHECKING:
    from rover_pin.statics.stance import Stance


def view(
    what: Annotated[str, typer.Argument(help="A robot, or a study's result.", metavar="ROBOT|OUT.nc")],
    case: Annotated[int | None, typer.Option(help="Of the result; silent: the worst.", metavar="N")] = None,
    sidecar: Sidecar = None,
    package: Packages = None,
    skip_missing_includes: SkipIncludes = False,
    param: Parameters = None,
    gravity: OwnGravity = None,
    payload: Payload = None,
    browser: Annotated[bool, typer.Option(help="Open the browser.")] = True,
) -> None:
    """Show a robot on flat ground, or a study's case, until Ctrl-C; only this machine can look."""
    from rover_pin import viz
    from rover_pin.cli.output import line

    if what.endswith(".nc"):
        for option, given in (("--gravity", gravity), ("--payload", payload)):
            if given:
                cure = "run the study with it: rover-pin study"
                raise InputError("a result has its own", element=option, value=what, cure=cure)
        stance = _case(Path(what), case)
    elif case is not None:
        raise InputError(
            "cases belong to a study's result", element="--case", value=case, cure="name an OUT.nc"
        )
    else:
        from rover_pin import Terrain, settle
        from rover_pin.analysis.words import gravity as parse_gravity

        pull = parse_gravity(gravity or "earth")
        rover = loaded(load_rover(what, sidecar, package, skip_missing_includes, param), payload)
        stance = settle(rover, Terrain.flat(), gravity=pull)
    served = viz.show(stance, open_browser=browser)
    line(f"{stance!r}\n{served.url} (Ctrl-C ends it)")
    try:
        served.wait()
    except KeyboardInterrupt:
        pass
    finally:
        served.close()


def _case(path: Path, case: int | None) -> Stance:
    """A case of a result, settled again; without a number the worst."""
    from rover_pin.analysis import Study
    from rover_pin.analysis.dataset import read
    from rover_pin.analysis.summary import measures, spread

    data = read(path)
    if case is None:
        names = measures(data)
        worst = spread(data, "tip" if "tip" in names else names[0], 1).worst if names else ()
        case = worst[0].case if worst else 0
    return Study.from_dataset(data).stance(case)
