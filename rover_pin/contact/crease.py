"""The nearest point of a surface with creases: projection on tangent planes, cut by cut."""

from __future__ import annotations

import math

import numpy as np

from rover_pin.contact.bilinear import touch_bilinear
from rover_pin.contact.nearest import Seven, nearest, upright
from rover_pin.numerics import Array, formula
from rover_pin.terrain.surface import surface

MOST_PLANES = 5


@formula
def meet(
    planes: Array, i: int, j: int, k: int, px: float, py: float, pz: float
) -> tuple[float, float, float]:
    """The point nearest to P on plane i, on the line of i and j (j >= 0), or at i, j, k's corner (k >= 0).

    A plane is z = a + gx x + gy y, a row (a, gx, gy). NaN where the planes do not meet.
    """
    ax, ay = planes[i, 1], planes[i, 2]
    over = pz - planes[i, 0] - ax * px - ay * py
    if j < 0:
        s = over / (1.0 + ax * ax + ay * ay)
        return px + s * ax, py + s * ay, pz - s
    dx, dy = ax - planes[j, 1], ay - planes[j, 2]
    rest = planes[j, 0] - planes[i, 0]
    if k < 0:
        dd = dx * dx + dy * dy
        if dd < 1e-18:
            return math.nan, math.nan, math.nan
        lx, ly = -dy, dx
        lz = ax * lx + ay * ly
        bx, by = rest * dx / dd, rest * dy / dd
        bz = planes[i, 0] + ax * bx + ay * by
        s = ((px - bx) * lx + (py - by) * ly + (pz - bz) * lz) / (lx * lx + ly * ly + lz * lz)
        return bx + s * lx, by + s * ly, bz + s * lz
    ex, ey = ax - planes[k, 1], ay - planes[k, 2]
    last = planes[k, 0] - planes[i, 0]
    det = dx * ey - dy * ex
    if abs(det) < 1e-12:
        return math.nan, math.nan, math.nan
    x = (rest * ey - last * dy) / det
    y = (dx * last - ex * rest) / det
    return x, y, planes[i, 0] + ax * x + ay * y


@formula
def project(planes: Array, n: int, px: float, py: float, pz: float) -> tuple[float, float, float]:
    """The point nearest to P of the convex body below all n planes; NaN where P is in it."""
    wx, wy, wz = math.nan, math.nan, math.nan
    least = math.inf
    for i in range(n):
        for j in range(i, n):
            for k in range(j, n):
                if j == i and k != j:
                    continue
                x, y, z = meet(planes, i, j if j > i else -1, k if k > j else -1, px, py, pz)
                far = (px - x) ** 2 + (py - y) ** 2 + (pz - z) ** 2
                if not far < least:
                    continue
                below = True
                for m in range(n):
                    if m not in (i, j, k) and z > planes[m, 0] + planes[m, 1] * x + planes[m, 2] * y + 1e-13:
                        below = False
                if below and (j > i or pz - z >= 0.0):
                    wx, wy, wz, least = x, y, z, far
    return wx, wy, wz


@formula
def cuts(
    kind: int, table: Array, params: Array, px: float, py: float, pz: float, x: float, y: float
) -> tuple[Seven, float, bool]:
    """Local nearest point to a P above a surface that is a crest, by cutting planes (Kelley, 1960).

    Where the ground is a crest of smooth flanks the body under their tangent planes holds it. P is projected
    on that body; the flank under the answer gives the next plane. A plane that cuts the ground off goes.

    Returns:
        (W (3), n (3), distance) with n the direction from W to P, slope^2 at W, True where it converged.
    """
    planes = np.empty((MOST_PLANES, 3))
    n = 0
    bx, by, bz, least = x, y, pz, math.inf
    steep = 0.0
    done = False
    for _ in range(25):
        h, hx, hy, _, _, _ = surface(kind, table, params, x, y)
        far = (px - x) ** 2 + (py - y) ** 2 + (pz - h) ** 2
        if far < least:
            bx, by, bz, least, steep = x, y, h, far, hx * hx + hy * hy
        m = 0
        for i in range(n):
            if planes[i, 0] + planes[i, 1] * x + planes[i, 2] * y >= h - 1e-12:
                planes[m] = planes[i]
                m += 1
        if m == MOST_PLANES:
            planes[:-1] = planes[1:].copy()
            m -= 1
        planes[m, 0], planes[m, 1], planes[m, 2] = h - hx * x - hy * y, hx, hy
        n = m + 1
        wx, wy, wz = project(planes, n, px, py, pz)
        if not math.isfinite(wx):
            break
        step = abs(wx - x) + abs(wy - y)
        x, y = wx, wy
        if step < 1e-12:
            done = True
            break
        h = surface(kind, table, params, x, y)[0]
        if abs(h - wz) < 1e-13:
            far = (px - x) ** 2 + (py - y) ** 2 + (pz - h) ** 2
            if far <= least + 1e-15:
                bx, by, bz, least = x, y, h, far
            done = True
            break
    far = math.sqrt(least)
    if far > 1e-9:
        return (bx, by, bz, (px - bx) / far, (py - by) / far, (pz - bz) / far, far), steep, done
    _, hx, hy, _, _, _ = surface(kind, table, params, bx, by)
    return upright(bx, by, bz, hx, hy, px, py, pz), steep, done


@formula
def touch(
    kind: int,
    table: Array,
    params: Array,
    spacing: float,
    px: float,
    py: float,
    pz: float,
    x: float,
    y: float,
) -> Seven:
    """The nearest point of any surface near (x, y): `nearest`, and `cuts` where that ends at a crease.

    In the ground (P below the surface) the place straight above P is tried too and the nearer one counts.
    """
    found, smooth = nearest(kind, table, params, spacing, px, py, pz, x, y)
    plain = away(found, px, py, pz)
    if pz < surface(kind, table, params, px, py)[0]:
        other, _ = nearest(kind, table, params, spacing, px, py, pz, px, py)
        if away(other, px, py, pz) < plain:
            found, plain = other, away(other, px, py, pz)
        return found[0], found[1], found[2], found[3], found[4], found[5], -plain
    if kind == 2:
        return touch_bilinear(kind, table, params, spacing, px, py, pz, x, y)
    if smooth and found[6] >= 0.0:
        return found
    other, _, done = cuts(kind, table, params, px, py, pz, found[0], found[1])
    if done or other[6] < plain or plain < 1e-9:
        return other
    nx, ny, nz = (px - found[0]) / plain, (py - found[1]) / plain, (pz - found[2]) / plain
    return found[0], found[1], found[2], nx, ny, nz, plain


@formula
def away(found: Seven, px: float, py: float, pz: float) -> float:
    """Distance |P - W| [m]."""
    return math.sqrt((px - found[0]) ** 2 + (py - found[1]) ** 2 + (pz - found[2]) ** 2)
