"""The support polygon, its limiting edge, and the centre of mass over it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.numerics import Array
from rover_pin.viz.colours import COM, LIMIT, LOAD, REGION
from rover_pin.viz.surfaces import Surface, ball, joined, tube

if TYPE_CHECKING:
    from rover_pin.statics.stance import Contact, Stance


def hull(points: Array) -> list[int]:
    """Indices of the convex hull of (n, 2) points, counterclockwise (Andrew's monotone chain)."""
    order = sorted(range(len(points)), key=lambda i: (points[i][0], points[i][1]))

    def half(indices: list[int]) -> list[int]:
        chain: list[int] = []
        for i in indices:
            while len(chain) > 1:
                a, b = points[chain[-1]] - points[chain[-2]], points[i] - points[chain[-2]]
                if a[0] * b[1] - a[1] * b[0] > 1e-12:
                    break
                chain.pop()
            chain.append(i)
        return chain

    return half(order)[:-1] + half(order[::-1])[:-1]


def corners(stance: Stance) -> list[Contact]:
    """The contacts at the corners of the support polygon, counterclockwise; none where they span none."""
    bearing = [contact for contact in stance.contacts if contact.load > 0]
    if len(bearing) < 3:
        return []
    chosen = hull(np.array([contact.point[:2] for contact in bearing]))
    return [bearing[i] for i in chosen] if len(chosen) > 2 else []


def limiting_edge(stance: Stance, named: str | None = None) -> int | None:
    """Which edge (from corner i to i + 1) limits: the one `named` "fl-ml", else the one nearest the CoM."""
    ring = corners(stance)
    if not ring:
        return None
    pairs = [(a, ring[(i + 1) % len(ring)]) for i, a in enumerate(ring)]
    for i, (a, b) in enumerate(pairs):
        if named is not None and named in (f"{a.wheel}-{b.wheel}", f"{b.wheel}-{a.wheel}"):
            return i

    def distance(a: Contact, b: Contact) -> float:
        edge = (b.point - a.point)[:2]
        reach = (stance.com - a.point)[:2]
        return float((edge[0] * reach[1] - edge[1] * reach[0]) / np.hypot(*edge))

    return int(np.argmin([distance(a, b) for a, b in pairs]))


def support_edges(stance: Stance, span: float, named: str | None = None) -> Surface:
    """The polygon's edges as one mesh, the limiting one orange and thicker."""
    ring, limit = corners(stance), limiting_edge(stance, named)
    bars = []
    for i, a in enumerate(ring):
        b = ring[(i + 1) % len(ring)]
        colour, radius = (LIMIT, 0.006) if i == limit else (LOAD, 0.0035)
        bars.append(tube(a.point, b.point, radius * span, colour))
    return joined(bars)


def region_edges(stance: Stance, span: float, outline: Sequence[tuple[float, float]]) -> Surface:
    """A region of the centre of mass, seen along gravity, as a closed line at the contacts' mean height."""
    if len(outline) < 3 or not stance.contacts:
        return joined([])
    height = float(np.mean([contact.point[2] for contact in stance.contacts]))
    ring = np.array([[x, y, height] for x, y in outline])
    sides = zip(ring, np.roll(ring, -1, axis=0), strict=True)
    return joined([tube(a, b, 0.0022 * span, REGION) for a, b in sides if np.linalg.norm(b - a) > 1e-9])


def support_area(stance: Stance) -> Surface:
    """The polygon filled, a fan about its middle."""
    points = np.array([contact.point for contact in corners(stance)]).reshape(-1, 3)
    n = len(points)
    if not n:
        return joined([])
    vertices = np.vstack([points, points.mean(axis=0)])
    faces = np.array([[i, (i + 1) % n, n] for i in range(n)])
    return Surface(vertices, faces, np.tile(LOAD, (n + 1, 1)))


def com_marker(stance: Stance, span: float) -> Surface:
    """A ball at the centre of mass and a plumb line from it to the ground."""
    ground = np.array([*stance.com[:2], float(stance.terrain.height(*stance.com[:2]))])
    parts = [ball(stance.com, 0.022 * span, COM), ball(ground, 0.009 * span, COM)]
    if np.linalg.norm(stance.com - ground) > 1e-6:
        parts.append(tube(stance.com, ground, 0.004 * span, COM))
    return joined(parts)
