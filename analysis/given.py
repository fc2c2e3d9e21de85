"""Studies made in Python: a terrain given as an object, and the text that stands for the study file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml

from rover_pin.analysis.ground import Ground
from rover_pin.errors import StudyError


class GivenTerrain(Ground):
    """A Terrain handed over as it is."""

    given: Any

    def build(self, folder: Path) -> Any:
        """The terrain.

        Raises:
            StudyError: it is no terrain.
        """
        from rover_pin.terrain import Terrain

        if not isinstance(self.given, Terrain):
            cure = "give a rover_pin.Terrain or the words of a study file"
            raise StudyError("is no terrain", element="terrain", value=type(self.given).__name__, cure=cure)
        return self.given


def as_text(raw: Mapping[str, Any]) -> str:
    """A study file that says the same; objects by their labels."""
    return yaml.safe_dump(_plain(raw), sort_keys=False, default_flow_style=None)


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _plain(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(each) for each in value]
    if isinstance(value, str | int | float | bool) or value is None:
        return value
    if hasattr(value, "tolist"):
        return value.tolist()
    return str(getattr(value, "label", value))
