"""The catalogue of bundled robots: each is a folder `urdf/<robot>/` with its xacro, sidecar and README."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import resources
from pathlib import Path

from rover_pin.description import examples
from rover_pin.errors import DescriptionError, nearest

SIDECAR = "rover.yaml"
GEPETTO = "robot.yaml"


@dataclass(frozen=True)
class Entry:
    """A bundled robot.

    Attributes:
        name: what `load` calls it.
        path: its xacro or URDF file.
        summary: the first sentence line of its README.
    """

    name: str
    path: Path
    summary: str


def robots() -> tuple[Entry, ...]:
    """All bundled robots, by name."""
    base = Path(str(resources.files("rover_pin"))) / "urdf"
    if not base.is_dir():
        return ()
    found = []
    for folder in sorted(base.iterdir()):
        path = _description(folder) if folder.is_dir() else None
        if path is not None:
            found.append(Entry(folder.name, path, _summary(folder / "README.md")))
    return tuple(found)


def locate(name_or_path: str | Path) -> tuple[str | None, Path]:
    """The bundled name, if it is one, and the file to read.

    `example:NAME` is a robot of the package example-robot-data.
    A word without a separator or suffix is a bundled robot first and a path second; a folder stands for the
    description of the folder's own name inside it.

    Raises:
        DescriptionError: neither a bundled robot nor a file.
    """
    text = str(name_or_path)
    if text.startswith(examples.PREFIX):
        return text, examples.description_of(text)
    known = {entry.name: entry.path for entry in robots()}
    if isinstance(name_or_path, str) and text in known:
        return text, known[text]
    path = Path(text).expanduser()
    if path.is_dir():
        inside = _description(path.resolve())
        if inside is None:
            raise DescriptionError(
                "a folder without a description of its name",
                file=path,
                cure=f"name the file, or put {path.resolve().name}.urdf.xacro in it",
            )
        return None, inside
    if path.is_file():
        return None, path
    if _looks_like_path(text):
        raise DescriptionError(
            "no such file", file=path, cure="check the path; a bundled robot goes by its bare name"
        )
    raise DescriptionError(
        "no bundled robot of that name",
        value=text,
        cure=f"{nearest(text, known)}; a path to a URDF or xacro works too",
    )


def _looks_like_path(text: str) -> bool:
    return "/" in text or "\\" in text or text.endswith((".urdf", ".xacro", ".xml"))


def _description(folder: Path) -> Path | None:
    for suffix in (".urdf.xacro", ".xacro", ".urdf"):
        path = folder / f"{folder.name}{suffix}"
        if path.is_file():
            return path
    return None


def _summary(readme: Path) -> str:
    if not readme.is_file():
        return ""
    for line in readme.read_text(encoding="utf-8").splitlines():
        prose = line.strip()
        if prose and prose[0].isalpha():
            return prose
    return ""
