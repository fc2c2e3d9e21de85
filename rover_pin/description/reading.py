"""YAML into pydantic models, with errors that name the file, the line, the key's path and the cure."""

from __future__ import annotations

import types
import typing
from collections.abc import Sequence
from pathlib import Path as File
from typing import Any, TypeVar

import yaml
from pydantic import BaseModel, ValidationError

from rover_pin.description.yaml_nodes import RefusedError, read_yaml
from rover_pin.errors import SidecarError, nearest

M = TypeVar("M", bound=BaseModel)
Path = tuple[str | int, ...]


def parse_yaml(text: str, file: object) -> tuple[dict[str, Any], yaml.Node]:
    """The mapping a YAML text holds, and its node tree for line numbers. Read safely: no tags run code.

    Raises:
        SidecarError: not YAML, a key stated twice, or not a mapping.
    """
    try:
        data, node = read_yaml(text)
    except RefusedError as problem:
        where = file if problem.line is None else f"{file}:{problem.line}"
        lines = text.splitlines()
        bare = problem.line is not None and problem.line <= len(lines) and "${" in lines[problem.line - 1]
        formula = bare and problem.what.startswith("not YAML")
        raise SidecarError(
            problem.what,
            file=where,
            element=dotted(problem.path) or None,
            cure='write formulas in quotes: "${...}"' if formula else problem.cure,
        ) from problem
    if not isinstance(node, yaml.MappingNode) or not isinstance(data, dict):
        raise SidecarError("not a mapping of keys to values", file=file, cure="start with `schema: 1`")
    for key in data:
        if not isinstance(key, str):
            raise SidecarError(
                "a key that is no word",
                file=place(file, node, (str(key),)),
                element=str(key),
                cure="put it in quotes",
            )
    return data, node


def read_text(path: File, cure: str) -> str:
    """What a file says.

    Raises:
        SidecarError: there is none, or it cannot be read.
    """
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        what = "no such file" if isinstance(error, FileNotFoundError) else f"cannot be read: {error}"
        raise SidecarError(what, file=path, cure=cure) from error


def check_schema(data: dict[str, Any], schema: int, file: object) -> None:
    """Refuse a mapping that states no `schema`, or another one.

    Raises:
        SidecarError: with the cure.
    """
    if "schema" not in data:
        raise SidecarError("missing", file=file, element="schema", cure=f"start with `schema: {schema}`")
    if data["schema"] != schema or isinstance(data["schema"], bool):
        raise SidecarError(
            "another schema",
            file=file,
            element="schema",
            value=data["schema"],
            cure=f"this version reads schema {schema}",
        )


def validated(
    model: type[M],
    data: dict[str, Any],
    node: yaml.Node | None,
    file: object,
) -> M:
    """`data` as `model`; the first complaint as one of our errors.

    Raises:
        SidecarError: an unknown key (with the nearest known one), a missing key, or an unfit value.
    """
    try:
        return model.model_validate(data)
    except ValidationError as problem:
        first = _worst(problem)
        path = _in_data(first["loc"], data, missing=first["type"] == "missing")
        raise SidecarError(
            _what(first),
            file=place(file, node, path),
            element=dotted(path),
            value=_shown(first),
            cure=_cure(first, model, path, data),
        ) from problem


def _worst(problem: ValidationError) -> Any:
    """An unknown key before all else: what is missing is often there under a misspelt name."""
    errors = problem.errors(include_url=False)
    return next((e for e in errors if e["type"] == "extra_forbidden"), errors[0])


_PLAIN = {
    "missing": ("missing", "state it"),
    "tuple_type": ("not a list", "write [a, b, ...]"),
    "too_long": ("too many entries", "at most {max_length}"),
    "dict_type": ("not a mapping", "write {{key: value, ...}}"),
    "model_type": ("not a mapping", "write {{key: value, ...}}"),
    "string_type": ("not a name", "give a name"),
    "float_type": ("not a number", "give a number"),
    "float_parsing": ("not a number", "give a number"),
    "bool_type": ("neither true nor false", "give true or false"),
    "bool_parsing": ("neither true nor false", "give true or false"),
    "finite_number": ("not a finite number", "give a finite number"),
    "greater_than": ("not above {gt:g}", "give a number above {gt:g}"),
    "greater_than_equal": ("below {ge:g}", "give a number of {ge:g} or more"),
    "less_than_equal": ("above {le:g}", "give a number of at most {le:g}"),
    "literal_error": ("not one of its words", "use {expected}"),
}


def _what(first: Any) -> str:
    if first["type"] == "extra_forbidden":
        return "unknown key"
    if first["type"] in _PLAIN:
        return _PLAIN[first["type"]][0].format(**first.get("ctx", {}))
    message = str(first["msg"]).removeprefix("Value error, ")
    return message[:1].lower() + message[1:]


def _shown(first: Any) -> object:
    value = first["input"]
    if first["type"] in {"extra_forbidden", "missing"} or isinstance(value, (dict, list)):
        return None
    return value if isinstance(value, (str, int, float)) else str(value)


def _cure(first: Any, model: type[BaseModel], path: Path, data: Any) -> str | None:
    if first["type"] == "extra_forbidden":
        names: set[str] = set()
        for owner in _models_at(model, path[:-1]):
            names |= {f.alias or n for n, f in owner.model_fields.items()}
        return nearest(str(path[-1]), names)
    plain = _PLAIN.get(first["type"])
    return None if plain is None else plain[1].format(**first.get("ctx", {}))


def _in_data(location: Sequence[str | int], data: Any, missing: bool) -> Path:
    """The part of pydantic's location that stands in the file (union tags and key markers do not)."""
    path: list[str | int] = []
    here = data
    last = len(location) - 1
    for i, step in enumerate(location):
        if isinstance(here, dict) and (step in here or (missing and i == last)):
            path.append(step)
            here = here.get(step)
        elif isinstance(here, (list, tuple)) and isinstance(step, int):
            path.append(step)
            here = here[step] if step < len(here) else None
    return tuple(path)


def _models_at(annotation: Any, path: Path) -> list[type[BaseModel]]:
    """The models that may stand at `path` below a model or annotation."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        if not path:
            return [annotation]
        for name, info in annotation.model_fields.items():
            if (info.alias or name) == path[0]:
                return _models_at(info.annotation, path[1:])
        return []
    origin, args = typing.get_origin(annotation), typing.get_args(annotation)
    if origin is typing.Annotated:
        return _models_at(args[0], path)
    if origin in {typing.Union, types.UnionType}:
        return [m for a in args for m in _models_at(a, path)]
    if origin in {list, tuple, dict} and path:
        return [m for a in args for m in _models_at(a, path[1:])]
    return []


def place(file: object, node: yaml.Node | None, path: Path) -> str:
    """`file:line` of the deepest node along `path`."""
    line = None
    for step in path:
        if isinstance(node, yaml.MappingNode):
            found = next(((k, v) for k, v in node.value if k.value == str(step)), None)
            if found is None:
                break
            line, node = found[0].start_mark.line + 1, found[1]
        elif isinstance(node, yaml.SequenceNode) and isinstance(step, int) and step < len(node.value):
            node = node.value[step]
            line = node.start_mark.line + 1
        else:
            break
    return f"{file}" if line is None else f"{file}:{line}"


def dotted(path: Path) -> str:
    """`wheels[0].radius`."""
    text = ""
    for step in path:
        text += f"[{step}]" if isinstance(step, int) else (f".{step}" if text else str(step))
    return text
