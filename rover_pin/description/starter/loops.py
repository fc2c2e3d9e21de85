"""Loops that stand in `<gazebo>` tags: SDF joints between links that the tree connects otherwise."""

from __future__ import annotations

from typing import Any

from rover_pin.description.starter.subject import Guess, Subject, flow
from rover_pin.description.tree import numbers

_TYPES = {"revolute": "hinge", "continuous": "hinge", "ball": "ball", "universal": "ball", "fixed": "weld"}


def guess_loops(subject: Subject) -> tuple[list[Guess], list[str]]:
    """Loops, and what to say of joints that none can be made of.

    An SDF joint stands at its `<pose>` in the child link, its `<axis>` in its own frame; where the other link
    is there at zero is kept (`at: zero`).
    """
    guesses, mute = [], []
    for joint in subject.stated.robot.iterfind("gazebo//joint"):
        name = str(joint.get("name"))
        ends = [(joint.findtext(tag) or "").strip() for tag in ("child", "parent")]
        kind = _TYPES.get(str(joint.get("type")))
        if not any(ends):
            continue  # the name of a joint for a plugin, no joint
        if kind is None or any(end not in subject.made.tree.links for end in ends):
            mute.append(
                f"joint {name} ({' to '.join(ends)}, {joint.get('type')}) of a <gazebo> tag is no loop here"
            )
            continue
        try:
            said = _loop(joint, name, kind, ends)
        except ValueError:
            mute.append(f"joint {name} of a <gazebo> tag: its pose or axis is no list of numbers")
            continue
        guesses.append(
            Guess("loops", flow(said), f"joint {name} of a <gazebo> tag, type {joint.get('type')}")
        )
    return guesses, mute


def _loop(joint: Any, name: str, kind: str, ends: list[str]) -> dict[str, object]:
    pose = numbers(joint.findtext("pose") or "0 0 0 0 0 0")
    frame: dict[str, object] = {"link": ends[0]}
    if any(pose[:3]):
        frame["xyz"] = pose[:3]
    if any(pose[3:]):
        frame["rpy"] = pose[3:]
    said: dict[str, object] = {"name": name, "frames": [frame, ends[1]], "type": kind}
    if kind == "hinge":
        said["axis"] = numbers(joint.findtext("axis/xyz") or "0 0 1")
    return {**said, "at": "zero"}
