"""Springs and tracks as a page draws them: places on bodies, formulas of force, circles of belts."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.mechanism import FrameSpring
from rover_pin.viz.inside import belt_width, slide_back
from rover_pin.viz.scene import span_of
from rover_pin.viz.surfaces import frame_along

if TYPE_CHECKING:
    from rover_pin.rover import Rover
    from rover_pin.viz.tree import JointNode


def inside(rover: Rover, nodes: tuple[JointNode, ...]) -> dict[str, Any]:
    """`springs` and `tracks` for the page; `node` counts in `nodes`, places are in that joint's frame."""
    order = {node.joint: k for k, node in enumerate(nodes)}
    return {
        "springs": [
            _strut(spring, order) if isinstance(spring, FrameSpring) else _at_joint(rover, spring, nodes)
            for spring in rover.springs
        ],
        "tracks": [
            {
                "name": track.name,
                "node": order[track.joint],
                "axes": np.asarray(track.axes).T,
                "length": track.length,
                "width": belt_width(rover, track, span_of(rover)),
                "circles": [
                    {"node": order[c.joint], "center": c.center, "rho": c.rho} for c in track.circles
                ],
            }
            for track in rover.tracks
        ],
    }


def _strut(spring: FrameSpring, order: Mapping[int, int]) -> dict[str, Any]:
    """Between two places: force = preload + stiffness (length_max - length)."""
    return {
        "name": spring.name,
        "unit": "N",
        "ends": [
            {"node": order[end.joint], "point": end.translation} for end in (spring.first, spring.second)
        ],
        "stiffness": spring.stiffness,
        "preload": spring.preload,
        "length_max": spring.length_max,
    }


def _at_joint(rover: Rover, spring: Any, nodes: tuple[JointNode, ...]) -> dict[str, Any]:
    """On a joint: effort = preload - stiffness (q - rest)."""
    place = next(k for k, node in enumerate(nodes) if node.name == spring.joint)
    node = nodes[place]
    return {
        "name": spring.name,
        "unit": "N" if node.slides else "N m",
        "node": place,
        "joint": spring.joint,
        "slides": node.slides,
        "frame": frame_along(node.axis).T,
        "side": slide_back(rover, node.joint, node.axis) if node.slides else 0.0,
        "stiffness": spring.stiffness,
        "preload": spring.preload,
        "rest": spring.rest,
    }
