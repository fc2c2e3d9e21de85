"""The sidecar, `rover.yaml`: everything about a rover that its URDF cannot say."""

from __future__ import annotations

import functools
import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path as File
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Discriminator, Field, FiniteFloat, Tag

from rover_pin.description.formulas import Formula, Path, fill_in, formula_of, formulas_in
from rover_pin.description.gepetto import KEYS, is_gepetto, translated
from rover_pin.description.others import NAMED, Kind, Other, found_by, read_other, with_others
from rover_pin.description.packages import Packages
from rover_pin.description.parameters import ParameterSpec
from rover_pin.description.reading import check_schema, dotted, parse_yaml, place, read_text, validated
from rover_pin.description.retype import Retype
from rover_pin.description.specs import (
    BellySpec,
    Direction,
    FootSpec,
    FreeSpec,
    InertialSpec,
    WheelSpec,
)
from rover_pin.description.srdf import Srdf, read_srdf
from rover_pin.description.tree import HUGE
from rover_pin.errors import SidecarError
from rover_pin.mechanism import CouplingSpec, FrameSpringSpec, JointSpringSpec, LoopSpec, TrackSpec

SCHEMA: Literal[1] = 1


def _spring_kind(value: Any) -> str:
    frames = "frames" in value if isinstance(value, dict) else hasattr(value, "frames")
    return "<frames>" if frames else "<joint>"


SpringEntry = Annotated[
    Annotated[JointSpringSpec, Tag("<joint>")] | Annotated[FrameSpringSpec, Tag("<frames>")],
    Discriminator(_spring_kind),
]


class Sidecar(BaseModel):
    """All keys of the file; each may be silent but `schema`."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    version: Literal[1] = Field(default=SCHEMA, alias="schema")
    up: Direction = (0.0, 0.0, 1.0)
    loops: tuple[LoopSpec, ...] = ()
    couplings: tuple[CouplingSpec, ...] = ()
    springs: tuple[SpringEntry, ...] = ()
    locks: tuple[str, ...] = ()
    free: dict[str, FreeSpec] = {}
    actuated: tuple[str, ...] | None = None
    passive: tuple[str, ...] | None = None
    wheels: tuple[WheelSpec, ...] = ()
    contacts: tuple[FootSpec, ...] = ()
    belly: tuple[BellySpec, ...] = ()
    inertials: dict[str, InertialSpec] = {}
    postures: dict[str, dict[str, FiniteFloat]] = {}
    parameters: dict[str, ParameterSpec] = {}
    tracks: tuple[TrackSpec, ...] = ()
    retype: dict[str, Retype] = {}
    srdf: str | None = None
    robot_yaml: str | None = None
    embedded: dict[Kind, Other] = {}

    @property
    def states(self) -> Srdf:
        """What the SRDF says that it names."""
        other = self.embedded.get("srdf")
        return Srdf({}, (), ()) if other is None else read_srdf(other.text, other.file)


def read_sidecar(text: str, file: object, values: Mapping[str, float] | None = None) -> Sidecar:
    """A sidecar from its text; the `robot.yaml` of example-parallel-robots is read too.

    Args:
        text: YAML.
        file: named in errors.
        values: of the parameters that formulas are made of; their defaults where silent.

    Raises:
        SidecarError: not YAML, another schema, an unknown or missing key, a value of the wrong kind, a name
            given twice, a formula that is none; with the file, the line, the key's path and the cure.
    """
    return _read(text, file, None if values is None else tuple(sorted(values.items())))


@functools.lru_cache(maxsize=64)
def _read(text: str, file: object, values: tuple[tuple[str, float], ...] | None) -> Sidecar:
    data, node = parse_yaml(text, file)
    data = _with_gepetto(data, file)
    check_schema(data, SCHEMA, file)
    present = _with_embedded({key: value for key, value in data.items() if value is not None})
    if any(formulas_in(present)):
        declared = validated(_Declared, {"parameters": present.get("parameters", {})}, node, file).parameters
        defaults = {name: float(spec.default) for name, spec in declared.items()}
        known = {**defaults, **dict(values or ())}
        fill_in(present, known, lambda path: (place(file, node, path), dotted(path)))
    for path in _huge(present):
        raise SidecarError(
            "too large to be meant",
            file=place(file, node, path),
            element=dotted(path),
            cure="give m, kg, N, N/m or rad; leave a limit out where there is none",
        )
    sidecar = validated(Sidecar, present, node, file)
    for key in ("loops", "couplings", "springs", "tracks"):
        _once([spec.name for spec in getattr(sidecar, key)], key, file)
    return sidecar


def _with_gepetto(data: dict[str, Any], file: object) -> dict[str, Any]:
    """Gepetto's keys in our words; where they stand alone, the schema is ours."""
    if not is_gepetto(data):
        return data
    if "schema" not in data:
        others = [key for key in data if key not in KEYS]
        if others:
            raise SidecarError(
                f"unknown key beside {', '.join(KEYS)}",
                file=file,
                element=others[0],
                cure=f"add `schema: {SCHEMA}` to use the keys of a rover.yaml with them",
            )
        data = {"schema": SCHEMA, **data}
    return translated(data, file)


def _with_embedded(data: dict[str, Any]) -> dict[str, Any]:
    """What the named files say, below what the sidecar says itself."""
    others = data.get("embedded", {})
    if "robot_yaml" in others:
        text, other = others["robot_yaml"]["text"], others["robot_yaml"]["file"]
        theirs = _with_gepetto(parse_yaml(text, other)[0], other)
        data["loops"] = [*data.get("loops", ()), *theirs.get("loops", ())]
        data["retype"] = {**theirs.get("retype", {}), **data.get("retype", {})}
        if "actuated" in theirs and "passive" not in data:
            data.setdefault("actuated", theirs["actuated"])
    if "mjcf" in others:
        theirs = parse_yaml(others["mjcf"]["text"], others["mjcf"]["file"])[0]
        for key in ("loops", "couplings", "springs"):
            data[key] = [*data.get(key, ()), *theirs.get(key, ())]
    if "srdf" in others:
        found = read_srdf(others["srdf"]["text"], others["srdf"]["file"])
        data["postures"] = {**found.postures, **data.get("postures", {})}
    return data


_WIDE = frozenset({"limits", "bounds", "length_max", "embedded"})  # a large number there is no limit


def _huge(data: Any, path: Path = ()) -> Iterator[Path]:
    """Where numbers stand that no robot has; solvers would choke on them."""
    if isinstance(data, (dict, list)):
        for key, value in data.items() if isinstance(data, dict) else enumerate(data):
            if key not in _WIDE:
                yield from _huge(value, (*path, key))
        return
    try:
        if HUGE < abs(float(data)) < math.inf and not isinstance(data, bool):
            yield path
    except (TypeError, ValueError):
        return  # no number
    except OverflowError:
        yield path


class _Declared(BaseModel):
    parameters: dict[str, ParameterSpec] = {}


@functools.lru_cache(maxsize=64)
def formulas_of(text: str, file: object) -> Mapping[Path, Formula]:
    """The formulas of a sidecar that `read_sidecar` has read, by where they stand in it."""
    data, _ = parse_yaml(text, file)
    return {path: formula_of(formula) for path, formula in formulas_in(data)}


def load_sidecar(
    path: File | None, packages: Packages, extra: Mapping[Kind, Other] | None = None
) -> tuple[Sidecar, str | None]:
    """A sidecar from its file, and the text; an SRDF alone is one that names it.

    Args:
        path: the file, or None where there is none.
        packages: where `package://` looks.
        extra: what else is said beside the URDF.

    Raises:
        SidecarError: as `read_sidecar`, or a file cannot be read.
        DescriptionError: an SRDF that cannot be used.
    """
    others: dict[Kind, Other] = dict(extra or {})
    if path is None and not others:
        return Sidecar(), None
    text = f"schema: {SCHEMA}"
    if path is not None and path.suffix == ".srdf":
        others["srdf"] = read_other(path)
    elif path is not None:
        text = read_text(path, "give the path of a rover.yaml")
        sidecar = read_sidecar(text, path)
        named = {kind: getattr(sidecar, kind) for kind in NAMED}
        others |= {kind: found_by(name, kind, path, packages) for kind, name in named.items() if name}
        if not others:
            return sidecar, text
        if "schema" not in parse_yaml(text, path)[0]:
            text = f"{text.rstrip()}\nschema: {SCHEMA}"
    text = with_others(text, others)
    return read_sidecar(text, path or next(iter(others.values())).file), text


def _once(names: Sequence[str], key: str, file: object) -> None:
    seen: set[str] = set()
    for i, name in enumerate(names):
        if name in seen:
            raise SidecarError(
                "the name stands twice",
                file=file,
                element=f"{key}[{i}]",
                value=name,
                cure="rename one of them",
            )
        seen.add(name)
