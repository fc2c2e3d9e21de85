"""More looks about the places already found, and the sorted rows that hold them."""

from __future__ import annotations

import math

from rover_pin.contact.bilinear import nearest_node
from rover_pin.contact.nearest import Seven
from rover_pin.contact.place import Frame, distance, param_near
from rover_pin.contact.plane import put
from rover_pin.contact.refine import newton, refine
from rover_pin.numerics import Array, formula
from rover_pin.terrain.surface import surface


@formula
def probe(
    kind: int, table: Array, params: Array, spacing: float, form: int, frame: Frame, cx: float, cy: float,
    cz: float, ring: float, tread: float, window: float, out: Array, count: int,
) -> int:  # fmt: skip
    """Look for nearer ground about the least row, on 25 places half a spacing apart; refine what is found.

    A place's distance to the shape's line is known in closed form, so that no nearer place is missed there.

    Returns:
        Number of rows.
    """
    for _ in range(4):
        far = out[0, 0] + tread
        bx, by, bh, least = 0.0, 0.0, 0.0, far - 1e-9
        for i in range(-2, 3):
            for j in range(-2, 3):
                x, y = out[0, 1] + 0.5 * spacing * i, out[0, 2] + 0.5 * spacing * j
                h = surface(kind, table, params, x, y)[0]
                d = distance(form, frame, cx, cy, cz, ring, x, y, h)
                if d < least:
                    bx, by, bh, least = x, y, h, d
        if kind == 2:
            x, y, h, d = nearest_node(
                table, params, form, frame, cx, cy, cz, ring, ring + tread + abs(out[0, 0]), cx, cy
            )
            if d < least:
                bx, by, bh, least = x, y, h, d
        if least == far - 1e-9:
            break
        p = param_near(form, frame, cx, cy, cz, ring, bx, by, bh)
        found = refine(kind, table, params, spacing, form, frame, cx, cy, cz, ring, 0.1, p, bx, by)
        count = keep(out, count, found, tread, 1e-3 * (ring + tread), window)
        if out[0, 0] + tread >= far:
            break
    return count


@formula
def across(
    kind: int, table: Array, params: Array, form: int, frame: Frame, cx: float, cy: float, cz: float,
    ring: float, tread: float, window: float, out: Array, count: int,
) -> int:  # fmt: skip
    """On a bilinear map: look beyond the nearest lines of nodes for the other flank of a shallow valley.

    Both flanks can touch closer together than any sampling tells apart. Starts are the rows' places mirrored
    in the nearest line along x, along y, and in both.

    Returns:
        Number of rows.
    """
    for _ in range(3):
        before, had = out[0, 0], count
        for k in range(had):
            x, y = out[k, 1], out[k, 2]
            mx = 2.0 * (params[2] + params[4] * round((x - params[2]) / params[4])) - x
            my = 2.0 * (params[3] + params[4] * round((y - params[3]) / params[4])) - y
            for side in range(1, 4):
                sx = mx if side & 1 else x
                sy = my if side & 2 else y
                if (sx - x) ** 2 + (sy - y) ** 2 < 1e-12:
                    continue
                h = surface(kind, table, params, sx, sy)[0]
                p = param_near(form, frame, cx, cy, cz, ring, sx, sy, h)
                _, found, good = newton(kind, table, params, form, frame, cx, cy, cz, ring, 0.1, p, sx, sy)
                if good:
                    count = keep(out, count, found, tread, 1e-3 * (ring + tread), window)
        if count == had and out[0, 0] == before:
            break
    return count


@formula
def keep(out: Array, count: int, found: Seven, tread: float, apart: float, window: float) -> int:
    """Insert a minimum into the sorted rows of `out`; the same place found twice counts once.

    Returns:
        Number of rows.
    """
    wx, wy, wz, nx, ny, nz, far = found
    gap = far - tread
    if not math.isfinite(gap) or (count > 0 and gap > max(out[0, 0], 0.0) + window):
        return count
    near2 = max(apart, 1e-7) ** 2
    for k in range(count):
        if (out[k, 1] - wx) ** 2 + (out[k, 2] - wy) ** 2 + (out[k, 3] - wz) ** 2 < near2:
            if out[k, 0] <= gap:
                return count
            for m in range(k, count - 1):
                out[m] = out[m + 1]
            count -= 1
            break
    k = count
    if count == out.shape[0]:
        if gap >= out[count - 1, 0]:
            return count
        k = count - 1
    else:
        count += 1
    while k > 0 and out[k - 1, 0] > gap:
        out[k] = out[k - 1]
        k -= 1
    put(out, k, gap, wx, wy, wz, nx, ny, nz)
    while count > 1 and out[count - 1, 0] > max(out[0, 0], 0.0) + window:
        count -= 1
    return count
