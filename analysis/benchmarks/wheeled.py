"""Statically determinate rovers of any even number of wheels, for cost over the number of wheels.

Each side is a binary tree of passive beams with k/2 wheels as its leaves; the two top beams are the rockers,
and a differential couples them. Free are the base's three, k/2 - 1 beams a side, less the differential's one:
k coordinates for k wheels. A beam's pivot is where its two ends balance, so that every wheel carries the same
load on level ground, the beams' own weight aside.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import yaml

from rover_pin.errors import InputError
from rover_pin.loader import load

if TYPE_CHECKING:
    from rover_pin.rover import Rover

RADIUS, WIDTH, APART, TRACK, PIVOT_RISE = 0.13, 0.11, 0.36, 1.2, 0.05
"""Of wheels; between them along a side; between the sides; of a pivot over what hangs on it: m."""

UNIT = '<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/>'


@dataclass
class _Text:
    """What is being written."""

    parts: list[str] = field(default_factory=list)
    passive: list[str] = field(default_factory=list)
    wheels: list[dict[str, Any]] = field(default_factory=list)

    def link(self, name: str, mass: float) -> None:
        self.parts.append(f'<link name="{name}"><inertial><mass value="{mass}"/>{UNIT}</inertial></link>')

    def joint(self, name: str, kind: str, parent: str, child: str, xyz: tuple[float, float, float]) -> None:
        limit = '<limit lower="-0.9" upper="0.9" effort="0" velocity="9"/>' if kind == "revolute" else ""
        place = " ".join(repr(v) for v in xyz)
        self.parts.append(
            f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
            f'<origin xyz="{place}"/><axis xyz="0 1 0"/>{limit}</joint>'
        )


@dataclass(frozen=True)
class _Part:
    """A subtree: its wheels' x, and how high over their centres it hangs, m."""

    name: str
    wheels: tuple[float, ...]

    @property
    def x(self) -> float:
        return sum(self.wheels) / len(self.wheels)

    @property
    def z(self) -> float:
        return PIVOT_RISE * (len(self.wheels) - 1)


def wheeled_rover(wheels: int, folder: Path) -> Rover:
    """A rover on so many wheels, its URDF and sidecar written into `folder`.

    Raises:
        InputError: not an even number from 4.
    """
    if wheels < 4 or wheels % 2:
        raise InputError("must be an even number, at least 4", element="wheels", value=wheels)
    text = _Text()
    text.link("base", 60.0)
    side = tuple(APART * (i - (wheels / 2 - 1) / 2) for i in range(wheels // 2))
    height = _Part("", side).z
    for letter, y in (("l", TRACK / 2), ("r", -TRACK / 2)):
        _hang(text, _Part(f"top_{letter}", side), "base", (0.0, 0.0), y)
    name = f"{wheels} wheels"
    urdf = folder / f"wheels_{wheels}.urdf"
    urdf.write_text(f'<robot name="{name}">{"".join(text.parts)}</robot>')
    sidecar = folder / f"wheels_{wheels}.yaml"
    differential = {"name": "differential", "joints": {"top_l": 1, "top_r": 1}}
    belly = [{"frame": "base", "point": [0.0, 0.0, -min(0.1, height)]}]
    said = {
        "schema": 1,
        "couplings": [differential],
        "passive": text.passive,
        "wheels": text.wheels,
        "belly": belly,
    }
    sidecar.write_text(yaml.safe_dump(said))
    return load(urdf, sidecar=sidecar)


def _hang(text: _Text, part: _Part, parent: str, at: tuple[float, float], y: float) -> None:
    """Put a subtree under `parent`, whose origin lies at x, z `at`; y is of the first joint alone."""
    where = part.x - at[0], y, part.z - at[1] if parent != "base" else 0.0
    link = f"{part.name}_link"
    if len(part.wheels) == 1:
        text.link(link, 3.0)
        text.joint(part.name, "continuous", parent, link, where)
        text.wheels.append(
            {"name": part.name, "frame": link, "radius": RADIUS, "width": WIDTH, "tread": 0.03}
        )
        return
    text.link(link, 2.0)
    text.joint(part.name, "revolute", parent, link, where)
    text.passive.append(part.name)
    half = len(part.wheels) // 2
    for letter, xs in (("a", part.wheels[:half]), ("b", part.wheels[half:])):
        _hang(text, _Part(f"{part.name}{letter}", xs), link, (part.x, part.z), 0.0)
