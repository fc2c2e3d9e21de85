"""Another look along a wheel's ring, where the ground's bounds do not prove that a contact is the least."""

from __future__ import annotations

import math

import numpy as np

from rover_pin.compiled.ground import Ground
from rover_pin.compiled.track import track
from rover_pin.contact.place import Frame, basis, param_near, place
from rover_pin.numerics import Array, formula, inlined
from rover_pin.terrain.surface import tabled

LEAST, DEEPER, UNDECIDED = 0, 1, 2

MOST = 160
"""Samples along a ring."""

FINE = 0.3
"""Distance of samples, over the map's spacing; at most a tenth of the shape's size."""

DOUBTFUL = 0.03
"""Share of the shape's size: where the ground is farther than this from the skin there is no contact."""

SAME = 1e-3
"""Share of the shape's size within which two places are one contact, as in the contact search."""

TRACKED = 12


@inlined
def estimate(kind: int, params: Array, table: Array, px: float, py: float, pz: float) -> float:
    """Distance of a point to the ground [m], one Newton step from the place below it; negative within."""
    h, hx, hy, hxx, hxy, hyy = tabled(kind, table, params, px, py)
    v = pz - h
    a11, a12, a22 = 1.0 + hx * hx - v * hxx, hx * hy - v * hxy, 1.0 + hy * hy - v * hyy
    det = a11 * a22 - a12 * a12
    if v <= 0.0 or not det > 0.1:
        return v / math.sqrt(1.0 + hx * hx + hy * hy)
    s1, s2 = v * (a22 * hx - a12 * hy) / det, v * (a11 * hy - a12 * hx) / det
    rest = v - (hx + 0.5 * (hxx * s1 + hxy * s2)) * s1 - (hy + 0.5 * (hxy * s1 + hyy * s2)) * s2
    return math.sqrt(s1 * s1 + s2 * s2 + rest * rest)


@formula
def distances(
    ground: Ground, params: Array, table: Array, frame: Frame, cx: float, cy: float, cz: float, ring: float,
    count: int, top: float, far: Array,
) -> float:  # fmt: skip
    """Fill `far` (count,) with estimated distances of points evenly around the ring; the least of them.

    Infinite where a point is so far above `top`, the highest ground around, that it cannot touch: all but
    those within an angle of the lowest one.
    """
    far[:] = math.inf
    least = math.inf
    drop = max(-frame[5] * ring, 1e-12)  # of the lowest point below the centre
    around = math.acos(min(max((cz - top) / drop, -1.0), 1.0)) * count / (2.0 * math.pi)
    widest = min(int(around), (count - 1) // 2)
    for k in range(-widest, widest + 1):
        px, py, pz, _, _, _, _, _, _ = place(0, frame, cx, cy, cz, ring, 2.0 * math.pi * k / count)
        here = estimate(ground.kind, params, table, px, py, pz)
        far[k] = here
        least = min(least, here)
    return least


@formula
def sweep(
    ground: Ground, params: Array, table: Array, cx: float, cy: float, cz: float, ax: float, ay: float,
    az: float, ring: float, tread: float, top: float, sure: float, contact: Array,
) -> int:  # fmt: skip
    """Look for places of a ring-shaped skin that come as near to the ground as a contact found.

    Samples of the ring are measured to the ground; every stretch of them that is in doubt is followed from
    its nearest sample to the contact it belongs to.

    Args:
        ground: the surface's record.
        params: its parameters.
        table: its table.
        cx: centre [m].
        cy: centre [m].
        cz: centre [m].
        ax: axis.
        ay: axis.
        az: axis.
        ring: m.
        tread: m.
        top: m, the highest ground around.
        sure: m, around the contact within which it is known to be the only one.
        contact: (7,) gap, point, normal of the contact found; receives a deeper one.

    Returns:
        LEAST, DEEPER (another place is in the ground), or UNDECIDED (another touches, or cannot be told).
    """
    size = ring + tread
    frame = basis(0, ring, ax, ay, az)
    count = int(min(max(2.0 * math.pi * ring / min(FINE * ground.spacing, 0.1 * size), 24.0), MOST))
    far = np.empty(count)
    limit = tread + max(contact[0], 0.0) + DOUBTFUL * size
    if not distances(ground, params, table, frame, cx, cy, cz, ring, count, top + limit, far) < limit:
        return LEAST
    turn = 2.0 * math.pi / count
    home = param_near(0, frame, cx, cy, cz, ring, contact[1], contact[2], contact[3])
    found = LEAST
    for k in range(count):
        here = far[k]
        if not here < limit or far[k - 1] < here or far[(k + 1) % count] <= here:
            continue
        away = k * turn - home
        away -= 2.0 * math.pi * math.floor(away / (2.0 * math.pi) + 0.5)
        if ring * abs(away) < sure:
            continue
        x, y, _, _, _, _, _, _, _ = place(0, frame, cx, cy, cz, ring, k * turn)
        gap, h, nx, ny, nz, step = 0.0, 0.0, 0.0, 0.0, 0.0, math.inf
        for _ in range(TRACKED):
            gap, x, y, h, nx, ny, nz, step = track(
                ground.kind, table, params, cx, cy, cz, ax, ay, az, ring, tread, x, y
            )  # fmt: skip
            if step < 1e-7:
                break
        if not step < 1e-7:
            return UNDECIDED
        if (x - contact[1]) ** 2 + (y - contact[2]) ** 2 < (SAME * size) ** 2:
            continue
        if gap < contact[0] and gap < -2e-7:
            contact[0], contact[1], contact[2], contact[3] = gap, x, y, h
            contact[4], contact[5], contact[6] = nx, ny, nz
            found = DEEPER
        elif gap < 1e-6:
            return UNDECIDED
    return found
