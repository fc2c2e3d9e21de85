"""From a URDF as people write it to one that Pinocchio reads as it is meant."""

from __future__ import annotations

import copy
import math
from collections.abc import Mapping

import numpy as np
import pinocchio as pin

from rover_pin.description.limits import Limits, read_limits
from rover_pin.description.notes import Notes
from rover_pin.description.specs import FreeSpec, InertialSpec
from rover_pin.description.tree import MOVING, Element, Tree, child_of, numbers, parent_of, written
from rover_pin.errors import SidecarError, nearest

BASE = "rover_base"  # name of the link put above the root where `up` is not z


def free_joints(tree: Tree, free: Mapping[str, FreeSpec], file: object) -> None:
    """Let joints move that the URDF fixes.

    Raises:
        SidecarError: no such joint, or one that moves already.
    """
    from lxml import etree

    for name, spec in free.items():
        joint = tree.joints.get(name)
        if joint is None:
            raise SidecarError(
                "no such joint", file=file, element=f"free.{name}", cure=nearest(name, tree.joints)
            )
        if joint.get("type") != "fixed":
            raise SidecarError(
                "the URDF does not fix this joint",
                file=file,
                element=f"free.{name}",
                value=joint.get("type"),
                cure="remove it from `free`",
            )
        joint.set("type", spec.type)
        for tag in ("axis", "limit"):
            for old in joint.findall(tag):
                joint.remove(old)
        etree.SubElement(joint, "axis", xyz=written(spec.axis))
        if spec.limits is not None:
            etree.SubElement(joint, "limit", lower=repr(spec.limits[0]), upper=repr(spec.limits[1]))


def override_inertials(tree: Tree, inertials: Mapping[str, InertialSpec], file: object) -> None:
    """Put the sidecar's mass properties in place of the URDF's.

    Raises:
        SidecarError: no such link.
    """
    from lxml import etree

    for name, spec in inertials.items():
        link = tree.links.get(name)
        if link is None:
            raise SidecarError(
                "no such link", file=file, element=f"inertials.{name}", cure=nearest(name, tree.links)
            )
        for old in link.findall("inertial"):
            link.remove(old)
        inertial = etree.SubElement(link, "inertial")
        etree.SubElement(inertial, "origin", xyz=written(spec.com))
        etree.SubElement(inertial, "mass", value=repr(spec.mass))
        keys = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
        etree.SubElement(inertial, "inertia", dict(zip(keys, map(repr, spec.inertia), strict=True)))


def drop_floating_root(tree: Tree, notes: Notes) -> None:
    """A floating joint under the root is the base: the link above it goes.

    Raises:
        DescriptionError: a floating joint elsewhere, a second one, or one that shares the root link.
    """
    floating = [n for n, j in tree.joints.items() if j.get("type") == "floating"]
    if not floating:
        return
    root = tree.root
    under = [n for n, j in tree.joints.items() if parent_of(j) == root]
    first = next((n for n in floating if n in under), None)
    if first is None or len(floating) > 1:
        other = next(n for n in floating if n != first)
        raise tree.error(
            "a floating joint inside the robot; only the base floats",
            f"joint {other}",
            cure="fix it, or give it an axis",
        )
    if len(under) > 1:
        raise tree.error(
            f"a floating joint, but link {root} above it carries other joints",
            f"joint {first}",
            cure="hang nothing else on that link",
        )
    mass = tree.links[root].find("inertial/mass")
    lost = (
        ""
        if mass is None or float(mass.get("value", 0)) == 0
        else f", its {float(mass.get('value')):g} kg too"
    )
    notes.add(f"joint {first}: a floating root of its own taken as the base; link {root} dropped{lost}")
    tree.robot.remove(tree.joints[first])
    tree.robot.remove(tree.links[root])
    tree.refresh()


def settle_joints(tree: Tree, notes: Notes) -> tuple[dict[str, Limits], dict[str, float]]:
    """Unit axes, limits, locks; `continuous` becomes `revolute` so that q stays a plain vector.

    A joint whose limits are closer than 1e-6 becomes a fixed joint at their middle.

    Returns:
        The limits of every moving joint, and where the others are held.

    Raises:
        DescriptionError: limits that contradict themselves.
    """
    from lxml import etree

    limits: dict[str, Limits] = {}
    held: dict[str, float] = {}
    for name, joint in tree.joints.items():
        if joint.get("type") not in MOVING:
            continue
        axis = _unit_axis(joint, name, notes)
        found = read_limits(tree, name, joint, notes)
        for tag in ("axis", "limit"):
            for old in joint.findall(tag):
                joint.remove(old)
        if found.locks:
            held[name] = (found.lower + found.upper) / 2
            notes.add(f"joint {name}: limits {found.lower:g}, {found.upper:g} lock it there; taken as fixed")
            _fix(joint, axis, held[name])
            continue
        limits[name] = found
        if joint.get("type") == "continuous":
            joint.set("type", "revolute")
        etree.SubElement(joint, "axis", xyz=written(axis))
        etree.SubElement(joint, "limit", lower="-1e30", upper="1e30", effort="1e30", velocity="1e30")
    return limits, held


def _unit_axis(joint: Element, name: str, notes: Notes) -> list[float]:
    element = joint.find("axis")
    if element is None:
        notes.add(f"joint {name}: no axis stated, x taken as URDF says")
        return [1.0, 0.0, 0.0]
    axis = numbers(element.get("xyz", "1 0 0"))
    length = math.hypot(*axis)
    return axis if length == 1.0 else [v / length for v in axis]


def _fix(joint: Element, axis: list[float], value: float) -> None:
    """Make a joint fixed at `value`, by moving its origin."""
    from lxml import etree

    origin = joint.find("origin")
    if origin is None:
        origin = etree.SubElement(joint, "origin")
    xyz, rpy = (np.array(numbers(origin.get(key, "0 0 0"))) for key in ("xyz", "rpy"))
    rotation = pin.rpy.rpyToMatrix(*rpy)
    if joint.get("type") == "prismatic":
        xyz = xyz + rotation @ np.array(axis) * value
    else:
        rotation = rotation @ pin.exp3(np.array(axis) * value)
    origin.set("xyz", written(xyz))
    origin.set("rpy", written(pin.rpy.matrixToRpy(rotation)))
    joint.set("type", "fixed")


def turn_up(tree: Tree, up: tuple[float, float, float]) -> None:
    """Put a link above the root, turned by the shortest rotation that takes `up` to z."""
    from lxml import etree

    direction = np.array(up) / math.hypot(*up)
    z = np.array([0.0, 0.0, 1.0])
    if np.allclose(direction, z, atol=1e-15):
        return
    opposite = np.allclose(direction, -z, atol=1e-12)
    rotation = (
        np.diag([1.0, -1.0, -1.0])
        if opposite
        else pin.Quaternion.FromTwoVectors(direction, z).toRotationMatrix()
    )
    root, base = tree.root, BASE
    while base in tree.links or base in tree.joints:
        base = f"_{base}"
    etree.SubElement(tree.robot, "link", name=base)
    joint = etree.SubElement(tree.robot, "joint", name=base, type="fixed")
    etree.SubElement(joint, "origin", xyz="0 0 0", rpy=written(pin.rpy.matrixToRpy(rotation)))
    etree.SubElement(joint, "parent", link=base)
    etree.SubElement(joint, "child", link=root)
    tree.refresh()


def bare_text(tree: Tree) -> str:
    """The URDF text for Pinocchio: names, joints and inertias, without shapes and foreign tags."""
    from lxml import etree

    robot = etree.Element("robot", name=tree.name or "rover")
    for link in tree.links.values():
        bare = etree.SubElement(robot, "link", name=link.get("name"))
        inertial = link.find("inertial")
        if inertial is not None:
            bare.append(_whole(inertial))
    for name, joint in tree.joints.items():
        bare = etree.SubElement(robot, "joint", name=name, type=joint.get("type"))
        for tag in ("origin", "axis", "limit"):
            found = joint.find(tag)
            if found is not None:
                bare.append(copy.deepcopy(found))
        etree.SubElement(bare, "parent", link=parent_of(joint))
        etree.SubElement(bare, "child", link=child_of(joint))
    return str(etree.tostring(robot, pretty_print=True, encoding="unicode"))


def _whole(inertial: Element) -> Element:
    """A copy with mass and every moment stated: Pinocchio drops a link's inertia where one is missing."""
    from lxml import etree

    full = copy.deepcopy(inertial)
    if full.find("mass") is None:
        etree.SubElement(full, "mass", value="0")
    moments = full.find("inertia")
    if moments is None:
        moments = etree.SubElement(full, "inertia")
    for key in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"):
        moments.set(key, moments.get(key, "0"))
    return full
