"""Checks of a URDF before anything is built on it.

Pinocchio accepts or silently drops most of what is wrong here.
"""

from __future__ import annotations

import math
import re

from rover_pin.description.model import BASE_DOF
from rover_pin.description.tree import HUGE, JOINT_TYPES, MOVING, Element, Tree, child_of, parent_of
from rover_pin.errors import nearest

COUNTS = {
    ("origin", "xyz"): 3,
    ("origin", "rpy"): 3,
    ("axis", "xyz"): 3,
    ("box", "size"): 3,
    ("cylinder", "radius"): 1,
    ("cylinder", "length"): 1,
    ("sphere", "radius"): 1,
    ("mesh", "scale"): 3,
    ("color", "rgba"): 4,
    ("mass", "value"): 1,
    ("limit", "lower"): 1,
    ("limit", "upper"): 1,
    ("limit", "effort"): 1,
    ("limit", "velocity"): 1,
    ("mimic", "multiplier"): 1,
    ("mimic", "offset"): 1,
} | {("inertia", key): 1 for key in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")}
"""How many numbers stand in an attribute, by element and attribute."""

NEEDED = {
    "mass": ("value",),
    "box": ("size",),
    "cylinder": ("radius", "length"),
    "sphere": ("radius",),
    "mesh": ("filename",),
}
"""Attributes without which an element says nothing."""

_PLAIN = re.compile(r"[-+.0-9eE]+|[-+]?(inf|infinity|nan)", re.IGNORECASE | re.ASCII)
_RESERVED = {*BASE_DOF, "universe"}
ROUNDING = 1e-12  # kg m2 below zero that a mesh program may write
_MAY_BE_INFINITE = {"limit"}


def check(tree: Tree) -> None:
    """Everything that can be wrong with names, structure and numbers.

    Raises:
        DescriptionError: the first thing found, with the element, the value and the cure.
    """
    _names(tree)
    _expanded(tree)
    _types(tree)
    _ends(tree)
    _one_tree(tree)
    for element in (*tree.links.values(), *tree.joints.values(), *tree.robot.findall("material")):
        _numbers(tree, element)
    for name, joint in tree.joints.items():
        _axis(tree, name, joint)
    for name, link in tree.links.items():
        _inertia(tree, name, link)


def label(element: Element) -> str:
    """`link x` or `joint x`."""
    return f"{element.tag} {element.get('name')}"


def _names(tree: Tree) -> None:
    for kind in ("link", "joint"):
        seen: set[str] = set()
        for element in tree.robot.findall(kind):
            name = element.get("name")
            if not name:
                raise tree.error("no name", f"a {kind}", cure=f"name every <{kind}>")
            if name in seen:
                raise tree.error("the name stands twice", f"{kind} {name}", cure=f"rename one <{kind}>")
            seen.add(name)
            if kind == "joint" and name in _RESERVED:
                raise tree.error("a name kept for the base", f"joint {name}", cure="rename the joint")


def _expanded(tree: Tree) -> None:
    for top in (*tree.links.values(), *tree.joints.values()):
        for element in top.iter():
            for key, value in element.attrib.items():
                if "${" in value or "$(" in value:
                    raise tree.error(
                        f"an unexpanded expression in <{element.tag} {key}>",
                        label(top),
                        value,
                        "give the .xacro file, or expand it first",
                    )


def _types(tree: Tree) -> None:
    for name, joint in tree.joints.items():
        kind = joint.get("type")
        if kind not in JOINT_TYPES:
            cure = nearest(kind, JOINT_TYPES) if kind else "state its type"
            raise tree.error("unknown joint type" if kind else "no joint type", f"joint {name}", kind, cure)
        if kind == "planar":
            raise tree.error(
                "planar joints are not supported",
                f"joint {name}",
                cure="use two prismatic joints and a revolute one",
            )


def _ends(tree: Tree) -> None:
    above: dict[str, str] = {}
    for name, joint in tree.joints.items():
        for role, link in (("parent", parent_of(joint)), ("child", child_of(joint))):
            if link not in tree.links:
                what = f"its {role} link does not exist" if link else f"no <{role}>"
                raise tree.error(what, f"joint {name}", link or None, nearest(link, tree.links))
        child = child_of(joint)
        if child in above:
            raise tree.error(
                f"child of two joints, {above[child]} and {name}",
                f"link {child}",
                cure="keep one and close the loop in the sidecar under `loops`",
            )
        above[child] = name


def _one_tree(tree: Tree) -> None:
    roots = [name for name in tree.links if tree.joint_above(name) is None]
    if len(roots) > 1:
        raise tree.error(
            f"{len(roots)} root links: {', '.join(roots[:4])}" + (", ..." if len(roots) > 4 else ""),
            "robot",
            cure="connect them with a joint, or remove all but one",
        )
    reached = set(roots)
    children: dict[str, list[str]] = {}
    for joint in tree.joints.values():
        children.setdefault(parent_of(joint), []).append(child_of(joint))
    stack = list(roots)
    while stack:
        for child in children.get(stack.pop(), []):
            reached.add(child)
            stack.append(child)
    left = [name for name in tree.links if name not in reached]
    if left:
        raise tree.error(
            f"links in a circle: {', '.join(left[:4])}",
            "robot",
            cure="open it at one joint and close the loop in the sidecar under `loops`",
        )


def _numbers(tree: Tree, top: Element) -> None:
    for element in top.iter():
        for key in NEEDED.get(element.tag, ()):
            if element.get(key) is None:
                raise tree.error(f"<{element.tag}> has no {key}", label(top), cure="state it")
        for key, text in element.attrib.items():
            count = COUNTS.get((element.tag, key))
            if count is None:
                continue
            where = f"<{element.tag} {key}>"
            parts = text.split()
            try:
                values = [float(part) for part in parts]
            except ValueError:
                raise tree.error(f"{where} is not a number", label(top), text, "give plain numbers") from None
            if not all(map(_PLAIN.fullmatch, parts)):  # 1_000 or other digits, which only Python reads
                raise tree.error(f"{where} is not a plain number", label(top), text, "write 0 to 9 only")
            if any(math.isnan(v) or (math.isinf(v) and element.tag not in _MAY_BE_INFINITE) for v in values):
                raise tree.error(f"{where} is not finite", label(top), text, "give finite numbers")
            if element.tag not in _MAY_BE_INFINITE and any(abs(v) > HUGE for v in values):
                raise tree.error(f"{where} is too large to be meant", label(top), text, "give SI units")
            if len(values) != count:
                raise tree.error(
                    f"{where} needs {count} number{'s' * (count > 1)}", label(top), text, "mend it"
                )


def _axis(tree: Tree, name: str, joint: Element) -> None:
    axis = joint.find("axis")
    if axis is None or joint.get("type") not in MOVING:
        return
    xyz = [float(v) for v in axis.get("xyz", "1 0 0").split()]
    if math.hypot(*xyz) < 1e-9:
        raise tree.error(
            "a zero axis", f"joint {name}", axis.get("xyz"), "give the direction it moves about or along"
        )


def _inertia(tree: Tree, name: str, link: Element) -> None:
    """Mass and moments that are not negative.

    Raises:
        DescriptionError: one that is.
    """
    mass = link.find("inertial/mass")
    if mass is not None and float(mass.get("value", 0)) < 0:
        raise tree.error("negative mass", f"link {name}", mass.get("value"), "give its mass in kg")
    found = link.find("inertial/inertia")
    for key in () if found is None else ("ixx", "iyy", "izz"):
        if float(found.get(key, 0)) < -ROUNDING:
            raise tree.error(
                f"negative moment of inertia {key}",
                f"link {name}",
                found.get(key),
                "give moments about the centre of mass in kg m2",
            )
