"""The sidecar, `rover.yaml`: everything about a rover that its URDF cannot say."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from pathlib import Path as File
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Discriminator, Field, FiniteFloat, Tag

from rover_pin.description.formulas import Formula, Path, fill_in, formula_of, formulas_in
from rover_pin.description.parameters import ParameterSpec
from rover_pin.description.reading import check_schema, dotted, parse_yaml, place, read_text, validated
from rover_pin.description.specs import (
    BellySpec,
    Direction,
    FootSpec,
    FreeSpec,
    InertialSpec,
    WheelSpec,
)
from rover_pin.errors import SidecarError
from rover_pin.mechanism import CouplingSpec, FrameSpringSpec, JointSpringSpec, LoopSpec, TrackSpec

SCHEMA: Literal[1] = 1
_GEPETTO = ("closed_loop", "type", "name_mot")


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
    if any(key in data for key in _GEPETTO) and "schema" not in data:
        data = _from_gepetto(data, file)
    check_schema(data, SCHEMA, file)
    present = {key: value for key, value in data.items() if value is not None}
    if any(formulas_in(present)):
        declared = validated(_Declared, {"parameters": present.get("parameters", {})}, node, file).parameters
        defaults = {name: float(spec.default) for name, spec in declared.items()}
        known = {**defaults, **dict(values or ())}
        fill_in(present, known, lambda path: (place(file, node, path), dotted(path)))
    sidecar = validated(Sidecar, present, node, file)
    for key in ("loops", "couplings", "springs", "tracks"):
        _once([spec.name for spec in getattr(sidecar, key)], key, file)
    return sidecar


class _Declared(BaseModel):
    parameters: dict[str, ParameterSpec] = {}


@functools.lru_cache(maxsize=64)
def formulas_of(text: str, file: object) -> Mapping[Path, Formula]:
    """The formulas of a sidecar that `read_sidecar` has read, by where they stand in it."""
    data, _ = parse_yaml(text, file)
    return {path: formula_of(formula) for path, formula in formulas_in(data)}


def load_sidecar(path: File) -> tuple[Sidecar, str]:
    """A sidecar from its file, and the text.

    Raises:
        SidecarError: as `read_sidecar`, or the file cannot be read.
    """
    text = read_text(path, "give the path of a rover.yaml")
    return read_sidecar(text, path), text


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


def _from_gepetto(data: dict[str, Any], file: object) -> dict[str, Any]:
    """`closed_loop: [[a, b]]` with `type: [6d | 3d]`: welds and balls; `name_mot`: the driven joints."""
    others = [key for key in data if key not in _GEPETTO]
    if others:
        raise SidecarError(
            "unknown key beside closed_loop, type and name_mot",
            file=file,
            element=others[0],
            cure=f"use the keys of schema {SCHEMA} throughout",
        )
    pairs = data.get("closed_loop") or []
    types = data.get("type") or ["6d"] * len(pairs)
    kinds = {"6d": "weld", "3d": "ball"}
    if len(types) != len(pairs) or any(str(t).lower() not in kinds for t in types):
        raise SidecarError(
            "needs one of 6d, 3d for each closed loop",
            file=file,
            element="type",
            value=str(types),
            cure="mend it",
        )
    loops = [
        {"name": f"loop_{i + 1}", "frames": pair, "type": kinds[str(kind).lower()]}
        for i, (pair, kind) in enumerate(zip(pairs, types, strict=True))
    ]
    return {"schema": SCHEMA, "loops": loops, "actuated": data.get("name_mot")}
