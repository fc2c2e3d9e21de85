"""What works between a rover's bodies and has no looks in its URDF: tracks and springs.

A track is drawn as the model has it: the taut way around its circles, on which the ground bears under the
wheels only. Where it is slack, it is drawn taut all the same, and the page says by how much it hangs.
A spring between frames is a coil from end to end; one on a joint is a spiral about its axis, or where the
joint slides a coil beside it, whose length says nothing but its change. Colours go from no force to the
greatest.
"""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rover_pin.mechanism import FrameSpring, Kinematics
from rover_pin.numerics import Array
from rover_pin.viz.colours import GRIP, RUBBER, STRONG, WEAK
from rover_pin.viz.surfaces import Surface, frame_along, joined, rope, sheet

if TYPE_CHECKING:
    from rover_pin.mechanism import Track
    from rover_pin.rover import Rover
    from rover_pin.terrain import Terrain

THICK, PROUD = 0.010, 0.002
"""A belt's thickness, and how much of it stands out of the model's way; shares of the wheels' span."""

GRIPS = 0.005
"""How near to the ground a belt is said to lie on it; share of the wheels' span."""

STEP = 0.03
"""Length of a belt's pieces; share of the wheels' span."""

COIL, WIRE, TURNS = 0.022, 0.0045, 9
"""A coil's radius and its wire's, shares of the wheels' span, and its turns."""

SHOWN = 0.12
"""Length of a coil beside a sliding joint, at rest; share of the wheels' span."""


def tracks(rover: Rover, q: Array, span: float, terrain: Terrain | None = None) -> Surface:
    """Every track as a belt, world; it has another colour on `terrain`. q (nv,) is the configuration."""
    at = Kinematics(rover.model, rover.model.createData(), np.array(q)) if rover.tracks else None
    return joined([_belt(track, at, span, belt_width(rover, track, span), terrain) for track in rover.tracks])


def belt_width(rover: Rover, track: Track, span: float) -> float:
    """m: a little more than the widest of its wheels."""
    around = {circle.name for circle in track.circles}
    widths = [float(getattr(wheel, "width", 0.0)) for wheel in rover.wheels if wheel.name in around]
    return 1.04 * max(widths, default=0.0) or 0.08 * span


def belt_points(track: Track, at: Kinematics, step: float) -> Array:
    """(p, 3) m, world: the taut way, closed, in pieces of `step` at most."""
    path = track.path(at)
    parts = [path[:1]]
    for a, b in itertools.pairwise(path):
        length = float(np.linalg.norm(b - a))
        if length > 1e-9:
            count = int(np.ceil(length / step))
            parts.append(a + (b - a) * (np.arange(1, count + 1) / count)[:, None])
    return np.vstack(parts)


def gripping(points: Array, terrain: Terrain, near: float) -> NDArray[np.bool_]:
    """(p,) whether a point is within `near` m of the ground, or in it."""
    return np.asarray(points[:, 2] - terrain.height(points[:, 0], points[:, 1]) < near, dtype=np.bool_)


def _belt(track: Track, at: Any, span: float, width: float, terrain: Terrain | None) -> Surface:
    points = belt_points(track, at, STEP * span)
    axis = at.rotation(track.joint) @ track.axes[:, 2]
    ways = np.roll(points[:-1], -1, axis=0) - np.roll(points[:-1], 1, axis=0)
    out = np.cross(ways, axis)
    out /= np.linalg.norm(out, axis=1)[:, None]
    out = np.vstack([out, out[:1]])
    grip = np.zeros(len(points), dtype=bool) if terrain is None else gripping(points, terrain, GRIPS * span)
    section = [(0.5, PROUD), (-0.5, PROUD), (-0.5, PROUD - THICK), (0.5, PROUD - THICK), (0.5, PROUD)]
    rows = np.stack([points + across * width * axis + rise * span * out for across, rise in section], axis=1)
    return sheet(rows, np.where(grip[:, None], GRIP, RUBBER))


def struts(rover: Rover, q: Array, span: float) -> Surface:
    """Every spring, world, coloured by its force; q (nv,) is the configuration."""
    if not rover.springs:
        return joined([])
    at = Kinematics(rover.model, rover.model.createData(), np.array(q))
    efforts = [abs(float(spring.effort(at))) for spring in rover.springs]
    pushes = [isinstance(spring, FrameSpring) for spring in rover.springs]
    parts = []
    for spring, effort, push in zip(rover.springs, efforts, pushes, strict=True):
        greatest = max(other for other, like in zip(efforts, pushes, strict=True) if like == push)
        if isinstance(spring, FrameSpring):
            line = coil(spring.first.origin(at), spring.second.origin(at), COIL * span)
        else:
            line = _at_joint(rover, at, spring, span)
        parts.append(rope(line, WIRE * span, _mix(effort / max(greatest, 1e-12))))
    return joined(parts)


def coil(start: Array, end: Array, radius: float) -> Array:
    """(n, 3) m: a helix between two points, which it starts and ends at."""
    t = np.linspace(0.0, 1.0, 12 * TURNS + 1)
    length = max(float(np.linalg.norm(end - start)), 1e-9)
    first, second, _ = frame_along(end - start if length > 1e-9 else np.array([0.0, 0.0, 1.0])).T
    wide = radius * np.clip(np.minimum(t, 1 - t) / 0.1, 0.0, 1.0)[:, None]
    angle = (2 * np.pi * TURNS * t)[:, None]
    inner = start + t[:, None] * (end - start)
    return np.asarray(inner + wide * (np.cos(angle) * first + np.sin(angle) * second))


def slide_back(rover: Rover, joint: int, axis: Array) -> float:
    """Where the spring of a sliding joint is drawn: +1 or -1 along its axis, towards its parent's mass."""
    model = rover.model
    parent = model.parents[joint]
    away = model.jointPlacements[joint].translation - model.inertias[parent].lever
    return -1.0 if float(model.jointPlacements[joint].rotation @ axis @ away) > 0 else 1.0


def _at_joint(rover: Rover, at: Any, spring: Any, span: float) -> Array:
    """(n, 3) m, world: the coil or spiral of a spring on a joint."""
    from rover_pin.viz.tree import joint_nodes

    node = next(node for node in joint_nodes(rover.model) if node.name == spring.joint)
    rotation, origin = at.rotation(node.joint), at.point(node.joint, np.zeros(3))
    along, value = rotation @ node.axis, float(at.q[spring.column])
    if node.slides:
        side = slide_back(rover, node.joint, node.axis)
        return coil(origin + along * (side * SHOWN * span - (value - spring.rest)), origin, COIL * span)
    return spiral(origin, rotation @ frame_along(node.axis), value, span)


def spiral(origin: Array, frame: Array, value: float, span: float) -> Array:
    """(n, 3) m: a flat spiral about the third column of `frame`; its outer end turns back by `value` rad."""
    t = np.linspace(0.0, 1.0, 73)
    radius = (COIL * span * (0.4 + 1.6 * t))[:, None]
    angle = (t * (6 * np.pi - value))[:, None]
    return np.asarray(origin + radius * (np.cos(angle) * frame[:, 0] + np.sin(angle) * frame[:, 1]))


def _mix(share: float) -> tuple[float, float, float]:
    r, g, b = (w + share * (s - w) for w, s in zip(WEAK, STRONG, strict=True))
    return r, g, b
