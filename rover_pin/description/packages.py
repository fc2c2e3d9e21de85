"""Where ROS packages lie, without ROS: a given map, the environment, then the folders around the file."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from pathlib import Path

from rover_pin.errors import InputError

_NAME = re.compile(r"<name>\s*([^<\s]+)\s*</name>")
_DEEP = 3  # folders below an entry of ROS_PACKAGE_PATH that are looked into
_MOST = 4  # places that a message lists


class Packages:
    """Finds the folder of a ROS package.

    In this order: the map the user gave; a folder above the file that bears the package's name or whose
    `package.xml` does; ROS_PACKAGE_PATH and AMENT_PREFIX_PATH; a folder of that name beside one of those
    above the file; an installed ROS, where there is one.

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
        self._found: dict[str, tuple[Path, ...]] = {}

    def find(self, name: str) -> Path | None:
        """The folder of package `name`, or None."""
        return next(iter(self._all(name)), None)

    def _all(self, name: str) -> tuple[Path, ...]:
        """Every folder that may be the package's, the likeliest first."""
        if name not in self._found:
            self._found[name] = tuple(dict.fromkeys(self._candidates(name)))
        return self._found[name]

    def _candidates(self, name: str) -> Iterator[Path]:
        if name in self.given:
            yield self.given[name]
            return
        yield from (f for f in self.near.parents if f.name == name or _declares(f, name))
        yield from _of_environment(name)
        for folder in self.near.parents:
            beside = folder / name
            if (beside / "package.xml").is_file() or (beside.is_dir() and len(folder.parts) > 2):
                yield beside
        installed = _installed(name)
        if installed is not None:
            yield installed

    def resolve(self, address: str) -> Path | None:
        """The file behind `package://p/x`, `file://x` or a path relative to the description, or None."""
        if address.startswith("package://"):
            name, rest = _split(address)
            paths = [folder / rest for folder in self._all(name)]
        else:
            paths = [self.near.parent / address.removeprefix("file://")]
        return next((path.resolve() for path in paths if path.is_file()), None)

    def advice(self, address: str) -> str:
        """Where a file of a package was looked for, and the cure."""
        name, rest = _split(address)
        folders = self._all(name)
        if folders:
            places = ", ".join(str(folder) for folder in folders[:_MOST])
            return f"tried {rest or 'it'} in {places}; give the folder that has it: --package {name}=DIR"
        return f"tried {', '.join(self.tried(name))}; give its folder: --package {name}=DIR"

    def tried(self, name: str) -> tuple[str, ...]:
        """Where a package was looked for that was not found."""
        given = ", ".join(self.given) or "empty"
        entries = {key: _entries(key) for key in ("ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH")}
        return (
            f"the map ({given})",
            *(f"{key} ({os.pathsep.join(map(str, each)) or 'not set'})" for key, each in entries.items()),
            f"{name} among and beside the folders above {self.near}",
            "an installed ROS",
        )


def _split(address: str) -> tuple[str, str]:
    name, _, rest = address.removeprefix("package://").lstrip("/").partition("/")
    return name, rest


def _entries(key: str) -> list[Path]:
    return [Path(each) for each in os.environ.get(key, "").split(os.pathsep) if each]


def _of_environment(name: str) -> Iterator[Path]:
    """A package below ROS_PACKAGE_PATH (itself, or down to three folders), or installed in a prefix."""
    for entry in _entries("ROS_PACKAGE_PATH"):
        for depth in range(_DEEP + 1):
            for manifest in sorted(entry.glob("/".join(["*"] * depth + ["package.xml"]))):
                if manifest.parent.name == name or _declares(manifest.parent, name):
                    yield manifest.parent
        if (entry / name).is_dir():
            yield entry / name
    for prefix in _entries("AMENT_PREFIX_PATH"):
        if (prefix / "share" / name).is_dir():
            yield prefix / "share" / name


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
