"""The keys of the sidecar, from the models that read it; a key that nobody explains is an error."""

from __future__ import annotations

import functools
import inspect
import re
import types
import typing
from pathlib import Path
from typing import Annotated, Any, Literal, Union

import yaml
from pydantic import BaseModel
from pydantic.fields import FieldInfo

from rover_pin.description.sidecar import Sidecar

WORDS = Path(__file__).parent / "sidecar_words.yaml"
"""What keys mean that their model does not explain, `Model.key: text`; and what stands above each section."""

HIDDEN = {"embedded"}
"""What the loader writes for itself, to make a rover again without files."""


class SilentKeyError(ValueError):
    """A key of the sidecar that neither its model nor the words explain, or words about no key."""


def reference() -> str:
    """Tables of all keys, Markdown: first the file's, then what stands in each."""
    text = ["## The file", "", _table(Sidecar)]
    for model in nested():
        text += [f"## {title(model)}", "", _opening(model), "", _table(model)]
    return "\n".join(text)


@functools.cache
def nested() -> tuple[type[BaseModel], ...]:
    """Every model below the sidecar, in the order in which keys name them."""
    found: dict[type[BaseModel], None] = {}

    def walk(model: type[BaseModel]) -> None:
        for name, field in model.model_fields.items():
            if model is Sidecar and name in HIDDEN:
                continue
            for each in _models(field.annotation):
                if each not in found:
                    found[each] = None
                    walk(each)

    walk(Sidecar)
    return tuple(found)


def entries() -> list[tuple[type[BaseModel], str, FieldInfo]]:
    """(model, key as it is written, field) for each key."""
    return [
        (model, field.alias or name, field)
        for model in (Sidecar, *nested())
        for name, field in model.model_fields.items()
        if not (model is Sidecar and name in HIDDEN)
    ]


def meaning(model: type[BaseModel], key: str) -> str:
    """What a key means.

    Raises:
        SilentKeyError: nobody says.
    """
    said = _attributes(model).get(key) or _words()["keys"].get(f"{model.__name__}.{key}")
    if not said:
        raise SilentKeyError(f"{model.__name__}.{key} is not explained; say it in {WORDS.name}")
    return " ".join(str(said).split())


def check_words() -> None:
    """Nothing where words and models fit.

    Raises:
        SilentKeyError: a key without words, or words without a key.
    """
    known = {f"{model.__name__}.{key}" for model, key, _ in entries()}
    for name in _words()["keys"]:
        if name not in known:
            raise SilentKeyError(f"{WORDS.name}: {name} is no key of the sidecar")
    for model, key, _ in entries():
        meaning(model, key)


def title(model: type[BaseModel]) -> str:
    """The heading of a model's table."""
    try:
        return str(_words()["titles"][model.__name__])
    except KeyError:
        raise SilentKeyError(f"{model.__name__} has no title in {WORDS.name}") from None


@functools.cache
def _words() -> dict[str, dict[str, str]]:
    found: dict[str, dict[str, str]] = yaml.safe_load(WORDS.read_text(encoding="utf-8"))
    return found


def _opening(model: type[BaseModel]) -> str:
    """A model's docstring, without its list of attributes."""
    return inspect.cleandoc(model.__doc__ or "").split("\nAttributes:")[0].strip()


def _attributes(model: type[BaseModel]) -> dict[str, str]:
    """The docstring's `Attributes:`."""
    _, found, body = inspect.cleandoc(model.__doc__ or "").partition("\nAttributes:\n")
    if not found:
        return {}
    told: dict[str, str] = {}
    for name, text in re.findall(r"^    (\w+): (.*(?:\n        .*)*)", body, re.M):
        told[name] = text
    return told


def _table(model: type[BaseModel]) -> str:
    rows = ["| key | takes | default | what |", "|---|---|---|---|"]
    for owner, key, field in entries():
        if owner is model:
            what = meaning(model, key).replace("|", r"\|")
            rows.append(f"| `{key}` | {_type(field.annotation)} | {_default(field)} | {what} |")
    return "\n".join(rows) + "\n"


def _default(field: FieldInfo) -> str:
    if field.is_required() or field.alias == "schema":  # the file's reader asks for that one
        return "required"
    if field.default is None or field.default in ((), {}, ""):
        return ""
    default = field.default
    return f"`{list(default) if isinstance(default, tuple) else default}`".replace("True", "true").replace(
        "False", "false"
    )


def _bare(annotation: Any) -> Any:
    """An annotation without what `Annotated` says about it."""
    while typing.get_origin(annotation) is Annotated:
        annotation = typing.get_args(annotation)[0]
    return annotation


def _models(annotation: Any) -> list[type[BaseModel]]:
    bare = _bare(annotation)
    if isinstance(bare, type) and issubclass(bare, BaseModel):
        return [bare]
    return [model for each in typing.get_args(bare) for model in _models(each)]


def _type(annotation: Any) -> str:
    """An annotation in words."""
    bare = _bare(annotation)
    origin, inner = typing.get_origin(bare), typing.get_args(bare)
    if isinstance(bare, type) and origin is None:
        if issubclass(bare, BaseModel):
            return f"[{title(bare)}](#{_slug(title(bare))})"
        return {float: "number", int: "number", str: "text", bool: "true or false"}[bare]
    if origin is Literal:
        return ", ".join(f"`{each}`" for each in inner)
    if origin in (Union, types.UnionType):
        return " or ".join(dict.fromkeys(_type(each) for each in inner if each is not type(None)))
    if origin is dict:
        return f"name: {_type(inner[1])}"
    if origin is tuple and inner[-1] is Ellipsis:
        return f"list of {_type(inner[0])}"
    if origin is tuple:
        words = [_type(each) for each in inner]
        return f"{len(words)} × {words[0]}" if len(set(words)) == 1 else f"[{', '.join(words)}]"
    raise SilentKeyError(f"no words for {annotation}")


def _slug(text: str) -> str:
    return re.sub(r"[^\w]+", "-", text.lower()).strip("-")
