"""YAML files read safely: one mapping, no key twice."""

from __future__ import annotations

from collections.abc import Hashable
from pathlib import Path
from typing import Any

import yaml

from rover_pin.errors import StudyError


class _Loader(yaml.SafeLoader):
    """The safe loader, which takes no key twice."""

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Hashable, Any]:
        """A mapping; PyYAML itself would keep the last of two equal keys."""
        seen: set[object] = set()
        for key_node, _ in node.value:
            key = self.construct_object(key_node, deep=True)
            if key in seen:
                line = key_node.start_mark.line + 1
                raise StudyError(f"key stands twice (line {line})", element=str(key), cure="keep one")
            seen.add(key)
        return super().construct_mapping(node, deep)


def parse_mapping(text: str, file: object = None) -> dict[str, Any]:
    """The mapping that `text` holds.

    Raises:
        StudyError: not YAML, a key twice, or no mapping.
    """
    try:
        raw = yaml.load(text, Loader=_Loader)
    except StudyError as error:
        raise StudyError(error.what, file=file, element=error.element, cure=error.cure) from None
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        where = f" in line {mark.line + 1}" if mark else ""
        problem = getattr(error, "problem", None) or "syntax"
        raise StudyError(f"is not YAML{where}: {problem}", file=file) from None
    if not isinstance(raw, dict):
        kind = "nothing" if raw is None else type(raw).__name__
        raise StudyError(
            "is no mapping of keys to values", file=file, value=kind, cure="start with `robot: NAME`"
        )
    return raw


def read_mapping(path: Path) -> tuple[dict[str, Any], str]:
    """The mapping in the file at `path`, and its text.

    Raises:
        StudyError: as `parse_mapping`, or the file cannot be read.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise StudyError("no such file", file=path) from None
    except IsADirectoryError:
        raise StudyError("is a folder, not a study file", file=path) from None
    except UnicodeDecodeError:
        raise StudyError("is not text in UTF-8", file=path, cure="give a study file in YAML") from None
    except OSError as error:
        raise StudyError(f"cannot be read: {error.strerror}", file=path) from None
    return parse_mapping(text, path), text
