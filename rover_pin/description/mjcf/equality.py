"""Equalities and joint springs of an MJCF file in the words of a sidecar."""

from __future__ import annotations

from typing import Any

import numpy as np
import pinocchio as pin
import yaml

from rover_pin.description.mjcf.reading import Element, Source
from rover_pin.description.mjcf.tree import body_name, joint_name, reference, robot_of
from rover_pin.description.notes import Notes

Entry = dict[str, Any]


def sidecar_of(source: Source, notes: Notes) -> str:
    """YAML with `loops`, `couplings` and `springs`.

    Raises:
        DescriptionError: an equality that cannot be said: not linear, or tied to the world.
    """
    said: dict[str, list[Entry]] = {"loops": [], "couplings": [], "springs": _springs(source)}
    elements = [e for group in source.root.iterfind("equality") for e in group]
    for k, element in enumerate(elements):
        name = str(element.get("name") or f"{element.tag}_{k + 1}")
        if source.get(element, "active", "true") == "false":
            notes.add(f"equality {name} is not active: dropped")
        elif element.tag in ("connect", "weld"):
            said["loops"].append(_loop(source, element, name))
        elif element.tag in ("joint", "tendon"):
            said["couplings"].append(_coupling(source, element, name))
        else:
            notes.add(f"equality {name}: <{element.tag}> is not known here: dropped")
    dumped = yaml.safe_dump(
        {"schema": 1, **{key: each for key, each in said.items() if each}}, sort_keys=False
    )
    return str(dumped)


def _loop(source: Source, element: Element, name: str) -> Entry:
    """A `connect` is a ball, a `weld` a weld; of bodies as they stand in the file, unless sites are named."""
    kind = "ball" if element.tag == "connect" else "weld"
    if source.get(element, "site1") is not None:
        frames = [_site(source, element, key) for key in ("site1", "site2")]
        return {"name": name, "frames": frames, "type": kind}
    first, second = (_body(source, element, key) for key in ("body1", "body2"))
    relative = source.numbers(element, "relpose", "0 1 0 0 0 0 0", 7) if kind == "weld" else []
    if relative and any(relative[3:]):
        w, x, y, z = relative[3:]
        turn = pin.Quaternion(w, x, y, z).normalized().toRotationMatrix()
        return {
            "name": name,
            "frames": [_frame(first, pin.SE3(turn, np.array(relative[:3]))), second],
            "type": kind,
        }
    if kind == "weld":  # measured at the second body's origin, as MuJoCo does
        return {"name": name, "frames": [second, first], "type": kind, "at": "zero"}
    anchor = source.numbers(element, "anchor", None, 3 if source.get(element, "anchor") else None)
    if not anchor:
        raise source.error("no anchor", element, cure="give the point in body1's frame")
    place = pin.SE3(np.eye(3), np.array(anchor))
    return {"name": name, "frames": [_frame(first, place), second], "type": kind, "at": "zero"}


def _frame(link: str, placed: pin.SE3) -> Entry:
    rpy = pin.rpy.matrixToRpy(placed.rotation)
    return {"link": link, "xyz": [float(v) for v in placed.translation], "rpy": [float(v) for v in rpy]}


def _body(source: Source, element: Element, key: str) -> str:
    name = source.get(element, key)
    known = {body_name(source, b) for b in (robot_of(source), *robot_of(source).iter("body"))}
    if name is None or name not in known:
        raise source.error(
            f"{key} is no body of the robot",
            element,
            name or "the world",
            "a loop ties two bodies of the robot",
        )
    return name


def _site(source: Source, element: Element, key: str) -> Entry:
    name = source.get(element, key)
    for body in robot_of(source).iter("body"):
        for site in body.iterfind("site"):
            if site.get("name") == name:
                return _frame(body_name(source, body), source.placed(site))
    raise source.error(f"{key} is no site of the robot", element, name, "name a <site> of a body")


def _coupling(source: Source, element: Element, name: str) -> Entry:
    """y - y0 = c0 + c1 (x - x0), of joints or fixed tendons; joints count from their reference already."""
    c0, c1, *higher = (*source.numbers(element, "polycoef", "0 1 0 0 0"), 0.0, 0.0)[:5]
    if any(higher):
        raise source.error(
            "not linear", element, source.get(element, "polycoef"), "keep the first two of polycoef"
        )
    keys = [f"{element.tag}{k}" for k in (1, 2)]
    read = _joint if element.tag == "joint" else _tendon
    joints = read(source, element, keys[0])
    if source.get(element, keys[1]) is not None:
        for joint, factor in read(source, element, keys[1]).items():
            joints[joint] = joints.get(joint, 0.0) - c1 * factor
    kept = {joint: factor for joint, factor in joints.items() if factor != 0.0}
    return {"name": name, "joints": kept, "offset": float(c0)}


def _joint(source: Source, element: Element, key: str) -> dict[str, float]:
    name = source.get(element, key)
    known = {joint_name(source, j) for j in robot_of(source).iter("joint")}
    if name not in known:
        raise source.error(f"{key} is no joint of the robot", element, name, "name a <joint>")
    return {str(name): 1.0}


def _tendon(source: Source, element: Element, key: str) -> dict[str, float]:
    name = source.get(element, key)
    for tendon in source.root.iterfind("tendon/fixed"):
        if tendon.get("name") == name:
            return {str(j.get("joint")): float(j.get("coef") or 0.0) for j in tendon.iterfind("joint")}
    raise source.error(f"{key} is no fixed tendon", element, name, "name a <fixed> of <tendon>")


def _springs(source: Source) -> list[Entry]:
    """Joints with `stiffness`: torque = -stiffness (q - springref)."""
    found = []
    for joint in robot_of(source).iter("joint"):
        stiffness = source.numbers(joint, "stiffness", "0", 1)[0]
        if stiffness == 0.0 or source.get(joint, "type", "hinge") not in ("hinge", "slide"):
            continue
        rest = source.numbers(joint, "springref", "0", 1)[0]
        rest = source.angle(rest) if source.get(joint, "type", "hinge") == "hinge" else rest
        name = joint_name(source, joint)
        entry = {"name": f"spring_{name}", "joint": name, "stiffness": stiffness}
        found.append({**entry, "rest": rest - reference(source, joint)})
    return found
