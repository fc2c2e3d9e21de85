"""The equations of standing at one pose: contacts, rows, loops and loads, as in the plain path's `State`."""

from __future__ import annotations

import math

import numpy as np

from rover_pin.compiled.ground import Ground
from rover_pin.compiled.posed import Posed
from rover_pin.compiled.search import Search
from rover_pin.compiled.track import track
from rover_pin.compiled.walk import place, point_row, turn, turn_row
from rover_pin.compiled.work import CONTACTS, Work
from rover_pin.mechanism.closure import SIZES, close, torque
from rover_pin.numerics import Array, formula, inlined


@inlined
def follow_contact(p: Posed, ground: Ground, params: Array, table: Array, w: Work, s: int) -> float:
    """Contact of shape s one Newton step from its last place; how far that moved [m]."""
    b = p.carriers[s]
    cx, cy, cz = place(w.rot, w.org, b, p.centers[s, 0], p.centers[s, 1], p.centers[s, 2])
    ax, ay, az = turn(w.rot, b, p.axes[s, 0], p.axes[s, 1], p.axes[s, 2])
    gap, x, y, h, nx, ny, nz, size = track(
        ground.kind, table, params, cx, cy, cz, ax, ay, az, p.rings[s], p.treads[s], w.places[s, 0],
        w.places[s, 1],
    )  # fmt: skip
    c = w.contacts
    c[s, 0], c[s, 1], c[s, 2], c[s, 3], c[s, 4], c[s, 5], c[s, 6] = gap, x, y, h, nx, ny, nz
    w.places[s, 0], w.places[s, 1] = x, y
    return size


@formula
def search_contact(
    p: Posed, ground: Ground, params: Array, table: Array, search: Search, w: Work, s: int, window: float
) -> int:
    """Least contact of shape s by the plain path's search; further ones up to `window` are in `w.found`.

    Returns:
        Number of contacts.
    """
    b = p.carriers[s]
    center, axis, found = np.empty(3), np.empty(3), np.empty((CONTACTS, 7))
    center[0], center[1], center[2] = place(
        w.rot, w.org, b, p.centers[s, 0], p.centers[s, 1], p.centers[s, 2]
    )
    axis[0], axis[1], axis[2] = turn(w.rot, b, p.axes[s, 0], p.axes[s, 1], p.axes[s, 2])
    count: int = search(
        ground.kind, table, params, ground.spacing, center, axis, p.rings[s], p.treads[s], window, found
    )
    w.found[:] = found
    for k in range(7):
        w.contacts[s, k] = found[0, k]
    w.places[s, 0], w.places[s, 1] = w.found[0, 1], w.found[0, 2]
    return count


@inlined
def start_contacts(p: Posed, w: Work) -> None:
    """Start looking for every contact below the shape's centre."""
    for s in range(p.n_shapes):
        x, y, _ = place(w.rot, w.org, p.carriers[s], p.centers[s, 0], p.centers[s, 1], p.centers[s, 2])
        w.places[s, 0], w.places[s, 1] = x, y


@inlined
def gap_row(p: Posed, w: Work, cy: float, sy: float, s: int, row: Array) -> None:
    """Gradient of shape s's gap (n,): the velocity of its contact point along the normal."""
    c = w.contacts
    for k in range(p.n_free):
        row[k] = 0.0
    point_row(
        p, w.rot, w.org, cy, sy, p.carriers[s], c[s, 1], c[s, 2], c[s, 3], c[s, 4], c[s, 5], c[s, 6], 1.0, row
    )  # fmt: skip


@inlined
def force_row(p: Posed, w: Work, cy: float, sy: float, s: int) -> None:
    """Generalised force of a unit load against gravity at shape s's contact: the vertical velocity row."""
    c = w.contacts
    row = w.force[s]
    for k in range(p.n_free):
        row[k] = 0.0
    point_row(p, w.rot, w.org, cy, sy, p.carriers[s], c[s, 1], c[s, 2], c[s, 3], 0.0, 0.0, 1.0, 1.0, row)


@inlined
def coordinate(p: Posed, w: Work, b: int, z: Array) -> float:
    """The coordinate of body b's joint at z [rad or m]."""
    q: float = p.offsets[b]
    for k in range(3, p.n_free):
        q += p.basis[b, k] * z[k]
    return q


@inlined
def stop_rows(p: Posed, w: Work, z: Array) -> None:
    """Slack and gradient of joints' stops: sign (limit - q)."""
    first = p.n_shapes
    for k in range(p.n_stops):
        b, sign = p.stop_bodies[k], p.stop_signs[k]
        w.slack[first + k] = sign * (p.stop_limits[k] - coordinate(p, w, b, z))
        for c in range(p.n_free):
            w.motion[first + k, c] = -sign * p.basis[b, c]
            w.force[first + k, c] = w.motion[first + k, c]


@formula
def _point_jacobian(
    p: Posed, w: Work, cy: float, sy: float, b: int, local: Array, e: int, jacobian: Array
) -> None:
    """World place of a body's point in `w.origin[e]`, and rows 0 to 2 of its Jacobian along world axes."""
    x, y, z = place(w.rot, w.org, b, local[0], local[1], local[2])
    w.origin[e, 0], w.origin[e, 1], w.origin[e, 2] = x, y, z
    jacobian[:3] = 0.0
    point_row(p, w.rot, w.org, cy, sy, b, x, y, z, 1.0, 0.0, 0.0, 1.0, jacobian[0])
    point_row(p, w.rot, w.org, cy, sy, b, x, y, z, 0.0, 1.0, 0.0, 1.0, jacobian[1])
    point_row(p, w.rot, w.org, cy, sy, b, x, y, z, 0.0, 0.0, 1.0, 1.0, jacobian[2])


@formula
def loop_rows(p: Posed, w: Work, cy: float, sy: float) -> None:
    """Residual and Jacobian of every loop."""
    for i in range(p.n_loops):
        for e in range(2):
            b = p.loop_bodies[i, e]
            jacobian = w.first if e == 0 else w.second
            _point_jacobian(p, w, cy, sy, b, p.loop_origins[i, e], e, jacobian)
            jacobian[3:] = 0.0
            turn_row(p, w.rot, cy, sy, b, 1.0, 0.0, 0.0, jacobian[3])
            turn_row(p, w.rot, cy, sy, b, 0.0, 1.0, 0.0, jacobian[4])
            turn_row(p, w.rot, cy, sy, b, 0.0, 0.0, 1.0, jacobian[5])
            for c in range(3):
                r = p.loop_rotations[i, e]
                x, y, z = turn(w.rot, b, r[0, c], r[1, c], r[2, c])
                w.frame[e, 0, c], w.frame[e, 1, c], w.frame[e, 2, c] = x, y, z
        start = p.loop_starts[i]
        stop = start + SIZES[p.loop_kinds[i]]
        close(
            p.loop_kinds[i], p.loop_across[i], p.loop_lengths[i], w.origin[0], w.frame[0], w.first,
            w.origin[1], w.frame[1], w.second, w.closure[start:stop], w.closing[start:stop],
        )  # fmt: skip


@inlined
def gravity_load(p: Posed, w: Work, cy: float, sy: float) -> None:
    """What the supports must carry of the weight, per free coordinate: subtree by subtree."""
    bodies, n = p.n_bodies, p.n_free
    for b in range(bodies):
        x, y, z = turn(w.rot, b, p.moments[b, 0], p.moments[b, 1], p.moments[b, 2])
        mass = p.masses[b]
        w.masses[b] = mass
        w.subtree[b, 0], w.subtree[b, 1] = x + mass * w.org[b, 0], y + mass * w.org[b, 1]
        w.subtree[b, 2] = z + mass * w.org[b, 2]
    w.load[:] = 0.0
    for b in range(bodies - 1, 0, -1):
        a, mass = p.parents[b], w.masses[b]
        if p.turning[b]:
            rx, ry = w.subtree[b, 0] - mass * w.org[b, 0], w.subtree[b, 1] - mass * w.org[b, 1]
            value = w.rot[b, 0, 2] * ry - w.rot[b, 1, 2] * rx
        else:
            value = w.rot[b, 2, 2] * mass
        for k in range(3, n):
            w.load[k] += p.basis[b, k] * value * p.gravity
        w.masses[a] += mass
        for i in range(3):
            w.subtree[a, i] += w.subtree[b, i]
    rx, ry = w.subtree[0, 0] - w.masses[0] * w.org[0, 0], w.subtree[0, 1] - w.masses[0] * w.org[0, 1]
    w.load[0] = w.masses[0] * p.gravity
    w.load[1] = (-sy * ry - cy * rx) * p.gravity
    w.load[2] = (w.rot[0, 0, 0] * ry - w.rot[0, 1, 0] * rx) * p.gravity


@inlined
def torsion_loads(p: Posed, w: Work, z: Array) -> None:
    """Joint springs' torques go off the load."""
    for k in range(p.n_torsions):
        b = p.torsion_bodies[k]
        effort = torque(coordinate(p, w, b, z), p.torsions[k, 0], p.torsions[k, 1], p.torsions[k, 2])
        for c in range(3, p.n_free):
            w.load[c] -= effort * p.basis[b, c]


@inlined
def tilt_cosine(z: Array) -> float:
    """Cosine of the angle between the base's z axis and the vertical."""
    return math.cos(z[1]) * math.cos(z[2])
