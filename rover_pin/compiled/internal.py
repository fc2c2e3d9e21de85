"""Struts and tracks inside the kernels: rows by columns of the tree, brought to the free coordinates."""

from __future__ import annotations

from rover_pin.compiled.posed import Posed
from rover_pin.compiled.walk import place, turn
from rover_pin.compiled.work import Work
from rover_pin.mechanism.cable import pulls, taut
from rover_pin.mechanism.closure import push
from rover_pin.mechanism.columns import add_pulls, stretch
from rover_pin.numerics import Array, formula

COLUMN = 2
"""Column of the base's last coordinate; body b has column COLUMN + b."""


@formula
def columns(p: Posed, w: Work, cy: float, sy: float) -> None:
    """The tree at the walked pose as columns: height, pitch, roll, bodies; `rover_pin.mechanism.columns`."""
    ref = w.org[0]
    for k in range(3):
        w.turn[0, k] = w.move[0, k] = w.move[1, k] = w.move[2, k] = w.turn[1, k] = 0.0
        w.turn[2, k] = w.rot[0, k, 0]
    w.move[0, 2] = 1.0
    w.turn[1, 0], w.turn[1, 1] = -sy, cy
    for b in range(1, p.n_bodies):
        c = COLUMN + b
        ax, ay, az = w.rot[b, 0, 2], w.rot[b, 1, 2], w.rot[b, 2, 2]
        if p.turning[b]:
            rx, ry, rz = ref[0] - w.org[b, 0], ref[1] - w.org[b, 1], ref[2] - w.org[b, 2]
            w.turn[c, 0], w.turn[c, 1], w.turn[c, 2] = ax, ay, az
            w.move[c, 0] = ay * rz - az * ry
            w.move[c, 1] = az * rx - ax * rz
            w.move[c, 2] = ax * ry - ay * rx
        else:
            w.turn[c, 0] = w.turn[c, 1] = w.turn[c, 2] = 0.0
            w.move[c, 0], w.move[c, 1], w.move[c, 2] = ax, ay, az


@formula
def to_free(p: Posed, slope: Array, factor: float, row: Array) -> None:
    """A derivative by bodies' columns as a row (n,); an internal one does not hang on the base's columns."""
    n = p.n_free
    for k in range(n):
        row[k] = 0.0
    for b in range(1, p.n_bodies):
        value = factor * slope[COLUMN + b]
        if value != 0.0:
            for k in range(3, n):
                row[k] += value * p.basis[b, k]


@formula
def internal_rows(p: Posed, w: Work, cy: float, sy: float) -> None:
    """Slack and rows of struts' stops and of tracks; the struts' push goes off the load."""
    if p.n_struts + p.n_tracks == 0:
        return
    columns(p, w, cy, sy)
    first = p.n_shapes + p.n_stops
    for f in range(p.n_struts):
        length = strut_slope(p, w, f)
        force = push(length, p.struts[f, 0], p.struts[f, 1], p.struts[f, 2])
        row = first + f
        w.slack[row] = p.struts[f, 2] - length
        to_free(p, w.slope, -1.0, w.motion[row])
        for k in range(p.n_free):
            w.force[row, k] = w.motion[row, k]
            w.load[k] += force * w.motion[row, k]
    first += p.n_struts
    for t in range(p.n_tracks):
        row = first + t
        w.slack[row] = p.track_lengths[t] - wrap(p, w, t)
        start, stop, m = p.track_starts[t], p.track_starts[t + 1], COLUMN + p.n_bodies
        pull_circles(p, w, t)
        w.slope[:] = 0.0
        add_pulls(
            p.above[:m], w.turn, w.move, w.org[0], w.carriers[start:stop], w.circles[start:stop],
            w.world_pulls[start:stop], w.slope,
        )  # fmt: skip
        to_free(p, w.slope, 1.0, w.motion[row])
        for k in range(p.n_free):
            w.force[row, k] = w.motion[row, k]


@formula
def strut_slope(p: Posed, w: Work, f: int) -> float:
    """Length of strut f [m]; its derivative by columns in `w.slope`, its ends in `w.ends` and `w.tips`."""
    for e in range(2):
        b, local = p.strut_bodies[f, e], p.strut_origins[f, e]
        w.ends[e] = COLUMN + b
        w.tips[e, 0], w.tips[e, 1], w.tips[e, 2] = place(w.rot, w.org, b, local[0], local[1], local[2])
    m = COLUMN + p.n_bodies
    return stretch(p.above[:m], w.turn, w.move, w.org[0], w.ends, w.tips, w.slope)


@formula
def wrap(p: Posed, w: Work, t: int) -> float:
    """Shortest way around the circles of track t [m]: `w.following`, `w.spans`, `w.turns`."""
    a, axes = p.track_planes[t], p.track_axes[t]
    plane = w.plane[t]
    for c in range(3):
        plane[0, c], plane[1, c], plane[2, c] = turn(w.rot, a, axes[0, c], axes[1, c], axes[2, c])
    start, stop = p.track_starts[t], p.track_starts[t + 1]
    for i in range(start, stop):
        b, local = p.track_bodies[i], p.track_centers[i]
        x, y, z = place(w.rot, w.org, b, local[0], local[1], local[2])
        w.carriers[i] = COLUMN + b
        w.circles[i, 0], w.circles[i, 1], w.circles[i, 2] = x, y, z
        w.flat[i, 0] = x * plane[0, 0] + y * plane[1, 0] + z * plane[2, 0]
        w.flat[i, 1] = x * plane[0, 1] + y * plane[1, 1] + z * plane[2, 1]
    return taut(
        w.flat[start:stop], p.track_rho[start:stop], w.following[start:stop], w.spans[start:stop],
        w.turns[start:stop],
    )  # fmt: skip


@formula
def pull_circles(p: Posed, w: Work, t: int) -> None:
    """Forces of a unit tension of track t on its circles, world, in `w.world_pulls`."""
    start, stop = p.track_starts[t], p.track_starts[t + 1]
    pulls(w.following[start:stop], w.spans[start:stop], w.flat_pulls[start:stop])
    plane = w.plane[t]
    for i in range(start, stop):
        u, v = w.flat_pulls[i, 0], w.flat_pulls[i, 1]
        for k in range(3):
            w.world_pulls[i, k] = u * plane[k, 0] + v * plane[k, 1]
