"""Every cell of a bilinear map under a shape: no contact is missed, however small the ground's detail."""

from __future__ import annotations

import math

import numpy as np

from rover_pin.contact.bilinear import index, node
from rover_pin.contact.nearest import Seven, upright
from rover_pin.contact.patch import Patch, descend, pull
from rover_pin.contact.place import Frame, distance
from rover_pin.contact.probe import keep
from rover_pin.numerics import Array, formula
from rover_pin.terrain.surface import surface

MOST_CELLS = 250_000
DEEPEST = 12
ABOVE = 1e-6


@formula
def lowest(
    table: Array, params: Array, form: int, frame: Frame, cx: float, cy: float, cz: float, ring: float,
    x: float, y: float, h: float,
) -> tuple[Seven, bool]:  # fmt: skip
    """The contact at the place (x, y, h) of a cell, and whether the distance rises beyond the cell too.

    On a line of nodes the slopes on its other side count: the least place of a cell may be no minimum of the
    ground.

    Returns:
        (W (3), n (3), distance), True for a minimum.
    """
    side = params[4]
    gx, gy, gz, _, _, _, _ = pull(form, frame, cx, cy, cz, ring, x, y, h)
    far = math.sqrt(gx * gx + gy * gy + gz * gz)
    u, v = (x - params[2]) / side, (y - params[3]) / side
    slack = 1e-9 * far
    rises = far > 1e-9
    crease = False
    if abs(u - round(u)) < 1e-9:
        crease = True
        before = surface(2, table, params, x - 0.5 * side, y)[1]
        after = surface(2, table, params, x + 0.5 * side, y)[1]
        rises = rises and gx + gz * before <= slack and gx + gz * after >= -slack
    if abs(v - round(v)) < 1e-9:
        crease = True
        before = surface(2, table, params, x, y - 0.5 * side)[2]
        after = surface(2, table, params, x, y + 0.5 * side)[2]
        rises = rises and gy + gz * before <= slack and gy + gz * after >= -slack
    if not crease:
        _, hx, hy, _, _, _ = surface(2, table, params, x, y)
        return upright(x, y, h, hx, hy, x - gx, y - gy, h - gz), rises
    s = 1.0 / max(far, 1e-300)
    return (x, y, h, -gx * s, -gy * s, -gz * s, far), rises


@formula
def bound(
    form: int, frame: Frame, cx: float, cy: float, cz: float, ring: float, x0: float, y0: float, patch: Patch,
    u: float, v: float, half: float,
) -> float:  # fmt: skip
    """A lower bound on the distance over the square of half width `half` about (u, v) of a cell.

    The distance changes no faster than the place, and the patch lies within the hull of its corners.
    """
    z0, hp, hq, hr = patch
    hu, hv = (hp + hr * v) * half, (hq + hr * u) * half
    rise = abs(hu) + abs(hv) + abs(hr) * half * half
    middle = distance(form, frame, cx, cy, cz, ring, x0 + u, y0 + v, z0 + hp * u + hq * v + hr * u * v)
    return middle - math.sqrt(2.0 * half * half + rise * rise)


@formula
def search_cell(
    table: Array, params: Array, form: int, frame: Frame, cx: float, cy: float, cz: float, ring: float,
    tread: float, window: float, best: float, x0: float, y0: float, patch: Patch, stack: Array, out: Array,
    count: int,
) -> int:  # fmt: skip
    """Minima of one cell: squares that could hold one are quartered, small ones start `descend`.

    A square matters where it could come nearer than `best`, a gap known to exist, and the window.

    Returns:
        Number of rows.
    """
    side = params[4]
    size = ring + tread
    leaf = 0.5 * max(min(0.5 * side, 0.25 * size), side / 1024.0) if size > 0.0 else 0.25 * side
    apart = 1e-3 * size
    n = 1
    stack[0, 0], stack[0, 1], stack[0, 2] = 0.5 * side, 0.5 * side, 0.5 * side
    while n > 0:
        n -= 1
        u, v, half = stack[n, 0], stack[n, 1], stack[n, 2]
        low = bound(form, frame, cx, cy, cz, ring, x0, y0, patch, u, v, half)
        least = min(best, out[0, 0]) if count > 0 else best
        limit = max(least, 0.0) + window + tread + 1e-12
        if low > limit:
            continue
        if half > 1.001 * leaf:
            for k in range(4):
                stack[n, 0] = u + (0.5 * half if k & 1 else -0.5 * half)
                stack[n, 1] = v + (0.5 * half if k & 2 else -0.5 * half)
                stack[n, 2] = 0.5 * half
                n += 1
            continue
        su, sv, far, good = descend(form, frame, cx, cy, cz, ring, x0, y0, side, patch, u, v)
        if far > limit:
            continue
        h = patch[0] + patch[1] * su + patch[2] * sv + patch[3] * su * sv
        found, rises = lowest(table, params, form, frame, cx, cy, cz, ring, x0 + su, y0 + sv, h)
        if good and rises:
            count = keep(out, count, found, tread, apart, window)
    return count


@formula
def search_cells(
    table: Array, params: Array, form: int, frame: Frame, cx: float, cy: float, cz: float, ring: float,
    tread: float, window: float, out: Array, count: int,
) -> int:  # fmt: skip
    """Rows of `out` anew, from every cell that could come as near to the shape's line as they do.

    They hold minima of the ground only; the least row of before stays where the cells show none as low. All
    stay where the line itself is at the ground or in it, where the distance to the surface is no smooth
    function of the place, and where more than `MOST_CELLS` lie under the shape.

    Returns:
        Number of rows.
    """
    if not out[0, 0] > ABOVE - tread:
        return count
    side = params[4]
    reach = max(out[0, 0], 0.0) + window + tread
    ax, ay, az = frame[0], frame[1], frame[2]
    if form == 1:
        ex, ey, ez = ring * abs(ax), ring * abs(ay), ring * abs(az)
    else:
        ex, ey = ring * math.sqrt(max(1.0 - ax * ax, 0.0)), ring * math.sqrt(max(1.0 - ay * ay, 0.0))
        ez = ring * math.sqrt(max(1.0 - az * az, 0.0))
    first_j = index((cx - ex - reach - params[2]) / side - 0.5)
    last_j = index((cx + ex + reach - params[2]) / side - 0.5)
    first_i = index((cy - ey - reach - params[3]) / side - 0.5)
    last_i = index((cy + ey + reach - params[3]) / side - 0.5)
    if (last_i - first_i + 1.0) * (last_j - first_j + 1.0) > MOST_CELLS:
        return count
    stack = np.empty((3 * DEEPEST + 4, 3))
    before = out[0].copy()
    count = 0
    bottom = cz - ez - reach
    for i in range(first_i, last_i + 1):
        _, _, z00 = node(table, params, i, first_j)
        _, _, z10 = node(table, params, i + 1, first_j)
        for j in range(first_j, last_j + 1):
            x0, y0, _ = node(table, params, i, j)
            _, _, z01 = node(table, params, i, j + 1)
            _, _, z11 = node(table, params, i + 1, j + 1)
            if max(z00, z01, z10, z11) >= bottom:
                twist = (z11 - z10 - z01 + z00) / (side * side)
                patch = (z00, (z01 - z00) / side, (z10 - z00) / side, twist)
                count = search_cell(
                    table, params, form, frame, cx, cy, cz, ring, tread, window, before[0], x0, y0, patch,
                    stack, out, count,
                )  # fmt: skip
            z00, z10 = z01, z11
    if count == 0 or out[0, 0] > before[0] + 1e-10:
        found = (before[1], before[2], before[3], before[4], before[5], before[6], before[0] + tread)
        count = keep(out, count, found, tread, 1e-3 * (ring + tread), window)
    return count
