"""The support polygon: the convex hull of the contact points as gravity sees them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from rover_pin.numerics import Array, frozen

SAME_PLACE = 1e-6
"""Contacts of one wheel nearer than this share of the polygon's size are one corner."""

FLAT = 1e-6
"""A polygon narrower than this share of its length is a line."""


@dataclass(frozen=True)
class SupportPolygon:
    """Corners in counterclockwise order as seen from above.

    Attributes:
        points: (n, 3) m, world: the contact points at the corners, at their own heights.
        ends: (n, 3) the corner that follows each.
        wheels: (n) the wheel at each corner.
        edges: (n) names: `fl-ml` goes from fl's corner to ml's.
        reason: why there is no polygon; empty where there is one.
    """

    points: Array
    ends: Array
    wheels: tuple[str, ...]
    edges: tuple[str, ...]
    reason: str = ""


def support_polygon(points: Sequence[Array], wheels: Sequence[str]) -> SupportPolygon:
    """Hull of contact points, projected along z.

    Args:
        points: k contact points, (3,) each, world.
        wheels: k names of their wheels.

    Returns:
        the polygon, or one without corners and with a reason: fewer than three contacts, or all in a line.
    """
    places = np.asarray(points, dtype=np.float64).reshape(-1, 3)
    count = len(places)
    if count < 3:
        return _none("1 contact spans no polygon" if count == 1 else f"{count} contacts span no polygon")
    size = float(np.max(np.ptp(places[:, :2], axis=0)))
    kept = _separate(places, wheels, SAME_PLACE * size) if len(set(wheels)) < count else list(range(count))
    if len(kept) < 3:
        return _none(f"{len(kept)} separate contacts span no polygon")
    flat = places[kept, :2]
    try:
        hull = ConvexHull(flat)
    except QhullError:
        return _none("the contacts lie in a line")
    if hull.volume <= FLAT * size * size:
        return _none("the contacts lie in a line")
    corners = [kept[i] for i in hull.vertices]
    corner = places[corners]
    names = tuple(wheels[i] for i in corners)
    return SupportPolygon(frozen(corner), frozen(np.roll(corner, -1, axis=0)), names, _edge_names(names))


def _separate(places: Array, wheels: Sequence[str], distance: float) -> list[int]:
    """Indices of the contacts that are not within `distance` of an earlier one of the same wheel."""
    kept: list[int] = []
    for i, wheel in enumerate(wheels):
        if not any(wheels[j] == wheel and np.hypot(*(places[i] - places[j])[:2]) <= distance for j in kept):
            kept.append(i)
    return kept


def _edge_names(wheels: Sequence[str]) -> tuple[str, ...]:
    seen: dict[str, int] = {}
    names = []
    for start, end in zip(wheels, (*wheels[1:], wheels[0]), strict=True):
        name = f"{start}-{end}"
        seen[name] = seen.get(name, 0) + 1
        names.append(name if seen[name] == 1 else f"{name}#{seen[name]}")
    return tuple(names)


def _none(reason: str) -> SupportPolygon:
    nothing = frozen(np.zeros((0, 3)))
    return SupportPolygon(nothing, nothing, (), (), reason)
