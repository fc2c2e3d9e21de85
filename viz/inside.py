"""What works between a rover's bodies and has no looks in its URDF: tracks and springs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rover_pin.mechanism import FrameSpring, Kinematics
from rover_pin.numerics import Array
from rover_pin.viz.colours import HUB, RUBBER
from rover_pin.viz.surfaces import Surface, joined, tube

if TYPE_CHECKING:
    from rover_pin.rover import Rover

BELT = 0.006
"""Radius of a drawn track, share of the wheels' span."""

STRUT = 0.009


def tracks(rover: Rover, q: Array, span: float) -> Surface:
    """The taut way of every track, world; q (nv,) is the configuration."""
    if not rover.tracks:
        return joined([])
    at = Kinematics(rover.model, rover.model.createData(), np.array(q))
    bars = []
    for track in rover.tracks:
        path = track.path(at)
        far = np.linalg.norm(np.diff(path, axis=0), axis=1) > 1e-9
        bars += [
            tube(a, b, BELT * span, RUBBER)
            for a, b, apart in zip(path[:-1], path[1:], far, strict=True)
            if apart
        ]
    return joined(bars)


def struts(rover: Rover, q: Array, span: float) -> Surface:
    """Springs between frames as bars, world; q (nv,) is the configuration."""
    springs = [spring for spring in rover.springs if isinstance(spring, FrameSpring)]
    if not springs:
        return joined([])
    at = Kinematics(rover.model, rover.model.createData(), np.array(q))
    ends = [(spring.first.origin(at), spring.second.origin(at)) for spring in springs]
    return joined([tube(a, b, STRUT * span, HUB) for a, b in ends if np.linalg.norm(b - a) > 1e-9])
