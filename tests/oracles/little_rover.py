"""Small rovers for tests: the fixtures by name, and rovers written link by link."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

import yaml

import rover_pin as rp

FIXTURES = Path(__file__).parents[1] / "fixtures"


@cache
def fixture(name: str, sidecar: str = "rover.yaml") -> Any:
    """A rover of tests/fixtures, loaded once."""
    return rp.load(FIXTURES / name / f"{name}.urdf", sidecar=FIXTURES / name / sidecar)


def _numbers(values: Sequence[float]) -> str:
    return " ".join(repr(float(value)) for value in values)


class Builder:
    """A URDF and its sidecar, one element at a time; wheels turn about y and are driven."""

    def __init__(self, name: str = "little") -> None:
        self.name = name
        self.parts: list[str] = []
        self.sidecar: dict[str, Any] = {"schema": 1, "actuated": [], "wheels": []}

    def link(
        self,
        name: str,
        mass: float = 1.0,
        com: Sequence[float] = (0.0, 0.0, 0.0),
        box: Sequence[float] | None = None,
        at: Sequence[float] = (0.0, 0.0, 0.0),
    ) -> Builder:
        """A body; `box` is its collision box, centred at `at`."""
        inertia = 0.01 * mass
        shape = ""
        if box is not None:
            shape = (
                f'<collision><origin xyz="{_numbers(at)}"/>'
                f'<geometry><box size="{_numbers(box)}"/></geometry></collision>'
            )
        self.parts.append(
            f'<link name="{name}"><inertial><origin xyz="{_numbers(com)}"/><mass value="{mass!r}"/>'
            f'<inertia ixx="{inertia!r}" iyy="{inertia!r}" izz="{inertia!r}" ixy="0" ixz="0" iyz="0"/>'
            f"</inertial>{shape}</link>"
        )
        return self

    def joint(
        self,
        name: str,
        parent: str,
        child: str,
        xyz: Sequence[float] = (0.0, 0.0, 0.0),
        axis: Sequence[float] = (0.0, 1.0, 0.0),
        kind: str = "revolute",
        limits: tuple[float, float] | None = None,
        rpy: Sequence[float] = (0.0, 0.0, 0.0),
    ) -> Builder:
        """A joint; without limits it is unbounded."""
        bound = f'lower="{limits[0]!r}" upper="{limits[1]!r}" ' if limits else ""
        self.parts.append(
            f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
            f'<origin xyz="{_numbers(xyz)}" rpy="{_numbers(rpy)}"/><axis xyz="{_numbers(axis)}"/>'
            f'<limit {bound}effort="100" velocity="10"/></joint>'
        )
        return self

    def wheel(
        self,
        name: str,
        parent: str,
        xyz: Sequence[float],
        radius: float = 0.1,
        width: float = 0.06,
        tread: float = 0.03,
        mass: float = 1e-6,
        **more: Any,
    ) -> Builder:
        """A driven wheel that weighs next to nothing."""
        self.link(f"wheel_{name}", mass)
        self.joint(f"drive_{name}", parent, f"wheel_{name}", xyz, kind="continuous")
        self.sidecar["actuated"].append(f"drive_{name}")
        entry = {"name": name, "frame": f"wheel_{name}", "radius": radius, "width": width, "tread": tread}
        self.sidecar["wheels"].append({**entry, "friction": 0.8, **more})
        return self

    def say(self, **keys: Any) -> Builder:
        """Keys of the sidecar; lists are appended to."""
        for key, value in keys.items():
            if isinstance(value, list):
                self.sidecar[key] = [*self.sidecar.get(key, []), *value]
            else:
                self.sidecar[key] = value
        return self

    def load(self, folder: Path) -> Any:
        """Write both files and load them."""
        folder.mkdir(parents=True, exist_ok=True)
        urdf = folder / f"{self.name}.urdf"
        urdf.write_text(f'<robot name="{self.name}">{"".join(self.parts)}</robot>')
        (folder / "rover.yaml").write_text(yaml.safe_dump(self.sidecar))
        return rp.load(urdf)


def four_wheels(
    half_length: float = 0.5,
    half_width: float = 0.4,
    com: Sequence[float] = (0.0, 0.0, 0.0),
    mass: float = 40.0,
    drop: float = 0.2,
    **wheel: Any,
) -> Builder:
    """A rigid box on four wheels: axles `drop` below the root link's origin."""
    made = Builder("rigid").link("base_link", mass, com)
    for end, x in (("f", half_length), ("b", -half_length)):
        for side, y in (("l", half_width), ("r", -half_width)):
            made.wheel(end + side, "base_link", (x, y, -drop), **wheel)
    return made
