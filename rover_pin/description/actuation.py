"""Which joints are driven: the sidecar's word, else the URDF's, else a guess that is told."""

from __future__ import annotations

from collections.abc import Sequence

from rover_pin.description.notes import Notes
from rover_pin.description.tree import Tree
from rover_pin.errors import SidecarError, nearest


def actuated_joints(
    tree: Tree,
    joints: Sequence[str],
    actuated: Sequence[str] | None,
    passive: Sequence[str] | None,
    above_wheels: Sequence[str],
    notes: Notes,
    file: object,
    idle: Sequence[str] = (),
) -> tuple[str, ...]:
    """The driven joints, in the order of `joints`.

    Args:
        tree: the URDF with its foreign tags.
        joints: all moving joints.
        actuated: the sidecar's list, or None.
        passive: the sidecar's other way to say it, or None.
        above_wheels: continuous joints directly above a declared wheel.
        notes: told of what was dropped or guessed.
        file: the sidecar, named in errors.
        idle: joints that an SRDF calls passive; where the URDF does not say what is driven, all others are.

    Raises:
        SidecarError: both lists, or a name that is no moving joint.
    """
    if actuated is not None and passive is not None:
        raise SidecarError(
            "both `actuated` and `passive` are given", file=file, cure="keep one: the rest follows"
        )
    for key, names in (("actuated", actuated), ("passive", passive)):
        for i, name in enumerate(names or ()):
            _known(name, joints, tree, f"{key}[{i}]", file)
    if actuated is not None:
        return _ordered(joints, set(actuated))
    if passive is not None:
        return _ordered(joints, set(joints) - set(passive))
    for source, found in (("<ros2_control>", _ros2_control(tree)), ("<transmission>", _transmissions(tree))):
        if found:
            gone = [name for name in found if name not in joints]
            notes.many(
                gone,
                f"{source} drives {{name}}, which does not move: dropped",
                f"{source} drives {{n}} joints that do not move: dropped ({{names}})",
            )
            return _ordered(joints, set(found) - set(idle))
    if idle:
        return _ordered(joints, set(joints) - set(idle))
    if above_wheels:
        notes.add(f"nothing says what is driven: taken the wheels' own joints ({', '.join(above_wheels)})")
    elif joints:
        notes.add(
            "nothing says what is driven: every joint is taken as passive; declare `actuated` in the sidecar"
        )
    return _ordered(joints, set(above_wheels))


def _known(name: str, joints: Sequence[str], tree: Tree, element: str, file: object) -> None:
    if name in joints:
        return
    if name in tree.joints:
        raise SidecarError(
            "this joint is fixed", file=file, element=element, value=name, cure="free it or drop it here"
        )
    raise SidecarError("no such joint", file=file, element=element, value=name, cure=nearest(name, joints))


def _ordered(joints: Sequence[str], chosen: set[str]) -> tuple[str, ...]:
    return tuple(name for name in joints if name in chosen)


def _ros2_control(tree: Tree) -> list[str]:
    return [
        joint.get("name", "")
        for joint in tree.robot.iterfind("ros2_control/joint")
        if joint.find("command_interface") is not None
    ]


def _transmissions(tree: Tree) -> list[str]:
    """Joints of `<transmission>`: named by an attribute or, in old files, by the text."""
    names = []
    for joint in tree.robot.iterfind("transmission/joint"):
        names.append(str(joint.get("name") or (joint.text or "").strip()))
    return names
