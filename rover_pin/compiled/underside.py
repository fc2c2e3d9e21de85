"""Whether a belly or a link is in the ground: a bound that clears most poses, then every point."""

from __future__ import annotations

import math

from rover_pin.compiled.bounds import HEIGHT, Tiles, tile
from rover_pin.compiled.ground import Ground
from rover_pin.compiled.posed import Posed
from rover_pin.compiled.walk import place
from rover_pin.compiled.work import Work
from rover_pin.numerics import Array, formula
from rover_pin.terrain.surface import PLANE, tabled

CLEAR, IN_GROUND, UNKNOWN = 0, 1, 2

DEEP = -1e-9
"""m, above the ground: below this a point is in it, as on the plain path."""


@formula
def is_clear(p: Posed, ground: Ground, params: Array, table: Array, tiles: Tiles, w: Work) -> bool:
    """Whether every corner of the outlines is above all ground within reach of its body's outline.

    Outlines are ordered by body; on a plane corners are compared with the plane itself.
    """
    count, last = p.n_outline, ground.n_reaches - 1
    i = 0
    while i < count:
        b = p.outline_bodies[i]
        first, lowest, mx, my = i, math.inf, 0.0, 0.0
        while i < count and p.outline_bodies[i] == b:
            x, y, z = place(w.rot, w.org, b, p.outline[i, 0], p.outline[i, 1], p.outline[i, 2])
            if ground.kind == PLANE:
                z -= tabled(ground.kind, table, params, x, y)[0]
            lowest = min(lowest, z)
            mx, my = mx + x, my + y
            i += 1
        if ground.kind == PLANE:
            if lowest < 0.0:
                return False
            continue
        if ground.bounded == 0 or p.outline_fits == 0:
            return False
        row, column = tile(ground, tiles, mx / (i - first), my / (i - first))
        if not lowest > tiles[last, row, column, HEIGHT]:
            return False
    return True


@formula
def deepest(p: Posed, ground: Ground, params: Array, table: Array, skin: Array, w: Work) -> tuple[int, float]:
    """The point least above the ground and its height over it [m], its ball's radius off."""
    worst, least = -1, math.inf
    for k in range(p.n_skin):
        b = p.skin_bodies[k]
        for i in range(p.skin_starts[k], p.skin_starts[k + 1]):
            px, py, pz = skin[i, 0], skin[i, 1], skin[i, 2]
            r, o = p.skin_rotations[k], p.skin_origins[k]
            x, y, z = place(
                w.rot, w.org, b,
                o[0] + r[0, 0] * px + r[0, 1] * py + r[0, 2] * pz,
                o[1] + r[1, 0] * px + r[1, 1] * py + r[1, 2] * pz,
                o[2] + r[2, 0] * px + r[2, 1] * py + r[2, 2] * pz,
            )  # fmt: skip
            above = z - skin[i, 3] - tabled(ground.kind, table, params, x, y)[0]
            if above < least:
                worst, least = i, above
    return worst, least


@formula
def look_below(
    p: Posed, ground: Ground, params: Array, table: Array, tiles: Tiles, skin: Array, w: Work
) -> tuple[int, int, float]:
    """CLEAR, IN_GROUND or UNKNOWN; the deepest point and how deep it is [m].

    Args:
        p: the machine.
        ground: the surface.
        params: its parameters.
        table: its table.
        tiles: its bounds.
        skin: (h, 4) points in the joint frames of `p.skin_bodies`, and their radii [m].
        w: holds the frames of a pose.
    """
    if p.n_outline == 0 or is_clear(p, ground, params, table, tiles, w):
        return CLEAR, -1, 0.0
    if p.skin_known == 0:
        return UNKNOWN, -1, 0.0
    worst, above = deepest(p, ground, params, table, skin, w)
    if above < DEEP:
        return IN_GROUND, worst, -above
    return CLEAR, -1, 0.0
