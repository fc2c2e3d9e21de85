"""Files that a sidecar names: their texts are kept in its own, to make a rover again without files."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Literal

from pydantic import BaseModel, ConfigDict

from rover_pin.description.packages import Packages
from rover_pin.errors import SidecarError

Kind = Literal["srdf", "robot_yaml", "mjcf"]
NAMED: tuple[Kind, ...] = ("srdf", "robot_yaml")
"""Those that a sidecar names; the sidecar part of an MJCF comes with its tree."""


class Other(BaseModel):
    """Another file, read.

    Attributes:
        file: its path, for messages.
        text: what stands in it.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    file: str
    text: str


def read_other(path: Path, element: str | None = None, near: object = None) -> Other:
    """A file's text.

    Raises:
        SidecarError: it cannot be read.
    """
    try:
        return Other(file=str(path), text=path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError) as error:
        what = "no such file" if isinstance(error, FileNotFoundError) else f"cannot be read: {error}"
        raise SidecarError(
            what,
            file=near or path,
            element=element,
            value=str(path),
            cure="give a path from the sidecar's folder",
        ) from error


def found_by(address: str, kind: Kind, sidecar: Path, packages: Packages) -> Other:
    """The file behind a sidecar's `srdf` or `robot_yaml`: from its folder, or `package://`.

    Raises:
        SidecarError: it is not there.
    """
    if not address.startswith("package://"):
        return read_other(sidecar.parent / Path(address).expanduser(), kind, sidecar)
    path = packages.resolve(address)
    if path is None:
        raise SidecarError(
            "no such file", file=sidecar, element=kind, value=address, cure=packages.advice(address)
        )
    return read_other(path, kind, sidecar)


def with_others(text: str, others: dict[Kind, Other]) -> str:
    """The sidecar's text, and below it one line with the others'."""
    kept = {kind: other.model_dump() for kind, other in others.items()}
    return f"{text.rstrip()}\nembedded: {json.dumps(kept)}\n"
