"""Which links may be wheels or feet: by their shapes, their joints, their names."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

import numpy as np

from rover_pin.description.geometry import LinkShape
from rover_pin.description.starter.subject import Guess, Subject, flow
from rover_pin.numerics import Array

WHEEL = re.compile(r"wheel|tire|tyre|roue|ruota|rueda", re.IGNORECASE)
FOOT = re.compile(r"foot(?!print)|feet|toe(?![a-z])|caster|castor", re.IGNORECASE)
ROUND = 0.03  # by how much a wheel's mesh may be wider one way than the other
OFF_AXIS = 0.005  # m from a shape's centre to the joint's axis
LEVEL = 0.2  # sine of the slope that a wheel's axis may have at zero
SAME_HEIGHT = 0.5  # of its radius, by which an unnamed wheel may hang above the lowest


@dataclass(frozen=True)
class Round:
    """A round shape about an axis, in its link's frame (m)."""

    radius: float
    width: float
    center: Array
    axis: Array
    what: str


def guess_wheels(subject: Subject) -> tuple[list[Guess], list[str]]:
    """Wheels, and what to say of links that are named like wheels but tell no radius."""
    found: list[tuple[str, Round, list[str]]] = []
    mute: list[str] = []
    for link in subject.made.tree.links:
        joint = subject.made.tree.joint_above(link)
        turns = joint is not None and joint in subject.made.turning_axes() and joint in subject.rover.joints
        named = WHEEL.search(link) or (joint is not None and WHEEL.search(joint))
        endless = turns and joint is not None and _endless(subject, joint)
        if not (named or endless):
            continue
        own = subject.made.turning_axes()[joint] if turns and joint is not None else None
        shape = next((r for s in subject.shapes.get(link, ()) if (r := _round(subject, s, own))), None)
        if shape is None:
            if named and subject.shapes.get(link):
                mute.append(link)
            continue
        turned = subject.frame(link).rotation @ shape.axis
        if abs(turned[2]) > LEVEL:
            continue
        reasons = [*(["turns without end"] if endless else []), *(["its name"] if named else []), shape.what]
        found.append((link, shape, reasons))
    return [_as_guess(subject, *each) for each in _standing(subject, found, bool(mute))], mute


def guess_feet(subject: Subject, wheels: list[Guess]) -> tuple[list[Guess], list[str]]:
    """Ball feet: links named like feet or casters with a sphere, no wheels; else those without one."""
    taken = {guess.link for guess in wheels}
    guesses, flat = [], []
    for link in subject.made.tree.links:
        shapes = subject.shapes.get(link, ())
        if not (FOOT.search(link) or WHEEL.search(link)) or link in taken:
            continue
        ball = next((s for s in shapes if s.kind == "sphere"), None)
        if ball is not None:
            center = _in_link(subject, ball)[:3, 3]
            said = {
                "frame": link,
                "center": center.tolist(),
                "radius": ball.size[0],
                **_friction(subject, link),
            }
            guesses.append(Guess("contacts", flow(said), "its name, and a sphere", link))
        elif FOOT.search(link):
            flat.append(link)
    return guesses, [] if wheels or guesses else flat


def _endless(subject: Subject, joint: str) -> bool:
    limits = subject.made.limits[joint]
    return joint in subject.made.continuous or limits.upper - limits.lower > 6.0 * np.pi


def _standing(
    subject: Subject, found: list[tuple[str, Round, list[str]]], mute: bool
) -> list[tuple[str, Round, list[str]]]:
    """Those named so; where no link is, those as low as the lowest."""
    named = [each for each in found if "its name" in each[2]]
    if named or mute or not found:
        return named

    def bottom(link: str, shape: Round) -> float:
        return float(subject.frame(link).act(shape.center)[2]) - shape.radius

    lowest = min(bottom(link, shape) for link, shape, _ in found)
    return [each for each in found if bottom(each[0], each[1]) < lowest + SAME_HEIGHT * each[1].radius]


def _as_guess(subject: Subject, link: str, shape: Round, reasons: list[str]) -> Guess:
    said: dict[str, object] = {"frame": link}
    joint = subject.made.tree.joint_above(link)
    own = subject.made.turning_axes().get(joint or "")
    if own is None or np.linalg.norm(np.cross(own, shape.axis)) > 1e-6 or joint not in subject.rover.joints:
        said["axis"] = shape.axis.tolist()
    if np.abs(shape.center).max() > 1e-6:
        said["center"] = shape.center.tolist()
    said |= {"radius": shape.radius, "width": shape.width, **_friction(subject, link)}
    return Guess("wheels", flow(said), ", ".join(reasons), link)


def _friction(subject: Subject, link: str) -> dict[str, object]:
    stated = subject.friction(link)
    return {} if stated is None else {"friction": stated}


def _in_link(subject: Subject, shape: LinkShape) -> Array:
    """(4, 4) of a shape in its link's frame."""
    model = subject.rover.model
    own = next(f for f in model.frames if f.name == shape.link and f.parentJoint == shape.joint)
    placed: Array = np.linalg.inv(own.placement.homogeneous) @ shape.placement
    return placed


def _round(subject: Subject, shape: LinkShape, axis: Array | None) -> Round | None:
    """The wheel that a shape may be: about the joint's axis where it turns, else about its own."""
    placed = _in_link(subject, shape)
    if shape.kind == "cylinder":
        own, radius, width = placed[:3, 2], shape.size[0], shape.size[1]
        if axis is not None and np.linalg.norm(np.cross(own, axis)) > 1e-3:
            return None
        return _centred(
            Round(radius, width, placed[:3, 3], own if axis is None else axis, "a cylinder"), axis
        )
    if shape.kind == "sphere" and axis is not None:
        return _centred(Round(shape.size[0], 2 * shape.size[0], placed[:3, 3], axis, "a sphere"), axis)
    if shape.kind == "mesh" and axis is not None:
        return _of_mesh(subject, shape, placed, axis)
    return None


def _centred(shape: Round, axis: Array | None) -> Round | None:
    """The shape with its centre on the joint's axis, None where it is far from it."""
    if axis is None:
        return shape
    along = float(axis @ shape.center)
    if np.linalg.norm(shape.center - along * axis) > OFF_AXIS:
        return None
    return Round(shape.radius, shape.width, along * axis, axis, shape.what)


def _of_mesh(subject: Subject, shape: LinkShape, placed: Array, axis: Array) -> Round | None:
    import trimesh

    path = subject.mesh(shape.address)
    if path is None:
        return None
    try:
        mesh: Any = trimesh.load(path, force="mesh")
        corners = np.asarray(mesh.vertices) * np.array(shape.size)
    except Exception:  # trimesh raises whatever a damaged mesh or a missing reader makes it raise
        return None
    if len(corners) < 8:
        return None
    points = corners @ placed[:3, :3].T + placed[:3, 3]
    helper = np.eye(3)[int(np.argmin(np.abs(axis)))]
    first = np.cross(axis, helper) / np.linalg.norm(np.cross(axis, helper))
    across = points @ np.column_stack([first, np.cross(axis, first)])
    low, high = across.min(axis=0), across.max(axis=0)
    spans = high - low
    if (
        spans.min() <= 0
        or spans.max() / spans.min() > 1 + ROUND
        or np.abs(low + high).max() > ROUND * spans.max()
    ):
        return None
    along = points @ axis
    middle = float(along.min() + along.max()) / 2
    radius = float(np.linalg.norm(across, axis=1).max())
    return Round(radius, float(np.ptp(along)), middle * axis, axis, f"the round mesh {path.name}")
