"""Where shapes touch the terrain: the least gap and every separate place near it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rover_pin.contact.nearest import Seven
from rover_pin.contact.place import Frame, basis, param_near, place
from rover_pin.contact.plane import plane_contacts, put
from rover_pin.contact.refine import nested, newton
from rover_pin.contact.skin import clearances, hollow, lattice, skin_point, slack
from rover_pin.numerics import Array, formula
from rover_pin.terrain.surface import surface

MOST_SEEDS = 12

Integers = NDArray[np.int64]


@formula
def seek(near: Array, limit: float, closed: bool, seeds: Array) -> int:
    """The hollows of `near` up to `limit`, lowest first: rows (estimate, i, j) of `seeds`; how many."""
    n = 0
    most = seeds.shape[0]
    for i in range(near.shape[0]):
        for j in range(near.shape[1]):
            if not (near[i, j] <= limit and hollow(near, i, j, closed)):
                continue
            if n == most and near[i, j] >= seeds[n - 1, 0]:
                continue
            n = min(n + 1, most)
            k = n - 1
            while k > 0 and seeds[k - 1, 0] > near[i, j]:
                seeds[k] = seeds[k - 1]
                k -= 1
            seeds[k, 0], seeds[k, 1], seeds[k, 2] = near[i, j], i, j
    return n


@formula
def search_skin(
    kind: int, table: Array, params: Array, spacing: float, form: int, frame: Frame, cx: float, cy: float,
    cz: float, ring: float, tread: float, ball: float, window: float, out: Array, count: int,
) -> int:  # fmt: skip
    """Look over the tube of radius `ball` about the shape's line, refine its hollows, add them to `out`.

    Returns:
        Number of rows.
    """
    grid = lattice(kind, spacing, form, frame, ring, ball)
    near = np.empty((grid[0], grid[1]))
    least = clearances(kind, table, params, form, frame, cx, cy, cz, ring, ball, grid, window, near)
    if not least < math.inf:
        return count
    seeds = np.empty((MOST_SEEDS, 3))
    n = seek(near, least + slack(window, grid[7], ball, least), grid[6], seeds)
    for k in range(n):
        i, j = int(seeds[k, 1]), int(seeds[k, 2])
        p, x, y, _, _ = skin_point(form, frame, cx, cy, cz, ring, ball, grid, i, j)
        found = refine(kind, table, params, spacing, form, frame, cx, cy, cz, ring, grid[4], p, x, y)
        count = keep(out, count, found, tread, 1e-3 * (ring + tread), window)
    return count


@formula
def refine(
    kind: int, table: Array, params: Array, spacing: float, form: int, frame: Frame, cx: float, cy: float,
    cz: float, ring: float, width: float, p: float, x: float, y: float,
) -> Seven:  # fmt: skip
    """The minimum near a seed: Newton's, unless that is no minimum or farther than the seed, else `nested`'s.

    Returns:
        W (3), n (3), signed distance.
    """
    _, found, good = newton(kind, table, params, form, frame, cx, cy, cz, ring, width, p, x, y)
    px, py, pz, _, _, _, _, _, _ = place(form, frame, cx, cy, cz, ring, p)
    h = surface(kind, table, params, x, y)[0]
    start = math.sqrt((px - x) ** 2 + (py - y) ** 2 + (pz - h) ** 2)
    if good and (found[6] <= start or pz < h):
        return found
    _, found = nested(kind, table, params, spacing, form, frame, cx, cy, cz, ring, width, p, x, y)
    return found


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
        bx, by, bp, least = 0.0, 0.0, 0.0, far - 1e-9
        for i in range(-2, 3):
            for j in range(-2, 3):
                x, y = out[0, 1] + 0.5 * spacing * i, out[0, 2] + 0.5 * spacing * j
                h = surface(kind, table, params, x, y)[0]
                p, d = param_near(form, frame, cx, cy, cz, ring, x, y, h)
                if d < least:
                    bx, by, bp, least = x, y, p, d
        if least == far - 1e-9:
            break
        found = refine(kind, table, params, spacing, form, frame, cx, cy, cz, ring, 0.1, bp, bx, by)
        count = keep(out, count, found, tread, 1e-3 * (ring + tread), window)
        if out[0, 0] + tread >= far:
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
def find_contacts(
    kind: int, table: Array, params: Array, spacing: float, form: int, center: Array, axis: Array,
    ring: float, tread: float, window: float, out: Array,
) -> int:  # fmt: skip
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
    if count > 0 and kind != 3 and out[0, 0] > -tread and spacing < 2.0 * (size + out[0, 0]):
        count = probe(kind, table, params, spacing, form, frame, cx, cy, cz, ring, tread, window, out, count)
    if count == 0:
        h, hx, hy, _, _, _ = surface(kind, table, params, cx, cy)
        s = 1.0 / math.sqrt(1.0 + hx * hx + hy * hy)
        put(out, 0, (cz - h) * s - ring - tread, cx, cy, h, -hx * s, -hy * s, s)
        count = 1
    return count


@formula
def find_all(
    kind: int, table: Array, params: Array, spacing: float, forms: Integers, centers: Array, axes: Array,
    rings: Array, treads: Array, window: float, out: Array, counts: Integers,
) -> None:  # fmt: skip
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
