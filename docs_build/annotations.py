"""Type annotations in words."""

from __future__ import annotations

import re
import types
import typing
from collections.abc import Callable
from typing import Annotated, Any, Literal, Union

from pydantic import BaseModel


class SpeechlessError(ValueError):
    """An annotation that there are no words for."""


def models_in(annotation: Any) -> list[type[BaseModel]]:
    """The models that an annotation names, anywhere in it."""
    bare = _bare(annotation)
    if isinstance(bare, type) and issubclass(bare, BaseModel):
        return [bare]
    return [model for each in typing.get_args(bare) for model in models_in(each)]


def words_of(annotation: Any, link: Callable[[type[BaseModel]], str]) -> str:
    """An annotation in words; models are linked to by `link`.

    Raises:
        SpeechlessError: there are none for it.
    """
    bare = _bare(annotation)
    origin, inner = typing.get_origin(bare), typing.get_args(bare)
    if isinstance(bare, type) and origin is None:
        if issubclass(bare, BaseModel):
            return link(bare)
        return {float: "number", int: "whole number", str: "text", bool: "true or false"}[bare]
    if origin is Literal:
        return ", ".join(f"`{each}`" for each in inner)
    if origin in (Union, types.UnionType):
        return " or ".join(dict.fromkeys(words_of(each, link) for each in inner if each is not type(None)))
    if origin is dict:
        return f"name: {words_of(inner[1], link)}"
    if origin is tuple and inner[-1] is Ellipsis:
        return f"list of {words_of(inner[0], link)}"
    if origin is tuple:
        words = [words_of(each, link) for each in inner]
        return f"{len(words)} × {words[0]}" if len(set(words)) == 1 else f"[{', '.join(words)}]"
    raise SpeechlessError(f"no words for {annotation}")


def slug(text: str) -> str:
    """A heading's anchor."""
    return re.sub(r"[^\w]+", "-", text.lower()).strip("-")


def _bare(annotation: Any) -> Any:
    """An annotation without what `Annotated` says about it."""
    while typing.get_origin(annotation) is Annotated:
        annotation = typing.get_args(annotation)[0]
    return annotation
