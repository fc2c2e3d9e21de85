"""The robot that guesses are made about: its tree, its model without a sidecar, its shapes."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import pinocchio as pin

from rover_pin.description.geometry import LinkShape, shapes_of
from rover_pin.description.notes import Notes
from rover_pin.description.packages import Packages
from rover_pin.description.prepare import Prepared, prepare
from rover_pin.description.sidecar import Sidecar
from rover_pin.description.tree import Tree, parse
from rover_pin.numerics import Array
from rover_pin.rover import Rover

_PLAIN = re.compile(r"[A-Za-z_][\w./-]*", re.ASCII)
_WORDS = frozenset({"y", "n", "yes", "no", "on", "off", "true", "false", "null"})  # no names to YAML


@dataclass(frozen=True)
class Guess:
    """A line for the sidecar.

    Attributes:
        key: where it goes: `wheels`, `passive`, ...
        line: YAML, an entry of the key's list or its whole value.
        reason: what it rests on.
        link: the wheel's or foot's, else empty.
    """

    key: str
    line: str
    reason: str
    link: str = ""


@dataclass(frozen=True)
class Subject:
    """A rover loaded without a sidecar.

    Attributes:
        rover: as loaded.
    """

    rover: Rover

    @cached_property
    def made(self) -> Prepared:
        """Its URDF as it is built on."""
        return prepare(self.rover.recipe, Sidecar(), Notes())

    @cached_property
    def stated(self) -> Tree:
        """Its URDF as written."""
        return parse(self.rover.recipe.text, str(self.rover.source))

    @cached_property
    def shapes(self) -> Mapping[str, tuple[LinkShape, ...]]:
        """Shapes by link, collision shapes first."""
        found: dict[str, tuple[LinkShape, ...]] = {}
        for shape in shapes_of(self.made.tree, self.rover.model):
            found[shape.link] = (*found.get(shape.link, ()), shape)
        return found

    @cached_property
    def at_zero(self) -> pin.Data:
        """Frames where every joint is at zero."""
        data = self.rover.model.createData()
        pin.framesForwardKinematics(self.rover.model, data, np.zeros(self.rover.model.nv))
        return data

    def frame(self, link: str) -> pin.SE3:
        """A link at zero, in the root's frame."""
        return self.at_zero.oMf[self.rover.model.getFrameId(link, pin.FrameType.BODY)]

    def axis(self, joint: str) -> Array:
        """(3,) of a moving joint at zero, in the root's frame."""
        own: Array = self.made.turning_axes()[joint]
        turned: Array = self.at_zero.oMi[self.rover.model.getJointId(joint)].rotation @ own
        return turned

    def mesh(self, address: str) -> Path | None:
        """The file of a mesh, or None."""
        return Packages(self.rover.source, self.rover.recipe.packages).resolve(address)

    def friction(self, link: str) -> float | None:
        """`<mu1>` of a link's `<gazebo>` tag, where it is above zero."""
        for tag in self.stated.robot.iterfind("gazebo"):
            said = tag.find("mu1")
            if tag.get("reference") == link and said is not None:
                try:
                    value = float(said.get("value") or said.text or 0)
                except ValueError:
                    continue
                return value if 0 < value < 10 else None
        return None


def flow(mapping: Mapping[str, object]) -> str:
    """`{a: 1, b: [0, 1, 0]}`."""
    return "{" + ", ".join(f"{flow_value(key)}: {flow_value(value)}" for key, value in mapping.items()) + "}"


def flow_value(value: object) -> str:
    """A number, name, list or mapping in YAML's flow style; names that YAML may misread in quotes."""
    if isinstance(value, Mapping):
        return flow(value)
    if isinstance(value, (list, tuple, np.ndarray)):
        return "[" + ", ".join(flow_value(each) for each in value) + "]"
    if isinstance(value, float):
        return f"{round(value, 6) + 0.0:.6g}"
    text = str(value)
    return text if _PLAIN.fullmatch(text) and text.lower() not in _WORDS else json.dumps(text)
