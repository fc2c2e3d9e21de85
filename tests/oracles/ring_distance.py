"""Where a wheel meets the ground, by looking at the whole footprint; reads heights and gradients only.

A wheel is a circle swept by a ball. The distance of a point to a circle is known in closed form, so the gap
is the least of that over the surface's points, minus the ball's radius: a dense look at the ground below,
then the root of the stationarity conditions by scipy at each of its low places. The package looks the other
way, from points of the circle to the ground.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import root


class Ground:
    """Heights h0 + s (h - h0) of a terrain and their gradient."""

    def __init__(self, terrain, level: float = 0.0, share: float = 1.0) -> None:
        self.terrain, self.level, self.share = terrain, level, share

    def height(self, x, y):
        return self.level + self.share * (self.terrain.height(x, y) - self.level)

    def gradient(self, x, y):
        return self.share * self.terrain.gradient(x, y)


@dataclass
class Touch:
    """A low place: gap [m], point of the ground, nearest point of the circle, direction from ground to it."""

    gap: float
    ground: np.ndarray
    circle: np.ndarray
    normal: np.ndarray


def to_circle(points, center, axis, ring):
    """Nearest points (k, 3) of the circle to `points` (k, 3)."""
    away = points - center
    flat = away - (away @ axis)[:, None] * axis
    size = np.linalg.norm(flat, axis=1, keepdims=True)
    return center + ring * flat / np.maximum(size, 1e-300)


def _one_to_circle(px, py, pz, c, a, ring):
    """The same for one point, in plain floats."""
    wx, wy, wz = px - c[0], py - c[1], pz - c[2]
    along = wx * a[0] + wy * a[1] + wz * a[2]
    fx, fy, fz = wx - along * a[0], wy - along * a[1], wz - along * a[2]
    k = ring / max((fx * fx + fy * fy + fz * fz) ** 0.5, 1e-300)
    return wx - k * fx, wy - k * fy, wz - k * fz


def refine(ground: Ground, center, axis, ring, tread, start) -> Touch | None:
    """The stationary place near `start` (x, y), or None where scipy finds none within 2 cm."""
    c, a = [float(v) for v in center], [float(v) for v in axis]

    def slope(p):
        x, y = p
        h = float(ground.height(x, y))
        gx, gy = ground.gradient(x, y)
        wx, wy, wz = _one_to_circle(x, y, h, c, a, ring)
        return [wx + wz * gx, wy + wz * gy]

    found = root(slope, start, method="hybr", tol=1e-13, options={"xtol": 1e-13, "eps": 1e-8})
    x, y = found.x
    if np.hypot(x - start[0], y - start[1]) > 0.02 or np.max(np.abs(slope(found.x))) > 1e-9:
        return None
    return touch(ground, center, axis, ring, tread, x, y)


def touch(ground: Ground, center, axis, ring, tread, x, y) -> Touch:
    """The distance at one place of the ground."""
    w = np.array([x, y, float(ground.height(x, y))])
    nearest = to_circle(w[None], center, axis, ring)[0]
    up = nearest - w
    size = float(np.linalg.norm(up))
    return Touch(size - tread, w, nearest, up / max(size, 1e-300))


def at_crease(ground: Ground, center, axis, ring, tread, start, pitch) -> Touch:
    """The least distance near `start` where the ground has a kink: grids, each a fifth as wide."""
    place, wide = start, 1.5 * pitch
    for _ in range(12):
        x, y = (place[k] + np.linspace(-wide, wide, 25) for k in (0, 1))
        gx, gy = (g.ravel() for g in np.meshgrid(x, y))
        points = np.stack([gx, gy, ground.height(gx, gy)], axis=1)
        best = int(np.argmin(np.linalg.norm(points - to_circle(points, center, axis, ring), axis=1)))
        place, wide = np.array([gx[best], gy[best]]), wide / 5
    return touch(ground, center, axis, ring, tread, *place)


def look(ground: Ground, center, axis, ring, tread, pitch=0.004, keep=0.01) -> list[Touch]:
    """Low places of the footprint whose gap is within `keep` of the least, least first."""
    reach = ring * np.sqrt(np.maximum(1.0 - axis[:2] ** 2, 0.0)) + tread + pitch
    x, y = (center[k] + np.linspace(-reach[k], reach[k], int(2 * reach[k] / pitch) + 3) for k in (0, 1))
    gx, gy = np.meshgrid(x, y)
    points = np.stack([gx.ravel(), gy.ravel(), ground.height(gx.ravel(), gy.ravel())], axis=1)
    distance = np.linalg.norm(points - to_circle(points, center, axis, ring), axis=1).reshape(gx.shape)
    padded = np.pad(distance, 1, constant_values=np.inf)
    around = [
        padded[1 + i : padded.shape[0] - 1 + i, 1 + j : padded.shape[1] - 1 + j]
        for i in (-1, 0, 1)
        for j in (-1, 0, 1)
        if i or j
    ]
    low = (distance <= np.min(around, axis=0)) & (distance < distance.min() + keep + pitch**2 / tread)
    found: list[Touch] = []
    for i, j in np.argwhere(low):
        got = refine(ground, center, axis, ring, tread, np.array([gx[i, j], gy[i, j]]))
        if got is None or got.gap > distance[i, j] - tread:
            got = at_crease(ground, center, axis, ring, tread, np.array([gx[i, j], gy[i, j]]), pitch)
        if all(np.linalg.norm(got.ground - other.ground) > 1e-4 for other in found):
            found.append(got)
    found.sort(key=lambda t: t.gap)
    return [t for t in found if t.gap <= found[0].gap + keep]
