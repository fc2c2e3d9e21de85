"""Where shapes touch the terrain: the least gap and every separate place near it."""

from __future__ import annotations

import math

import numpy as np

from rover_pin.contact.place import basis
from rover_pin.contact.plane import plane_contacts, put
from rover_pin.contact.refine import nested, newton
from rover_pin.contact.skin import clearances, hollow, lattice, skin_point
from rover_pin.numerics import formula
from rover_pin.terrain.surface import surface

MOST_SEEDS = 12


@formula
def search_skin(kind, table, params, spacing, form, frame, cx, cy, cz, ring, tread, ball, window, out, count):  # type: ignore[no-untyped-def]
    """Look over the tube of radius `ball` about the shape's line, refine its hollows, add them to `out`.

    A hollow is refined where its estimate is within the window of the least one, plus what an estimate can
    be wrong by. Returns the number of rows.
    """
    grid = lattice(kind, spacing, form, frame, ring, ball)
    near = clearances(kind, table, params, form, frame, cx, cy, cz, ring, ball, grid)
    rows, columns = grid[0], grid[1]
    closed, arc = grid[6], (grid[4] if form == 1 else grid[4] * (ring + ball))
    least = near.min()
    if not least < math.inf:
        return count
    limit = least + window + 0.3 * arc + 0.15 * ball + 0.3 * abs(least)
    seeds = np.empty((MOST_SEEDS, 3))
    n = 0
    for i in range(rows):
        for j in range(columns):
            if near[i, j] <= limit and hollow(near, i, j, closed):
                k = n if n < MOST_SEEDS else MOST_SEEDS - 1
                if n >= MOST_SEEDS and near[i, j] >= seeds[k, 0]:
                    continue
                while k > 0 and seeds[k - 1, 0] > near[i, j]:
                    seeds[k] = seeds[k - 1]
                    k -= 1
                seeds[k, 0], seeds[k, 1], seeds[k, 2] = near[i, j], i, j
                n = min(n + 1, MOST_SEEDS)
    for k in range(n):
        i, j = int(seeds[k, 1]), int(seeds[k, 2])
        p, x, y, _, _ = skin_point(form, frame, cx, cy, cz, ring, ball, grid, i, j)
        found = refine(kind, table, params, spacing, form, frame, cx, cy, cz, ring, grid[4], p, x, y)
        count = keep(out, count, found, tread, 1e-3 * (ring + tread), window)
    return count


@formula
def refine(kind, table, params, spacing, form, frame, cx, cy, cz, ring, width, p, x, y):  # type: ignore[no-untyped-def]
    """The minimum near a seed: Newton, else the nested search. W (3), n (3), signed distance."""
    _, found, good = newton(kind, table, params, form, frame, cx, cy, cz, ring, width, p, x, y)
    if not good:
        _, found = nested(kind, table, params, spacing, form, frame, cx, cy, cz, ring, width, p, x, y)
    return found


@formula
def keep(out, count, found, tread, apart, window):  # type: ignore[no-untyped-def]
    """Insert a minimum into the sorted rows of `out`; the same place found twice counts once.

    Returns:
        Number of rows.
    """
    wx, wy, wz, nx, ny, nz, far = found
    gap = far - tread
    if not math.isfinite(gap) or (count > 0 and gap > out[0, 0] + window):
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
    while count > 1 and out[count - 1, 0] > out[0, 0] + window:
        count -= 1
    return count


@formula
def find_contacts(kind, table, params, spacing, form, center, axis, ring, tread, window, out):  # type: ignore[no-untyped-def]
    """Contacts of one shape with the terrain, sorted by gap.

    Args:
        kind: terrain kind.
        table: terrain table.
        params: terrain parameters.
        spacing: terrain's feature size, m.
        form: 0 ring, 1 segment.
        center: (3,) m, world.
        axis: (3,) unit, world.
        ring: radius of the ring or half length of the segment, m.
        tread: radius of the ball swept along it, m.
        window: m; how far above the least gap further minima are told.
        out: (K, 7) receives gap, point on the surface, unit normal (out of the ground).

    Returns:
        Number of rows written, at least 1.
    """
    if kind == 0:
        return plane_contacts(kind, table, params, form, center, axis, ring, tread, window, out)
    cx, cy, cz = center[0], center[1], center[2]
    frame = basis(form, ring, axis[0], axis[1], axis[2])
    count = search_skin(
        kind, table, params, spacing, form, frame, cx, cy, cz, ring, tread, tread, window, out, 0
    )
    size = ring + tread
    if count > 0 and abs(out[0, 0]) > 0.02 * min(spacing, max(size, 0.1)) and out[0, 0] > -tread:
        ball = tread + out[0, 0]
        count = search_skin(
            kind, table, params, spacing, form, frame, cx, cy, cz, ring, tread, ball, window, out, count
        )
    if count == 0:
        h, hx, hy, _, _, _ = surface(kind, table, params, cx, cy)
        s = 1.0 / math.sqrt(1.0 + hx * hx + hy * hy)
        put(out, 0, (cz - h) * s - ring - tread, cx, cy, h, -hx * s, -hy * s, s)
        count = 1
    return count


@formula
def find_all(kind, table, params, spacing, forms, centers, axes, rings, treads, window, out, counts):  # type: ignore[no-untyped-def]
    """`find_contacts` for every shape.

    Args:
        kind: terrain kind.
        table: terrain table.
        params: terrain parameters.
        spacing: terrain's feature size, m.
        forms: (m,) int.
        centers: (m, 3) m, world.
        axes: (m, 3) unit, world.
        rings: (m,) m.
        treads: (m,) m.
        window: m.
        out: (m, K, 7) receives the rows.
        counts: (m,) int, receives how many of them.
    """
    for i in range(forms.shape[0]):
        counts[i] = find_contacts(
            kind, table, params, spacing, forms[i], centers[i], axes[i], rings[i], treads[i], window, out[i]
        )
