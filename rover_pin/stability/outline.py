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
        while len(self.angles) < MOST:
            angle = self._open_distance()
            angle = self._open_area() if angle is None else angle
            if angle is None:
                return True
            self._ask(angle)
        return False

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
        values, where = np.empty(8), np.empty(8)
        for eighth in range(8):
            own = np.flatnonzero((owner == eighth) | np.isin(np.arange(len(angles)), (eighth, eighth + 1)))
            best = own[np.argmin(reach[own])]
            values[eighth], where[eighth] = reach[best], angles[best]
        return values, where

    def _open_distance(self) -> float | None:
        """The direction to ask next for the eighths' distances; None where all are known."""
        inner, where = self.least()
        asked, told = np.array(self.angles), np.array(self.reaches)
        gaps = np.empty(8)
        for eighth in range(8):
            start = self._first + eighth * math.pi / 4
            own = (asked >= start - 1e-12) & (asked <= start + math.pi / 4 + 1e-12)
            if eighth == 7:
                own[0] = True
            gaps[eighth] = told[own].min() - inner[eighth]
        worst = int(np.argmax(gaps))
        return float(where[worst]) if gaps[worst] > CLOSE * self.size else None

    def _open_area(self) -> float | None:
        """The direction that may add most to the area; None where little is missing."""
        missing = self._missing()
        if missing.sum() <= AREA * self.area + (CLOSE * self.size) ** 2:
            return None
        at = int(np.argmax(missing))
        step = self.places[(at + 1) % len(self.places)] - self.places[at]
        return math.atan2(-step[0], step[1])

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
