"""An MJCF file with its includes, compiler settings and default classes."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin

from rover_pin.description.tree import HUGE, parse_xml
from rover_pin.errors import DescriptionError
from rover_pin.numerics import Array

Element = Any  # lxml publishes no types
_WIDE = ("range", "ref")  # a large number there says that there is no limit
TINY = 1e-12
_CURE = "mend it there"
_AXES = {letter: np.eye(3)[k] for k, letter in enumerate("xyz")}


@dataclass(frozen=True)
class Source:
    """What an MJCF file says, and how its numbers are meant.

    Attributes:
        root: `<mujoco>`, includes put in.
        path: the file.
        compiler: attributes of `<compiler>`.
        classes: default attributes, by class and tag.
    """

    root: Element
    path: Path
    compiler: Mapping[str, str]
    classes: Mapping[str, Mapping[str, Mapping[str, str]]]

    @cached_property
    def places(self) -> Mapping[Element, int]:
        """Each body's place in the file."""
        return {body: k for k, body in enumerate(self.root.iter("body"))}

    def error(
        self, what: str, element: Element, value: object = None, cure: str | None = None
    ) -> DescriptionError:
        """An error that names this file and an element."""
        name = element.get("name")
        return DescriptionError(
            what,
            file=self.path,
            element=f"<{element.tag}>{f' {name}' if name else ''}",
            value=value,
            cure=cure,
        )

    def get(
        self, element: Element, key: str, default: str | None = None, tag: str | None = None
    ) -> str | None:
        """An attribute: the element's own, else its class's, else `default`."""
        own = element.get(key)
        if own is not None:
            return str(own)
        name = element.get("class") or self._childclass(element) or "main"
        if name not in self.classes:
            raise self.error("no default class of that name", element, name, "declare it under <default>")
        return self.classes[name].get(tag or element.tag, {}).get(key, default)

    def _childclass(self, element: Element) -> str | None:
        above = element.getparent()
        while above is not None:
            if above.get("childclass"):
                return str(above.get("childclass"))
            above = above.getparent()
        return None

    def numbers(
        self, element: Element, key: str, default: str | None = None, count: int | None = None
    ) -> list[float]:
        """The numbers of an attribute, empty where there is none.

        Raises:
            DescriptionError: not numbers, not finite, or not `count` of them.
        """
        text = self.get(element, key, default)
        if text is None:
            return []
        try:
            values = [float(word) for word in text.split()]
        except ValueError:
            values = [math.nan]
        if not all(map(math.isfinite, values)):
            raise self.error(f"{key} is not a list of finite numbers", element, text, "give plain numbers")
        if key not in _WIDE and any(abs(value) > HUGE for value in values):
            raise self.error(f"{key} is too large to be meant", element, text, "give m, kg, N or rad")
        if count is not None and len(values) != count:
            raise self.error(f"{key} needs {count} numbers", element, text, "mend it")
        return values

    def angle(self, value: float) -> float:
        """An angle of the file, rad."""
        return value if self.compiler.get("angle", "degree") == "radian" else math.radians(value)

    def rotation(self, element: Element) -> Array:
        """(3, 3) of quat, axisangle, xyaxes, zaxis or euler."""
        if self.get(element, "quat"):
            w, x, y, z = self.numbers(element, "quat", count=4)
            if math.hypot(w, x, y, z) < TINY:
                raise self.error("quat is zero", element, self.get(element, "quat"), "1 0 0 0 turns nothing")
            turned: Array = pin.Quaternion(w, x, y, z).normalized().toRotationMatrix()
            return turned
        if self.get(element, "axisangle"):
            *axis, angle = self.numbers(element, "axisangle", count=4)
            return np.array(pin.exp3(unit(np.array(axis)) * self.angle(angle)))
        if self.get(element, "euler"):
            matrix = np.eye(3)
            angles = self.numbers(element, "euler", count=3)
            for letter, angle in zip(self.compiler.get("eulerseq", "xyz"), angles, strict=True):
                turn = pin.exp3(_AXES[letter.lower()] * self.angle(angle))
                matrix = matrix @ turn if letter.islower() else turn @ matrix
            return np.array(matrix)
        if self.get(element, "xyaxes"):
            values = np.array(self.numbers(element, "xyaxes", count=6))
            first = unit(values[:3])
            second = unit(values[3:] - (values[3:] @ first) * first)
            return np.column_stack([first, second, np.cross(first, second)])
        if self.get(element, "zaxis"):
            return along(np.array(self.numbers(element, "zaxis", count=3)))
        return np.eye(3)

    def placed(self, element: Element) -> pin.SE3:
        """The pose of a body, geom, site or inertial in its parent."""
        return pin.SE3(self.rotation(element), np.array(self.numbers(element, "pos", "0 0 0", 3)))


def unit(vector: Array) -> Array:
    """The vector at length 1; as it is where it is zero."""
    length = float(np.linalg.norm(vector))
    return vector / length if length > 0 else vector


def along(direction: Array) -> Array:
    """(3, 3) the shortest rotation that takes z to `direction`."""
    z, wanted = np.array([0.0, 0.0, 1.0]), unit(direction)
    if np.allclose(wanted, -z, atol=1e-12):
        return np.diag([1.0, -1.0, -1.0])
    turned: Array = pin.Quaternion.FromTwoVectors(z, wanted).toRotationMatrix()
    return turned


def read(text: str, path: Path) -> Source:
    """An MJCF text with its includes.

    Raises:
        DescriptionError: not XML, an include that is not there, or a setting that is not supported.
    """
    root = parse_xml(text, path, _CURE)
    _include(root, path, 0)
    compiler: dict[str, str] = {}
    for element in root.iterfind("compiler"):
        compiler.update(element.attrib)
    order = compiler.get("eulerseq", "xyz")
    if len(order) != 3 or not set(order) <= set("xyzXYZ"):
        raise DescriptionError(
            "eulerseq is not three of x, y, z",
            file=path,
            element="<compiler>",
            value=order,
            cure="write xyz; capitals turn about fixed axes",
        )
    if compiler.get("coordinate", "local") != "local":
        raise DescriptionError(
            "global coordinates", file=path, element="<compiler>", cure="save it with local ones"
        )
    classes: dict[str, dict[str, dict[str, str]]] = {"main": {}}
    for element in root.iterfind("default"):
        _collect(element, str(element.get("class") or "main"), classes["main"], classes)
    return Source(root, path, compiler, classes)


def _include(root: Element, path: Path, depth: int) -> None:
    for element in list(root.iter("include")):
        name = element.get("file") or ""
        if depth > 8:
            raise DescriptionError(
                "includes itself", file=path, element=f"<include> {name}", cure="break the circle"
            )
        try:
            text = (path.parent / name).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise DescriptionError(
                "no such file",
                file=path,
                element="<include>",
                value=name,
                cure="put it there, or remove the include",
            ) from error
        inside = parse_xml(text, path.parent / name, _CURE)
        _include(inside, path, depth + 1)
        above = element.getparent()
        place = list(above).index(element)
        above.remove(element)
        for k, child in enumerate(list(inside)):
            above.insert(place + k, child)


def _collect(
    element: Element,
    name: str,
    inherited: Mapping[str, Mapping[str, str]],
    classes: dict[str, dict[str, dict[str, str]]],
) -> None:
    own = {tag: dict(attributes) for tag, attributes in inherited.items()}
    classes[name] = own
    for child in element:
        if child.tag != "default":
            own[child.tag] = {**own.get(child.tag, {}), **child.attrib}
    for child in element.findall("default"):
        _collect(child, str(child.get("class")), own, classes)
