"""`rover-pin view`: a robot, a study's page or one case of it, in the browser of this machine."""

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
    from rover_pin.viz.serve import Served


def view(
    what: Annotated[str, typer.Argument(help="A robot, or a study's result.", metavar="ROBOT|OUT.nc")],
    case: Annotated[int | None, typer.Option(help="Of the result; silent: the worst.", metavar="N")] = None,
    stance: Annotated[bool, typer.Option("--stance", help="This case alone, not the study's page.")] = False,
    sidecar: Sidecar = None,
    package: Packages = None,
    skip_missing_includes: SkipIncludes = False,
    param: Parameters = None,
    gravity: OwnGravity = None,
    payload: Payload = None,
    browser: Annotated[bool, typer.Option(help="Open the browser.")] = True,
) -> None:
    """Show a robot on flat ground, or a study's page, until Ctrl-C; only this machine can look."""
    from rover_pin import viz
    from rover_pin.cli.output import line

    if what.endswith(".nc"):
        for option, given in (("--gravity", gravity), ("--payload", payload)):
            if given:
                cure = "run the study with it: rover-pin study"
                raise InputError("a result has its own", element=option, value=what, cure=cure)
        alone = _case(Path(what), case) if stance else None
    elif case is not None or stance:
        element, value = ("--case", case) if case is not None else ("--stance", what)
        cure = "name an OUT.nc"
        raise InputError("cases belong to a study's result", element=element, value=value, cure=cure)
    else:
        from rover_pin import Terrain, settle
        from rover_pin.analysis.words import gravity as parse_gravity

        pull = parse_gravity(gravity or "earth")
        rover = loaded(load_rover(what, sidecar, package, skip_missing_includes, param), payload)
        alone = settle(rover, Terrain.flat(), gravity=pull)
    if alone is None:
        title, served = _page(Path(what), case, browser)
    else:
        title, served = repr(alone), viz.show(alone, open_browser=browser)
    line(f"{title}\n{served.url} (Ctrl-C ends it)")
    try:
        served.wait()
    except KeyboardInterrupt:
        pass
    finally:
        served.close()


def _page(path: Path, case: int | None, browser: bool) -> tuple[str, Served]:
    """A result's page, served; at a case where one is named."""
    from rover_pin import viz
    from rover_pin.analysis.dataset import read

    data = read(path)
    text = viz.result_page(data, cases=() if case is None else (case,))
    where = "" if case is None else f"case={case}"
    title = f"{data.attrs['title']}: {data.sizes['case']} cases"
    return title, viz.serve(text, fragment=where, open_browser=browser)


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
