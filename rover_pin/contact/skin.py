"""A coarse look over the lower skin of a shape: where it comes near the ground."""

from __future__ import annotations

import math

import numpy as np

from rover_pin.contact.place import place
from rover_pin.numerics import formula
from rover_pin.terrain.surface import surface

MOST_ROWS = 128
MOST_COLUMNS = 9


@formula
def lattice(kind, spacing, form, frame, ring, ball):  # type: ignore[no-untyped-def]
    """How finely to look: rows along the line, columns around the ball.

    Args:
        kind: terrain kind.
        spacing: terrain's feature size, m.
        form: RING or SEGMENT.
        frame: nine numbers of `basis`.
        ring: ring radius or half length, m.
        ball: radius of the tube looked at, m.

    Returns:
        rows, columns, rows of one cap (segments), first p, step of p, step of the column angle, True for a
        closed ring.
    """
    step = min(spacing if kind == 3 else 0.5 * spacing, (ring + ball) / 8.0)
    step = max(step, 1e-6)
    if form == 1:
        cap = 3 if ball > 0.0 else 0
        n = max(min(int(math.ceil(2.0 * ring / step)), MOST_ROWS - 8), 1)
        m = max(min(int(math.ceil(math.pi * ball / step)), MOST_COLUMNS - 1), 3) if ball > 0.0 else 0
        return n + 1 + 2 * cap, m + 1, cap, -ring, 2.0 * ring / n, math.pi / max(m, 1), False
    closed = abs(frame[2]) > 0.02
    span = 2.0 * math.pi if closed else 1.04 * math.pi
    n = max(min(int(math.ceil(span * (ring + ball) / step)), MOST_ROWS - 2), 8)
    if ring + ball == 0.0:
        n = 0
    m = max(min(int(math.ceil(math.pi * ball / step)), MOST_COLUMNS - 1), 2) if ball > 0.0 else 0
    return (n if closed else n + 1), m + 1, 0, -0.5 * span, span / max(n, 1), math.pi / max(m, 1), closed


@formula
def skin_point(form, frame, cx, cy, cz, ring, ball, grid, i, j):  # type: ignore[no-untyped-def]
    """Skin point of row i, column j: parameter p, the point, and its outward direction's z.

    Ring: u = r(p) cos b + a sin b. Segment: u = d cos b + e sin b, leaning out along the axis in the caps.

    Returns:
        p, point (3), z of the outward direction (-1 where the tube has no thickness).
    """
    ax, ay, az, dx, dy, dz, ex, ey, ez = frame
    rows, columns, cap, first, step, turn, _ = grid
    b = (j - 0.5 * (columns - 1)) * turn
    cb, sb = math.cos(b), math.sin(b)
    if form == 1:
        k = min(max(i - cap, 0), rows - 1 - 2 * cap)
        p = min(first + k * step, ring)
        lean = 0.0
        if i < cap:
            lean = -(cap - i) * math.pi / 7.0
        elif i > rows - 1 - cap:
            lean = (i - (rows - 1 - cap)) * math.pi / 7.0
        cl, sl = math.cos(lean), math.sin(lean)
        ux = cl * (cb * dx + sb * ex) + sl * ax
        uy = cl * (cb * dy + sb * ey) + sl * ay
        uz = cl * (cb * dz + sb * ez) + sl * az
        px, py, pz, _, _, _, _, _, _ = place(form, frame, cx, cy, cz, ring, p)
    else:
        p = first + i * step
        cp, sp = math.cos(p), math.sin(p)
        rx, ry, rz = cp * dx + sp * ex, cp * dy + sp * ey, cp * dz + sp * ez
        ux, uy, uz = cb * rx + sb * ax, cb * ry + sb * ay, cb * rz + sb * az
        px, py, pz = cx + ring * rx, cy + ring * ry, cz + ring * rz
    if ball == 0.0:
        return p, px, py, pz, -1.0
    return p, px + ball * ux, py + ball * uy, pz + ball * uz, uz


@formula
def clearances(kind, table, params, form, frame, cx, cy, cz, ring, ball, grid):  # type: ignore[no-untyped-def]
    """Estimated distance to the surface at every skin point: vertical clearance / sqrt(1 + |grad h|^2).

    A point where the skin faces up cannot be the lowest of the shape and gets infinity.

    Returns:
        (rows, columns) m.
    """
    rows, columns = grid[0], grid[1]
    near = np.empty((rows, columns))
    for i in range(rows):
        for j in range(columns):
            _, x, y, z, uz = skin_point(form, frame, cx, cy, cz, ring, ball, grid, i, j)
            if uz > -0.02:
                near[i, j] = math.inf
                continue
            h, hx, hy, _, _, _ = surface(kind, table, params, x, y)
            near[i, j] = (z - h) / math.sqrt(1.0 + hx * hx + hy * hy)
    return near


@formula
def hollow(near, i, j, closed):  # type: ignore[no-untyped-def]
    """Whether entry (i, j) is no larger than its eight neighbours (ties go to the first)."""
    rows, columns = near.shape
    here = near[i, j]
    if not here < math.inf:
        return False
    for di in range(-1, 2):
        k = i + di
        if closed:
            k = k % rows
        elif k < 0 or k >= rows:
            continue
        for dj in range(-1, 2):
            m = j + dj
            if m < 0 or m >= columns or (di == 0 and dj == 0):
                continue
            before = k < i or (k == i and m < j)
            if near[k, m] < here or (before and near[k, m] == here):
                return False
    return True
