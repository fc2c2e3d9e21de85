"""A rover from above, to scale: its wheels, feet and body as flat shapes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pinocchio as pin

from rover_pin.contact import Wheel
from rover_pin.numerics import Array

if TYPE_CHECKING:
    from rover_pin.rover import Rover


@dataclass(frozen=True)
class Footprint:
    """Outlines in the root link's frame, x forward, m; level and at home.

    Attributes:
        body: (n, 2) convex outline of the links that are no wheel; empty where nothing is known of them.
        wheels: (4, 2) corners each.
        feet: (x, y, radius) each.
    """

    body: Array
    wheels: tuple[Array, ...]
    feet: tuple[tuple[float, float, float], ...]

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """(xmin, xmax, ymin, ymax) m."""
        discs = [np.array([[x - r, y - r], [x + r, y + r]]) for x, y, r in self.feet]
        points = np.concatenate([self.body, *self.wheels, *discs])
        (xmin, ymin), (xmax, ymax) = points.min(axis=0), points.max(axis=0)
        return float(xmin), float(xmax), float(ymin), float(ymax)


def footprint(rover: Rover) -> Footprint:
    """The rover from above."""
    data = rover.model.createData()
    pin.forwardKinematics(rover.model, data, np.array(rover.neutral))
    points = np.array([data.oMi[p.joint].act(np.asarray(p.point))[:2] for p in (*rover.hull, *rover.belly)])
    wheels = tuple(_wheel(data.oMi[w.joint], w) for w in rover.wheels)
    centers = [(data.oMi[foot.joint].act(np.asarray(foot.center)), foot.radius) for foot in rover.feet]
    feet = tuple((float(c[0]), float(c[1]), max(float(radius), 0.01)) for c, radius in centers)
    return Footprint(_outline(points.reshape(-1, 2)), wheels, feet)


def _wheel(placement: Any, wheel: Wheel) -> Array:
    """(4, 2) corners of the wheel's shadow, its axis laid flat."""
    center = placement.act(np.asarray(wheel.center))[:2]
    axis = (placement.rotation @ np.asarray(wheel.axis))[:2]
    length = math.hypot(*axis)
    across = axis / length if length > 1e-9 else np.array([0.0, 1.0])
    along = np.array([across[1], -across[0]])
    half = np.array([[1, 1], [1, -1], [-1, -1], [-1, 1]], dtype=np.float64)
    sides: Array = np.outer(half[:, 0] * wheel.radius, along) + np.outer(half[:, 1] * wheel.width / 2, across)
    corners: Array = center + sides
    return corners


def _outline(points: Array) -> Array:
    """(n, 2) convex hull; empty where the points have no area."""
    from scipy.spatial import ConvexHull, QhullError

    try:
        return points[ConvexHull(points).vertices] if len(points) > 2 else np.empty((0, 2))
    except QhullError:
        return np.empty((0, 2))
