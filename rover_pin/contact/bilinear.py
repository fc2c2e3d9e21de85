"""Nodes and edges of a bilinear map: the creases that a nearest point can sit on, in closed form."""

from __future__ import annotations

import math

from rover_pin.contact.nearest import Seven, nearest
from rover_pin.contact.place import Frame, distance
from rover_pin.numerics import Array, formula

AROUND = 2


@formula
def node(table: Array, params: Array, i: int, j: int) -> tuple[float, float, float]:
    """Node of row i, column j, m; params as for LINEAR in `rover_pin.terrain.surface`.

    Beyond the map the border's heights go on, as on the surface, and so do nodes and creases.
    """
    x, y = params[2] + params[4] * j, params[3] + params[4] * i
    row = min(max(i, 0), table.shape[0] - 1)
    column = min(max(j, 0), table.shape[1] - 1)
    return x, y, params[0] + params[1] * table[row, column]


@formula
def on_edge(
    ax: float, ay: float, az: float, bx: float, by: float, bz: float, px: float, py: float, pz: float
) -> tuple[float, float, float, float]:
    """Point of the segment a-b nearest to P, and its squared distance."""
    ux, uy, uz = bx - ax, by - ay, bz - az
    t = ((px - ax) * ux + (py - ay) * uy + (pz - az) * uz) / (ux * ux + uy * uy + uz * uz)
    t = min(max(t, 0.0), 1.0)
    x, y, z = ax + t * ux, ay + t * uy, az + t * uz
    return x, y, z, (px - x) ** 2 + (py - y) ** 2 + (pz - z) ** 2


@formula
def index(value: float) -> int:
    """The index nearest to `value`, kept within what an integer holds."""
    return int(min(max(math.floor(value + 0.5), -1e9), 1e9))


@formula
def nearest_crease(
    table: Array, params: Array, px: float, py: float, pz: float, x: float, y: float
) -> tuple[float, float, float, float]:
    """The point nearest to P on nodes and edges within two cells of (x, y), and its distance [m]."""
    ci = index((y - params[3]) / params[4])
    cj = index((x - params[2]) / params[4])
    wx, wy, wz, least = x, y, pz, math.inf
    for i in range(ci - AROUND, ci + AROUND + 1):
        for j in range(cj - AROUND, cj + AROUND + 1):
            ax, ay, az = node(table, params, i, j)
            bx, by, bz = node(table, params, i, j + 1)
            ex, ey, ez, far = on_edge(ax, ay, az, bx, by, bz, px, py, pz)
            if far < least:
                wx, wy, wz, least = ex, ey, ez, far
            bx, by, bz = node(table, params, i + 1, j)
            ex, ey, ez, far = on_edge(ax, ay, az, bx, by, bz, px, py, pz)
            if far < least:
                wx, wy, wz, least = ex, ey, ez, far
    return wx, wy, wz, math.sqrt(least)


@formula
def touch_bilinear(
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
    """Nearest point of a bilinear map near (x, y) to a P above it: faces, edges and nodes.

    The nearest crease within two cells, and the faces about it and about (x, y) as far as they hold a nearest
    point of their own.

    Returns:
        W (3), n (3), distance; n the direction from W to P where W is on a crease.
    """
    wx, wy, wz, far = nearest_crease(table, params, px, py, pz, x, y)
    best, smooth = nearest(kind, table, params, spacing, px, py, pz, x, y)
    least = best[6] if smooth and best[6] >= 0.0 else math.inf
    e = 1e-3 * spacing
    for k in range(4):
        sx = wx + (e if k & 1 else -e)
        sy = wy + (e if k & 2 else -e)
        face, smooth = nearest(kind, table, params, spacing, px, py, pz, sx, sy)
        if smooth and 0.0 <= face[6] < least:
            best, least = face, face[6]
    if far < least + 1e-13 and far > 1e-9:
        return wx, wy, wz, (px - wx) / far, (py - wy) / far, (pz - wz) / far, far
    return best


@formula
def nearest_node(
    table: Array,
    params: Array,
    form: int,
    frame: Frame,
    cx: float,
    cy: float,
    cz: float,
    ring: float,
    reach: float,
    x: float,
    y: float,
) -> tuple[float, float, float, float]:
    """The node nearest to a shape's line and its distance, of those within `reach` of (x, y) along x and y.

    A node that stands up between two samples is not overlooked.
    """
    n = min(reach / params[4], 40.0)
    u, v = (x - params[2]) / params[4], (y - params[3]) / params[4]
    bx, by, bz, least = x, y, 0.0, math.inf
    for i in range(index(v - n), index(v + n) + 1):
        for j in range(index(u - n), index(u + n) + 1):
            wx, wy, wz = node(table, params, i, j)
            far = distance(form, frame, cx, cy, cz, ring, wx, wy, wz)
            if far < least:
                bx, by, bz, least = wx, wy, wz, far
    return bx, by, bz, least
