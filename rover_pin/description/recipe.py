"""The texts a rover is made from: enough to make it again in another process, without its files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from rover_pin.description.masses import Masses

Payload = tuple[float, tuple[float, float, float] | str]
"""A mass [kg] and where: a place in the root link's frame [m], or the link at whose origin it sits."""


def seat(place: tuple[float, float, float] | str, root: str) -> tuple[str, tuple[float, float, float]]:
    """The link that carries a payload, and where on it (m, in the link's frame)."""
    return (place, (0.0, 0.0, 0.0)) if isinstance(place, str) else (root, place)


@dataclass(frozen=True)
class Recipe:
    """What `assemble` needs.

    Attributes:
        name: the bundled robot's, or None.
        source: the URDF or xacro file.
        text: the expanded URDF.
        sidecar_path: the sidecar's file, or None.
        sidecar_text: its text, or None.
        parameters: value of every declared parameter.
        packages: package name -> folder, as given.
        skip_missing_includes: as given.
        payload: masses put on it.
        masses: other ones than the texts say.
        notes: what expanding told.
    """

    name: str | None
    source: Path
    text: str
    sidecar_path: Path | None = None
    sidecar_text: str | None = None
    parameters: Mapping[str, float] = field(default_factory=dict)
    packages: Mapping[str, str] = field(default_factory=dict)
    skip_missing_includes: bool = False
    payload: tuple[Payload, ...] = ()
    masses: Masses = field(default_factory=Masses)
    notes: tuple[str, ...] = ()
