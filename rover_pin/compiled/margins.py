"""The cheap measures of a settled case, by the formulas of `rover_pin.stability.measures`."""

from __future__ import annotations

from rover_pin.compiled.ground import Ground
from rover_pin.compiled.hull import hull
from rover_pin.compiled.posed import Posed
from rover_pin.compiled.walk import place
from rover_pin.compiled.work import Work
from rover_pin.numerics import Array, inlined
from rover_pin.stability.measures.energy import energy_height
from rover_pin.stability.measures.force_angle import force_angle
from rover_pin.stability.measures.polygon import edge_distance
from rover_pin.stability.measures.tip import tip_angle
from rover_pin.terrain.surface import tabled

ON_EDGES = ("polygon", "tip", "force_angle", "energy", "zmp")
"""Measures whose edges are the support polygon's, in the order of the kernels."""


@inlined
def polygon(p: Posed, w: Work) -> int:
    """Corners of the support polygon in `w.corners`, as shapes; how many."""
    count = 0
    for i in range(w.n_touching):
        if w.touching[i] < p.n_shapes:
            w.chosen[count] = w.touching[i]
            count += 1
    return hull(w.contacts, w.chosen, count, w.corners)


@inlined
def on_edges(p: Posed, w: Work, corners: int, loads: Array, edges: Array) -> None:
    """Every measure of ON_EDGES along every edge of the polygon.

    Args:
        p: the machine.
        w: holds contacts, corners and the centre of mass.
        corners: how many.
        loads: (s,) N.
        edges: (5, s) receives the margins.
    """
    c = w.contacts
    force, about_x, about_y = 0.0, 0.0, 0.0
    for s in range(p.n_shapes):
        force += loads[s]
        about_x += c[s, 2] * loads[s]
        about_y += c[s, 1] * loads[s]
    zx, zy = about_y / force, about_x / force
    x, y, z = w.com[0], w.com[1], w.com[2]
    for i in range(corners):
        a, b = w.corners[i], w.corners[i + 1 if i + 1 < corners else 0]
        ax, ay, az = c[a, 1], c[a, 2], c[a, 3]
        bx, by, bz = c[b, 1], c[b, 2], c[b, 3]
        edges[0, i] = edge_distance(ax, ay, bx, by, x, y)
        edges[1, i] = tip_angle(ax, ay, az, bx, by, bz, x, y, z)
        edges[2, i] = force_angle(ax, ay, az, bx, by, bz, x, y, z, p.weight)
        edges[3, i] = energy_height(ax, ay, az, bx, by, bz, x, y, z)
        edges[4, i] = edge_distance(ax, ay, bx, by, zx, zy)


@inlined
def least(values: Array, count: int) -> int:
    """Index of the least of the first `count` values; -1 where there are none."""
    best = -1
    for i in range(count):
        if best < 0 or values[i] < values[best]:
            best = i
    return best


@inlined
def heights(p: Posed, ground: Ground, params: Array, table: Array, w: Work, out: Array) -> None:
    """Height of every belly point over the ground below it [m], (p,)."""
    for i in range(p.n_belly):
        x, y, z = place(w.rot, w.org, p.belly_bodies[i], p.belly[i, 0], p.belly[i, 1], p.belly[i, 2])
        out[i] = z - tabled(ground.kind, table, params, x, y)[0]
