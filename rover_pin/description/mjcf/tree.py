"""Bodies and joints of an MJCF file as URDF."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pinocchio as pin

from rover_pin.description.mjcf.geoms import Geom, geoms_of, inertia_of
from rover_pin.description.mjcf.reading import Element, Source, unit
from rover_pin.description.notes import Notes
from rover_pin.description.tree import written
from rover_pin.numerics import Array

_TYPES = {"hinge": "revolute", "slide": "prismatic"}


def body_name(source: Source, body: Element) -> str:
    """A body's name; `body_3`, by its place in the file, where it has none."""
    return str(body.get("name") or f"body_{source.places[body]}")


def joint_name(source: Source, joint: Element) -> str:
    """A joint's name; its body's, and its place there, where it has none."""
    own = joint.get("name")
    if own:
        return str(own)
    body = joint.getparent()
    return f"{body_name(source, body)}_joint_{body.findall('joint').index(joint)}"


def robot_of(source: Source, notes: Notes | None = None) -> Element:
    """The body of the world that is the robot: the only one, or the only one that moves.

    Raises:
        DescriptionError: none, or several.
    """
    bodies = [b for world in source.root.iterfind("worldbody") for b in world.iterfind("body")]
    moving = [b for b in bodies if next(b.iter("joint", "freejoint"), None) is not None]
    chosen = moving if len(bodies) > 1 else bodies
    if len(chosen) != 1:
        world = next(iter(source.root.iterfind("worldbody")), source.root)
        what = "no body" if not bodies else f"{len(chosen)} bodies that move, or none of several"
        names = ", ".join(body_name(source, b) for b in bodies) or None
        raise source.error(f"{what} in the world; a robot is one", world, names, "leave one in the file")
    if notes is not None:
        dropped = [body_name(source, b) for b in bodies if b is not chosen[0]]
        notes.many(dropped, "body {name} of the world does not move: dropped", "{n} bodies dropped ({names})")
    return chosen[0]


def urdf_of(source: Source, notes: Notes) -> str:
    """The URDF text.

    Raises:
        DescriptionError: what cannot be said in it.
    """
    from lxml import etree

    robot = etree.Element("robot", name=str(source.root.get("model") or source.path.stem))
    body = robot_of(source, notes)
    if any(_kind(source, j) != "free" for j in body.iterfind("joint")):
        etree.SubElement(robot, "link", name="world")  # a base that stands on joints of its own
        _add_body(source, robot, body, "world", notes)
    else:
        _add_link(source, robot, body)
        for child in body.iterfind("body"):
            _add_body(source, robot, child, body_name(source, body), notes)
    for k, actuator in enumerate(a for group in source.root.iterfind("actuator") for a in group):
        driven = source.get(actuator, "joint")
        if driven is None:
            notes.add(f"actuator {actuator.get('name') or k} drives no joint: dropped")
            continue
        transmission = etree.SubElement(robot, "transmission", name=f"{actuator.get('name') or k}")
        etree.SubElement(transmission, "joint", name=driven)
    return str(etree.tostring(robot, pretty_print=True, encoding="unicode"))


def _kind(source: Source, joint: Element) -> str:
    return source.get(joint, "type", "hinge") or "hinge"


def _add_body(source: Source, robot: Any, body: Element, above: str, notes: Notes) -> None:
    """A body below link `above`, one link a joint; the last is the body's own if it stands at the joint."""
    from lxml import etree

    name, placed = body_name(source, body), source.placed(body)
    if body.find("freejoint") is not None:
        raise source.error("a free joint inside the robot", body, name, "only the base floats")
    steps = list(_steps(source, body, notes))
    for k, (joint, kind, axis, anchor, limits) in enumerate(steps):
        last = k == len(steps) - 1 and not anchor.any()
        below = name if last else f"{joint}_link"
        _add_joint(robot, joint, kind, above, below, placed * pin.SE3(np.eye(3), anchor), axis, limits)
        if not last:
            etree.SubElement(robot, "link", name=below)
        above, placed = below, pin.SE3(np.eye(3), -anchor)
    if above != name:
        _add_joint(robot, f"{name}_fixed", "fixed", above, name, placed, None, None)
    _add_link(source, robot, body)
    for child in body.iterfind("body"):
        _add_body(source, robot, child, name, notes)


Step = tuple[str, str, Array, Array, "tuple[float, float] | None"]


def _steps(source: Source, body: Element, notes: Notes) -> Iterator[Step]:
    """Name, URDF type, axis, anchor in the body's frame, limits of each joint of a body."""
    for joint in body.iterfind("joint"):
        name, kind = joint_name(source, joint), _kind(source, joint)
        anchor = np.array(source.numbers(joint, "pos", "0 0 0", 3))
        if kind == "free":
            raise source.error("a free joint inside the robot", joint, name, "only the base floats")
        if kind == "ball":
            notes.add(f"joint {name}: a ball, taken as three hinges {name}_X, {name}_Y, {name}_Z")
            for k, letter in enumerate("XYZ"):
                yield f"{name}_{letter}", "continuous", np.eye(3)[k], anchor, None
            continue
        if kind not in _TYPES:
            raise source.error("unknown type of joint", joint, kind, "use hinge, slide, ball or free")
        axis = unit(np.array(source.numbers(joint, "axis", "0 0 1", 3)))
        if not axis.any():
            raise source.error("a zero axis", joint, cure="give the direction it moves about or along")
        limits = _limits(source, joint, kind, notes)
        continuous = kind == "hinge" and limits is None
        yield name, "continuous" if continuous else _TYPES[kind], axis, anchor, limits


def reference(source: Source, joint: Element) -> float:
    """`ref` of a joint, rad or m: its value where the file shows it; joints count from there."""
    value = source.numbers(joint, "ref", "0", 1)[0]
    return source.angle(value) if _kind(source, joint) == "hinge" else value


def _limits(source: Source, joint: Element, kind: str, notes: Notes) -> tuple[float, float] | None:
    limited = source.get(joint, "limited", "auto")
    span = source.numbers(joint, "range")
    automatic = source.compiler.get("autolimits", "true") == "true"
    ref = reference(source, joint)
    if ref != 0.0:
        notes.add(f"joint {joint_name(source, joint)}: its values count from its ref, {ref:g}")
    if len(span) != 2 or limited == "false" or (limited == "auto" and not automatic):
        return None
    low, high = (source.angle(v) if kind == "hinge" else v for v in span)
    return low - ref, high - ref


def _add_joint(
    robot: Any,
    name: str,
    kind: str,
    above: str,
    below: str,
    placed: pin.SE3,
    axis: Array | None,
    limits: tuple[float, float] | None,
) -> None:
    from lxml import etree

    joint = etree.SubElement(robot, "joint", name=name, type=kind)
    rpy = pin.rpy.matrixToRpy(placed.rotation)
    etree.SubElement(joint, "origin", xyz=written(placed.translation), rpy=written(rpy))
    etree.SubElement(joint, "parent", link=above)
    etree.SubElement(joint, "child", link=below)
    if axis is not None:
        etree.SubElement(joint, "axis", xyz=written(axis))
    if limits is not None:
        etree.SubElement(joint, "limit", lower=repr(limits[0]), upper=repr(limits[1]))


def _add_link(source: Source, robot: Any, body: Element) -> None:
    from lxml import etree

    link = etree.SubElement(robot, "link", name=body_name(source, body))
    geoms = geoms_of(source, body)
    inertia = _inertia(source, body, geoms)
    if inertia.mass > 0:
        inertial = etree.SubElement(link, "inertial")
        etree.SubElement(inertial, "origin", xyz=written(inertia.lever))
        etree.SubElement(inertial, "mass", value=repr(float(inertia.mass)))
        m = inertia.inertia
        moments = (m[0, 0], m[0, 1], m[0, 2], m[1, 1], m[1, 2], m[2, 2])
        keys = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
        etree.SubElement(inertial, "inertia", {k: repr(float(v)) for k, v in zip(keys, moments, strict=True)})
    for geom in geoms:
        for tag in ("visual", "collision") if geom.touches else ("visual",):
            _add_shape(link, tag, geom)


def _inertia(source: Source, body: Element, geoms: list[Geom]) -> pin.Inertia:
    stated = body.find("inertial")
    if stated is None or source.compiler.get("inertiafromgeom") == "true":
        total = pin.Inertia.Zero()
        for geom in geoms:
            total = total + inertia_of(source, geom)
        return total
    mass = source.numbers(stated, "mass", "0", 1)[0]
    if mass < 0:
        raise source.error("negative mass", stated, mass, "give its mass in kg")
    full = source.numbers(stated, "fullinertia")
    if full:
        xx, yy, zz, xy, xz, yz = source.numbers(stated, "fullinertia", count=6)
        tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    else:
        tensor = np.diag(source.numbers(stated, "diaginertia", "0 0 0", 3))
    return source.placed(stated).act(pin.Inertia(mass, np.zeros(3), tensor))


def _add_shape(link: Any, tag: str, geom: Geom) -> None:
    """A capsule as its tube; an ellipsoid, which URDF has not, as the largest ball inside it."""
    from lxml import etree

    if geom.kind == "mesh" and geom.mesh is None:
        return
    element = etree.SubElement(link, tag)
    rpy = pin.rpy.matrixToRpy(geom.placed.rotation)
    etree.SubElement(element, "origin", xyz=written(geom.placed.translation), rpy=written(rpy))
    shape = etree.SubElement(element, "geometry")
    if geom.kind == "box":
        etree.SubElement(shape, "box", size=written(2 * np.array(geom.size)))
    elif geom.kind in ("cylinder", "capsule"):
        etree.SubElement(shape, "cylinder", radius=repr(geom.size[0]), length=repr(2 * geom.size[1]))
    elif geom.kind == "mesh":
        etree.SubElement(shape, "mesh", filename=f"file://{geom.mesh}", scale=written(geom.size))
    else:
        etree.SubElement(shape, "sphere", radius=repr(min(geom.size)))
