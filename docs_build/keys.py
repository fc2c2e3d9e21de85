"""The keys of a file, from the models that read it; a key that nobody explains is an error."""

from __future__ import annotations

import inspect
import re
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import yaml
from pydantic import BaseModel
from pydantic.fields import FieldInfo

from docs_build.annotations import models_in, slug, words_of
from rover_pin.analysis.ground import MapFile, RoughShape, StepShape
from rover_pin.analysis.spec import StudySpec
from rover_pin.description.sidecar import Sidecar

HERE = Path(__file__).parent


class SilentKeyError(ValueError):
    """A key of the file that neither its model nor the words explain, or words about no key."""


@dataclass(frozen=True)
class Reference:
    """The keys of one kind of file.

    Attributes:
        root: the model of the whole file.
        place: a YAML file with the words: `titles` of the models' tables and what stands above them
            (`openings`; else the docstring), by model; what `keys` mean that their model does not explain,
            what a key `takes` and its `defaults` where the model's own words are for machines, by
            `Model.key`.
        hidden: keys of the root that nobody writes.
        others: models that no annotation leads to.
    """

    root: type[BaseModel]
    place: Path
    hidden: frozenset[str] = field(default_factory=frozenset)
    others: tuple[type[BaseModel], ...] = ()

    @cached_property
    def words(self) -> dict[str, dict[str, str]]:
        """What the YAML file says."""
        found: dict[str, dict[str, str]] = yaml.safe_load(self.place.read_text(encoding="utf-8"))
        return found

    def markdown(self) -> str:
        """Tables of all keys: first the file's, then what stands in each."""
        text = ["## The file", "", self._table(self.root)]
        for model in self.nested:
            opening = self.words.get("openings", {}).get(model.__name__) or _opening(model)
            text += [f"## {self.title(model)}", "", opening, "", self._table(model)]
        return "\n".join(text)

    @cached_property
    def nested(self) -> tuple[type[BaseModel], ...]:
        """Every model below the root, in the order in which keys name them."""
        found: dict[type[BaseModel], None] = {}

        def walk(model: type[BaseModel]) -> None:
            for name, each in model.model_fields.items():
                if model is self.root and name in self.hidden:
                    continue
                for inner in models_in(each.annotation):
                    if inner not in found:
                        found[inner] = None
                        walk(inner)

        walk(self.root)
        return tuple(dict.fromkeys([*found, *self.others]))

    def entries(self) -> list[tuple[type[BaseModel], str, FieldInfo]]:
        """(model, key as it is written, field) for each key."""
        return [
            (model, each.alias or name, each)
            for model in (self.root, *self.nested)
            for name, each in model.model_fields.items()
            if not (model is self.root and name in self.hidden)
        ]

    def meaning(self, model: type[BaseModel], key: str) -> str:
        """What a key means.

        Raises:
            SilentKeyError: nobody says.
        """
        said = self._said("keys", model, key) or _attributes(model).get(key)
        if not said:
            raise SilentKeyError(f"{model.__name__}.{key} is not explained; say it in {self.place.name}")
        return " ".join(str(said).split())

    def check_words(self) -> None:
        """Nothing where words and models fit.

        Raises:
            SilentKeyError: a key without words, or words without a key.
        """
        known = {f"{model.__name__}.{key}" for model, key, _ in self.entries()}
        for part in ("keys", "takes", "defaults"):
            for name in self.words.get(part, {}):
                if name not in known:
                    raise SilentKeyError(f"{self.place.name}: {name} is no key of the file")
        for model, key, _ in self.entries():
            self.meaning(model, key)

    def title(self, model: type[BaseModel]) -> str:
        """The heading of a model's table."""
        try:
            return self.words["titles"][model.__name__]
        except KeyError:
            raise SilentKeyError(f"{model.__name__} has no title in {self.place.name}") from None

    def anchor(self, model: type[BaseModel]) -> str:
        """The anchor of that heading."""
        return slug(self.title(model))

    def _said(self, part: str, model: type[BaseModel], key: str) -> str | None:
        return self.words.get(part, {}).get(f"{model.__name__}.{key}")

    def _table(self, model: type[BaseModel]) -> str:
        rows = ["| key | takes | default | what |", "|---|---|---|---|"]
        for owner, key, each in self.entries():
            if owner is model:
                takes = self._said("takes", model, key) or words_of(each.annotation, self._link)
                default = self._said("defaults", model, key) or _default(each)
                what = self.meaning(model, key).replace("|", r"\|")
                rows.append(f"| `{key}` | {takes} | {default} | {what} |")
        return "\n".join(rows) + "\n"

    def _link(self, model: type[BaseModel]) -> str:
        return f"[{self.title(model)}](#{self.anchor(model)})"


SIDECAR = Reference(Sidecar, HERE / "sidecar_words.yaml", frozenset({"embedded"}))
"""`rover.yaml`; `embedded` is what the loader writes for itself, to make a rover again without files."""

STUDY = Reference(StudySpec, HERE / "study_words.yaml", others=(RoughShape, MapFile, StepShape))
"""The study file."""


def _opening(model: type[BaseModel]) -> str:
    """A model's docstring, without its list of attributes."""
    return inspect.cleandoc(model.__doc__ or "").split("\nAttributes:")[0].strip()


def _attributes(model: type[BaseModel]) -> dict[str, str]:
    """The docstring's `Attributes:`; one line may be about several, `a, b: text`."""
    _, _, body = inspect.cleandoc(model.__doc__ or "").partition("\nAttributes:\n")
    told: dict[str, str] = {}
    for names, text in re.findall(r"^    (\w+(?:, \w+)*): (.*(?:\n        .*)*)", body, re.M):
        told |= dict.fromkeys(names.split(", "), text)
    return told


def _default(each: FieldInfo) -> str:
    if each.is_required() or each.alias == "schema":  # the file's reader asks for that one
        return "required"
    default = each.default
    if each.default_factory is not None or default is None or default in ((), {}, ""):
        return ""
    shown = list(default) if isinstance(default, tuple) else default
    return f"`{shown}`".replace("True", "true").replace("False", "false").replace("'", "")
