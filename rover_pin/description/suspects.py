"""What a reader of a URDF should be told of.

Masses that are missing, loops that only Gazebo knows, wheels that are not declared.
"""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from rover_pin.description.notes import Notes
from rover_pin.description.tree import MOVING, Element, Tree, child_of
from rover_pin.errors import DescriptionError
from rover_pin.numerics import Array


def tell_masses(tree: Tree, notes: Notes) -> None:
    """Missing inertials and zero masses of links that move or have a shape; pure frames are no matter.

    Raises:
        DescriptionError: no link has any mass.
    """
    missing: list[str] = []
    zero: list[str] = []
    for name, link in tree.links.items():
        mass = link.find("inertial/mass")
        if mass is not None and float(mass.get("value", 0)) > 0:
            continue
        if _has_body(tree, name, link):
            (missing if mass is None else zero).append(name)
    if all(_mass(link) == 0.0 for link in tree.links.values()):
        raise DescriptionError(
            "the robot has no mass",
            file=tree.file,
            cure="give its links <inertial>, or masses under `inertials` in the sidecar",
        )
    notes.many(
        missing, "link {name} has no inertial: no mass", "{n} links have no inertial: no mass ({names})"
    )
    notes.many(zero, "link {name} has zero mass", "{n} links have zero mass ({names})")


def tell_inertias(tree: Tree, notes: Notes) -> None:
    """Inertias that no body has: a negative principal moment, or one larger than the sum of the others."""
    for name, link in tree.links.items():
        found = link.find("inertial/inertia")
        if found is None:
            continue
        moments = np.linalg.eigvalsh(_tensor(found))
        slack = 1e-6 * max(float(np.abs(moments).max()), 1e-12)
        if moments[0] < -slack or moments[2] > moments[0] + moments[1] + slack:
            notes.each(
                name,
                "link {name} has an inertia that no body can have (statics do not use it)",
                "{n} links have inertias that no body can have ({names}; statics do not use them)",
            )


def _tensor(element: Element) -> Array:
    """(3, 3) of an `<inertia>` element, kg m2."""
    xx, xy, xz, yy, yz, zz = (float(element.get(k, 0)) for k in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"))
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def _mass(link: Element) -> float:
    mass = link.find("inertial/mass")
    return 0.0 if mass is None else float(mass.get("value", 0))


def _has_body(tree: Tree, name: str, link: Element) -> bool:
    if link.find("visual") is not None or link.find("collision") is not None:
        return True
    above = tree.joint_above(name)
    return above is not None and tree.joints[above].get("type") in MOVING


def tell_gazebo_loops(tree: Tree, notes: Notes) -> None:
    """Joints that stand only in `<gazebo>` tags: there they close loops, here they are not seen."""
    for joint in tree.robot.iterfind("gazebo//joint"):
        parent, child = joint.find("parent"), joint.find("child")
        if parent is None or child is None:
            continue
        ends = " to ".join((e.text or "").strip() or "?" for e in (parent, child))
        notes.add(
            f"loop {joint.get('name')} ({ends}) stands only in a <gazebo> tag: dropped; "
            "declare it under `loops`"
        )


def tell_dynamics(tree: Tree, notes: Notes) -> None:
    """Damping and dry friction of joints, which a rover at rest is not given."""
    names = [
        name
        for name, joint in tree.joints.items()
        if any(
            float(d.get(key) or 0) != 0 for d in joint.findall("dynamics") for key in ("damping", "friction")
        )
    ]
    notes.many(
        names,
        "joint {name}: damping and friction are not used",
        "damping and friction of {n} joints are not used ({names})",
    )


def continuous_joints(tree: Tree) -> frozenset[str]:
    """Names of the joints that turn without end."""
    return frozenset(name for name, joint in tree.joints.items() if joint.get("type") == "continuous")


def tell_undeclared_wheels(
    tree: Tree, continuous: Collection[str], declared: Collection[str], notes: Notes
) -> None:
    """Links that look like wheels and are not declared: named so, and on a continuous joint."""
    looks = [
        child_of(tree.joints[name])
        for name in tree.joints
        if name in continuous and "wheel" in child_of(tree.joints[name]).lower()
    ]
    notes.many(
        [link for link in looks if link not in declared],
        "link {name} looks like a wheel and is not declared; list it under `wheels` in the sidecar",
        "{n} links look like wheels and are not declared ({names}); list them under `wheels` in the sidecar",
    )
