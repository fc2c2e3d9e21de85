"""The outline of a convex set in the plane, known by how far it reaches along a direction."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from rover_pin.numerics import Array

EIGHTHS = ("front", "front_left", "left", "rear_left", "rear", "rear_right", "right", "front_right")
"""Eighths of the circle about a heading, counterclockwise; `front` is centred on it."""

CLOSE = 1e-7
"""Share of the size to which the distances are found."""

AREA = 1e-3
"""Share of the area that may be left between the inner and the outer outline."""

NARROW = 1e-6
"""A set narrower than this share of its length is a line."""

_EIGHT = np.arange(8)

MOST = 400
"""Directions after which the search counts as failed."""


@dataclass
class Outline:
    """Places of the set's edge, the furthest along ever more directions (Bretl and Lall 2008).

    Their hull lies in the set, and the set in the polygon of their tangents. The signed distance of the
    origin from the edge is min over directions a of (reach along a), whether it is inside or not.

    Attributes:
        reach: gives (reach [m], (2,) place) along a unit vector; raises to end the search.
        heading: rad, the middle of the first eighth.
        size: m, what tolerances are shares of.
    """

    reach: Callable[[Array], tuple[float, Array]]
    heading: float
    size: float
    angles: list[float] = field(default_factory=list)
    reaches: list[float] = field(default_factory=list)
    places: list[Array] = field(default_factory=list)

    def trace(self) -> bool:
        """Ask until every eighth's distance and the area are known; False where `MOST` is not enough."""
        for eighth in range(8):
            self._ask(self.heading + (eighth - 0.5) * math.pi / 4)
        for unknown in (self._open_distances, self._open_area):
            while len(angles := unknown()):
                if len(self.angles) + len(angles) > MOST:
                    return False
                for angle in angles:
                    self._ask(float(angle))
        return True

    def _ask(self, angle: float) -> None:
        angle = (angle - self._first) % math.tau + self._first
        value, place = self.reach(np.array([math.cos(angle), math.sin(angle)]))
        at = int(np.searchsorted(self.angles, angle))
        self.angles.insert(at, angle)
        self.reaches.insert(at, value)
        self.places.insert(at, place)

    @property
    def _first(self) -> float:
        """Where the first eighth begins, rad."""
        return self.heading - math.pi / 8

    def least(self) -> tuple[Array, Array]:
        """(8,) the least reach of the inner outline over each eighth's directions [m], and where [rad]."""
        corners = np.array(self.places)
        following = np.roll(corners, -1, axis=0) - corners
        longer = np.hypot(following[:, 0], following[:, 1]) > 1e-12 * self.size
        across = np.arctan2(-following[longer, 0], following[longer, 1])
        inward = np.arctan2(-corners[:, 1], -corners[:, 0])  # the origin may be outside, beyond a corner
        ends = self._first + np.arange(9) * math.pi / 4
        inside = np.concatenate([across, inward]) - self._first
        angles = np.concatenate([ends, inside % math.tau + self._first])
        reach = np.max(corners @ np.array([np.cos(angles), np.sin(angles)]), axis=0)
        owner = np.clip(((angles - self._first) // (math.pi / 4)).astype(int), 0, 7)
        own = owner == _EIGHT[:, None]
        own[_EIGHT, _EIGHT] = own[_EIGHT, _EIGHT + 1] = True
        best = np.argmin(np.where(own, reach, np.inf), axis=1)
        return reach[best], angles[best]

    def _open_distances(self) -> Array:
        """The directions to ask next for the eighths' distances; none where all are known."""
        inner, where = self.least()
        from_first = np.array(self.angles) - self._first
        start = _EIGHT[:, None] * math.pi / 4
        own = (from_first >= start - 1e-12) & (from_first <= start + math.pi / 4 + 1e-12)
        own[7, 0] = True
        told = np.min(np.where(own, np.array(self.reaches), np.inf), axis=1)
        wanted: Array = where[told - inner > CLOSE * self.size]
        return wanted

    def _open_area(self) -> Array:
        """The directions that may add most to the area; none where little is missing."""
        missing = self._missing()
        if missing.sum() <= AREA * self.area + (CLOSE * self.size) ** 2:
            return np.zeros(0)
        side = np.roll(self.places, -1, axis=0) - np.array(self.places)
        chosen = missing >= 0.5 * missing.max()
        across: Array = np.arctan2(-side[chosen, 0], side[chosen, 1])
        return across

    def _missing(self) -> Array:
        """(n,) m2 between each side of the inner outline and the tangents at its ends."""
        here = np.array(self.places)
        side = np.roll(here, -1, axis=0) - here
        length = np.hypot(side[:, 0], side[:, 1])
        direction = np.arctan2(-side[:, 0], side[:, 1])
        before = np.maximum(np.sin(direction - np.array(self.angles)), 0.0)
        after = np.maximum(np.sin(np.roll(self.angles, -1) - direction), 0.0)
        apex = np.sin((np.roll(self.angles, -1) - np.array(self.angles)) % math.tau)
        # a triangle on a side with the tangents' angles at its ends: side^2 sin sin / (2 sin of their sum)
        sharp = np.where(apex > 1e-12, apex, np.inf)
        area: Array = 0.5 * length**2 * before * after / sharp
        return area

    @property
    def area(self) -> float:
        """Of the inner outline, m2."""
        x, y = np.array(self.places).T
        return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))

    @property
    def area_at_most(self) -> float:
        """Of the outer outline, m2."""
        return self.area + float(self._missing().sum())

    @property
    def narrow(self) -> str:
        """`point` or `line` where the set is one, else nothing."""
        corners = np.array(self.places)
        middle = corners - corners.mean(axis=0)
        length = 2.0 * float(np.max(np.hypot(middle[:, 0], middle[:, 1])))
        if length <= NARROW * self.size:
            return "point"
        return "line" if self.area <= NARROW * length * length else ""

    def corners(self) -> Array:
        """(n, 2) the inner outline's corners, counterclockwise, those on a straight line left out."""
        kept: list[Array] = []
        for place in self.places:
            if not kept or np.hypot(*(place - kept[-1])) > 1e-6 * self.size:
                kept.append(place)
        if len(kept) > 1 and np.hypot(*(kept[0] - kept[-1])) <= 1e-6 * self.size:
            kept.pop()
        count = len(kept)
        bends = []
        for i, place in enumerate(kept):
            before, after = place - kept[i - 1], kept[(i + 1) % count] - place
            turn = before[0] * after[1] - before[1] * after[0]
            if turn > 1e-6 * self.size * min(np.hypot(*before), np.hypot(*after)):
                bends.append(place)
        return np.array(bends or kept)
