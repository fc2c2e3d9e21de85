"""Where ROS packages lie, without ROS: a given map, then the folders around the file."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

from rover_pin.errors import InputError

_NAME = re.compile(r"<name>\s*([^<\s]+)\s*</name>")


class Packages:
    """Finds the folder of a ROS package.

    In this order: the map the user gave; a folder above the file that bears the package's name or whose
    `package.xml` does; a folder of that name beside one of those; an installed ROS, where there is one.

    Args:
        near: the file that speaks of packages.
        given: package name -> folder.

    Raises:
        InputError: a folder of the map does not exist.
    """

    def __init__(self, near: Path, given: Mapping[str, str | Path] | None = None) -> None:
        self.near = near.resolve()
        self.given = {name: Path(folder).expanduser().resolve() for name, folder in (given or {}).items()}
        for name, folder in self.given.items():
            if not folder.is_dir():
                raise InputError(
                    "no such folder",
                    element=f"package {name}",
                    value=str(folder),
                    cure="give the package's folder",
                )
        self._found: dict[str, Path | None] = {}

    def find(self, name: str) -> Path | None:
        """The folder of package `name`, or None."""
        if name not in self._found:
            self._found[name] = self.given.get(name) or self._above(name) or _installed(name)
        return self._found[name]

    def _above(self, name: str) -> Path | None:
        for folder in self.near.parents:
            if folder.name == name or _declares(folder, name):
                return folder
            beside = folder / name
            if (beside / "package.xml").is_file() or (beside.is_dir() and len(folder.parts) > 2):
                return beside
        return None

    def resolve(self, address: str) -> Path | None:
        """The file behind `package://p/x`, `file://x` or a path relative to the description, or None."""
        if address.startswith("package://"):
            name, _, rest = address.removeprefix("package://").lstrip("/").partition("/")
            folder = self.find(name)
            path = None if folder is None else folder / rest
        else:
            path = self.near.parent / address.removeprefix("file://")
        return path.resolve() if path is not None and path.is_file() else None


def _declares(folder: Path, name: str) -> bool:
    manifest = folder / "package.xml"
    if not manifest.is_file():
        return False
    found = _NAME.search(manifest.read_text(encoding="utf-8", errors="replace"))
    return found is not None and found.group(1) == name


def _installed(name: str) -> Path | None:
    from xacrodoc import packages

    try:
        return Path(packages.get_path(name))
    except packages.PackageNotFoundError:
        return None
