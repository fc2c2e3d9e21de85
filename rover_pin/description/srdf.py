"""SRDF: what MoveIt keeps beside a URDF. Read are `group_state` (postures) and `passive_joint`."""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from rover_pin.description.tree import parse_xml
from rover_pin.errors import DescriptionError


@dataclass(frozen=True)
class Srdf:
    """What an SRDF says of joints.

    Attributes:
        postures: joint values by state; states of several groups and one name are one posture.
        passive: joints that nothing drives.
        dropped: joints of states that have several values: a floating or planar base, a ball.
    """

    postures: Mapping[str, Mapping[str, float]]
    passive: tuple[str, ...]
    dropped: tuple[str, ...]


@functools.lru_cache(maxsize=64)
def read_srdf(text: str, file: str) -> Srdf:
    """The states and passive joints of an SRDF text.

    Raises:
        DescriptionError: not an SRDF, a state or joint without a name, a value that is no number, or a joint
            with two values in one posture.
    """
    robot = _robot(text, file)
    postures: dict[str, dict[str, float]] = {}
    dropped: dict[str, None] = {}
    for state in robot.iterfind("group_state"):
        name = _named(state, "group_state", file)
        kept = postures.setdefault(name, {})
        for joint in state.iterfind("joint"):
            where = f"group_state {name}, joint {_named(joint, f'joint of group_state {name}', file)}"
            values = _numbers(joint, where, file)
            own = str(joint.get("name"))
            if len(values) != 1:
                dropped[own] = None
            elif kept.setdefault(own, values[0]) != values[0]:
                raise DescriptionError(
                    f"two values in one posture, {kept[own]:g} and {values[0]:g}",
                    file=file,
                    element=where,
                    cure="rename one of the states",
                )
    passive = (_named(joint, "passive_joint", file) for joint in robot.iterfind("passive_joint"))
    return Srdf(postures, tuple(dict.fromkeys(passive)), tuple(dropped))


def _robot(text: str, file: str) -> Any:
    from lxml import etree

    robot = parse_xml(text, file, "give an SRDF file")
    if robot.tag != "robot" or robot.find("link") is not None:
        what = "a URDF" if robot.tag == "robot" else f"<{etree.QName(robot).localname}>"
        raise DescriptionError(
            f"not an SRDF: it is {what}", file=file, cure="give a file of <robot> with <group_state>"
        )
    return robot


def _named(element: Any, kind: str, file: str) -> str:
    name = str(element.get("name") or "")
    if not name:
        raise DescriptionError("no name", file=file, element=f"a {kind}", cure="name it")
    return name


def _numbers(joint: Any, where: str, file: str) -> list[float]:
    text = str(joint.get("value") or "")
    try:
        values = [float(word) for word in text.split()]
    except ValueError:
        values = []
    if not values or not all(map(math.isfinite, values)):
        raise DescriptionError(
            "its value is not a finite number", file=file, element=where, value=text, cure="give rad or m"
        )
    return values
