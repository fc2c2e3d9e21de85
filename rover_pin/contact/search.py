"""Where shapes touch the terrain: the least gap and every separate place near it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rover_pin.contact.cells import search_cells
from rover_pin.contact.place import Frame, basis
from rover_pin.contact.plane import plane_contacts, put
from rover_pin.contact.probe import across, keep, probe
from rover_pin.contact.refine import refine
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
    grid = lattice(kind, spacing, form, frame, ring, ball, window > 0.0)
    near = np.empty((grid[0], grid[1]))
    least = clearances(kind, table, params, form, frame, cx, cy, cz, ring, ball, grid, window, near)
    if not least < math.inf:
        return count
    seeds = np.empty((MOST_SEEDS, 3))
    n = seek(near, max(least, 0.0) + slack(window, grid[7], ball, least), grid[6], seeds)
    for k in range(n):
        i, j = int(seeds[k, 1]), int(seeds[k, 2])
        p, x, y, _, _ = skin_point(form, frame, cx, cy, cz, ring, ball, grid, i, j)
        found = refine(kind, table, params, spacing, form, frame, cx, cy, cz, ring, grid[4], p, x, y)
        count = keep(out, count, found, tread, 1e-3 * (ring + tread), window)
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
        window: m; further minima are told up to this above the least gap, or above zero where that is less.
            At 0 only the least is asked for, and the look is coarser: two dips that differ by less than a
            thousandth of the spacing may be taken for one.
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
    if count > 0 and abs(out[0, 0]) > 0.02 * min(spacing, max(size, 0.1)):
        ball = max(tread + out[0, 0], 0.0)
        count = search_skin(
            kind, table, params, spacing, form, frame, cx, cy, cz, ring, tread, ball, window, out, count
        )
    if count > 0 and kind != 3 and out[0, 0] > -tread and spacing < 2.0 * (size + out[0, 0]):
        count = probe(kind, table, params, spacing, form, frame, cx, cy, cz, ring, tread, window, out, count)
    if kind == 2:
        count = across(kind, table, params, form, frame, cx, cy, cz, ring, tread, window, out, count)
        if window > 0.0 and count > 0:
            count = search_cells(table, params, form, frame, cx, cy, cz, ring, tread, window, out, count)
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
