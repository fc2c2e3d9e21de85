"""Joints whose type URDF cannot say: a ball, a cardan, as hinges one after the other."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from typing import Literal

from rover_pin.description.tree import Tree, child_of
from rover_pin.errors import SidecarError, nearest

Retype = Literal[
    "ball", "cardan", "cardan_xy", "cardan_xz", "cardan_yx", "cardan_yz", "cardan_zx", "cardan_zy", "fixed"
]

_AXES = {"X": "1 0 0", "Y": "0 1 0", "Z": "0 0 1"}


def refuse_unknown(tree: Tree, retype: Mapping[str, Retype], file: object) -> None:
    """Nothing where every joint is there.

    Raises:
        SidecarError: one is not.
    """
    for name in retype:
        if name not in tree.joints:
            raise SidecarError(
                "no such joint", file=file, element=f"retype.{name}", cure=nearest(name, tree.joints)
            )


def retype_joints(tree: Tree, retype: Mapping[str, Retype]) -> None:
    """Put hinges in place of a joint, in its own frame, or fix it.

    A ball is NAME_X, NAME_Y, NAME_Z, one below the other: Rx(a) Ry(b) Rz(c). A cardan is NAME_X and NAME_Y,
    `cardan_zx` NAME_Z and NAME_X. The links between are massless.
    """
    for name, kind in retype.items():
        joint = tree.joints[name]
        for tag in ("axis", "limit", "mimic", "dynamics"):
            for old in joint.findall(tag):
                joint.remove(old)
        if kind == "fixed":
            joint.set("type", "fixed")
            continue
        _split(tree, name, _letters(kind))
    tree.refresh()


def _letters(kind: Retype) -> str:
    """The axes of the hinges, from the parent's to the child's."""
    if kind == "ball":
        return "XYZ"
    return kind.removeprefix("cardan_").upper() if kind != "cardan" else "XY"


def _split(tree: Tree, name: str, letters: str) -> None:
    from lxml import etree

    joint = tree.joints[name]
    last = child_of(joint)
    place = list(tree.robot).index(joint)
    above = joint.find("parent").get("link")
    for k, letter in enumerate(letters):
        hinge = copy.deepcopy(joint)
        hinge.set("name", f"{name}_{letter}")
        hinge.set("type", "continuous")
        below = last if k == len(letters) - 1 else f"{name}_{letter}_link"
        if k:
            for old in hinge.findall("origin"):
                hinge.remove(old)
        hinge.find("parent").set("link", above)
        hinge.find("child").set("link", below)
        etree.SubElement(hinge, "axis", xyz=_AXES[letter])
        tree.robot.insert(place + k, hinge)
        if below != last:
            etree.SubElement(tree.robot, "link", name=below)
        above = below
    tree.robot.remove(joint)
