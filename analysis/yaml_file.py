"""YAML files read safely: one mapping, no key twice."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rover_pin.description.reading import dotted
from rover_pin.description.yaml_nodes import RefusedError, read_yaml
from rover_pin.errors import StudyError


def parse_mapping(text: str, file: object = None) -> dict[str, Any]:
    """The mapping that `text` holds.

    Raises:
        StudyError: not YAML, a key twice, or no mapping.
    """
    try:
        raw, _ = read_yaml(text)
    except RefusedError as error:
        where = file if error.line is None else f"{file or 'the study'}:{error.line}"
        raise StudyError(
            error.what, file=where, element=dotted(error.path) or None, cure=error.cure
        ) from None
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
