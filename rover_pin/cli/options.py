"""Options that several commands share, and how their words are read."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rover_pin.errors import InputError

if TYPE_CHECKING:
    from rover_pin.analysis.study import Study
    from rover_pin.description.recipe import Payload as Load
    from rover_pin.rover import Rover

RESERVED = {"name_or_path", "sidecar", "packages", "skip_missing_includes"}
"""Keywords of `rover_pin.load` that are no parameters."""

Robot = Annotated[str, typer.Argument(help="Bundled name, or path of a URDF or xacro.", metavar="ROBOT")]
Sidecar = Annotated[
    Path | None, typer.Option(help="The rover.yaml beside the URDF.", metavar="FILE", show_default=False)
]
Packages = Annotated[
    list[str] | None, typer.Option("--package", help="Where a ROS package lies.", metavar="NAME=DIR")
]
SkipIncludes = Annotated[
    bool, typer.Option("--skip-missing-includes", help="Pass over xacro files not there.")
]
Parameters = Annotated[
    list[str] | None, typer.Option("--param", help="Value of a declared parameter.", metavar="NAME=VALUE")
]
HeightScale = Annotated[
    float | None, typer.Option(help="Metres a grey level of a PNG, or a unit of another map.", metavar="M")
]
HeightOffset = Annotated[float, typer.Option(help="Height where the map holds 0, m.", metavar="M")]
Spacing = Annotated[float | None, typer.Option(help="Of the map's nodes, m.", metavar="M")]
Interpolation = Annotated[str, typer.Option(help="Of the map: smooth or linear.")]
Posture = Annotated[str | None, typer.Option(help="Posture.", metavar="NAME|clearance=M")]
Joints = Annotated[
    list[str] | None, typer.Option("--joint", help="Hold a joint, rad or m.", metavar="NAME=VALUE")
]
Locks = Annotated[list[str] | None, typer.Option("--lock", help="Lock a passive joint.", metavar="NAME")]
Friction = Annotated[str | None, typer.Option(help="Friction under every wheel.", metavar="MU")]
Gravity = Annotated[str, typer.Option(help="m/s2, or earth, moon, mars, ...", metavar="G")]
OwnGravity = Annotated[
    str | None,
    typer.Option("--gravity", help="m/s2, or earth, moon, mars, ...; silent: as the file says.", metavar="G"),
]
Payload = Annotated[
    list[str] | None,
    typer.Option("--payload", help="Mass on the base, or at a link's origin.", metavar="KG[@X,Y,Z|@FRAME]"),
]
Json = Annotated[bool, typer.Option("--json", help="One JSON object instead of a table.")]


def pairs(words: Sequence[str] | None, option: str) -> dict[str, str]:
    """`NAME=VALUE` words as a mapping.

    Raises:
        InputError: no `=`, an empty side, or a name twice.
    """
    found: dict[str, str] = {}
    for word in words or ():
        name, sign, value = word.partition("=")
        if not (name and sign and value):
            raise InputError(
                "is not NAME=VALUE", element=option, value=word, cure=f"write {option} name=value"
            )
        if name in found:
            raise InputError("is given twice", element=f"{option} {name}", cure="keep one")
        found[name] = value
    return found


def number(word: str, element: str) -> float:
    """A finite number.

    Raises:
        InputError: it is none.
    """
    try:
        value = float(word)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError("is not a finite number", element=element, value=word)
    return value


def numbers(words: Sequence[str] | None, option: str) -> dict[str, float]:
    """`NAME=NUMBER` words as a mapping."""
    return {name: number(word, f"{option} {name}") for name, word in pairs(words, option).items()}


def place(word: str) -> tuple[float, float, float]:
    """`X,Y,YAW_DEG` as m, m, rad; the heading may be left out.

    Raises:
        InputError: not two or three numbers.
    """
    parts = word.split(",")
    if len(parts) not in (2, 3):
        raise InputError("is not X,Y,YAW_DEG", element="--at", value=word, cure="write --at 1.5,-2,30")
    x, y, yaw = (number(part, "--at") for part in [*parts, "0"][:3])
    return x, y, math.radians(yaw)


def payload(word: str) -> Load:
    """`KG` at the origin of the base, `KG@X,Y,Z` at a place of the base, `KG@FRAME` at a link or joint.

    Raises:
        InputError: not of that form, or no positive mass.
    """
    mass, sign, place = word.partition("@")
    kg = number(mass, "--payload")
    if kg <= 0:
        raise InputError("mass must be more than zero", element="--payload", value=word)
    parts = place.split(",")
    if sign and (not place.strip() or len(parts) not in (1, 3) or (len(parts) == 1 and _numeric(place))):
        cure = "write --payload 5@0,0,0.3, or 5@ and a link's name"
        raise InputError("is not KG@X,Y,Z or KG@FRAME", element="--payload", value=word, cure=cure)
    if not sign:
        return kg, (0.0, 0.0, 0.0)
    if len(parts) == 1:
        return kg, place
    x, y, z = (number(part, "--payload") for part in parts)
    return kg, (x, y, z)


def _numeric(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def payloads(words: Sequence[str] | None) -> list[Load]:
    """What `--payload` words say, in order."""
    return [payload(word) for word in words or ()]


def load_rover(
    robot: str,
    sidecar: Path | None,
    packages: Sequence[str] | None,
    skip_missing_includes: bool,
    parameters: Sequence[str] | None,
) -> Rover:
    """The rover that the shared options describe.

    Raises:
        InputError: an option or a file that cannot be used.
    """
    from rover_pin import load

    values = numbers(parameters, "--param")
    for name in RESERVED & set(values):
        raise InputError(
            "no parameter can have that name", element=f"--param {name}", cure="see rover-pin info"
        )
    return load(
        robot,
        sidecar=sidecar,
        packages=dict(pairs(packages, "--package")) or None,
        skip_missing_includes=skip_missing_includes,
        **values,
    )


def loaded(rover: Rover, words: Sequence[str] | None) -> Rover:
    """The rover with the payloads that `--payload` words say.

    Raises:
        InputError: a word that is no payload.
    """
    loads = payloads(words)
    return rover.with_payload(loads) if loads else rover


def altered(study: Study, gravity: str | None, payload: Sequence[str] | None) -> Study:
    """The study under the gravity and with the further payload that options say.

    Raises:
        InputError: a word that is neither.
    """
    from rover_pin.analysis.words import gravity as parse_gravity

    pull = {} if gravity is None else {"gravity": parse_gravity(gravity)}
    loads = payloads(payload)
    return study.altered(payload=loads, **pull) if pull or loads else study


def coefficient(word: str | None) -> float | None:
    """What `--friction` says, or None.

    Raises:
        InputError: no number above 0.
    """
    if word is None:
        return None
    value = number(word, "--friction")
    if value <= 0:
        raise InputError("must be more than zero", element="--friction", value=word)
    return value
