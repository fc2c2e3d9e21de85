"""Residuals of a pose and its loads, recomputed inside the kernels by other formulas than the solver's.

Not the solver's: wrenches summed body by body up the tree instead of Jacobian rows, the distance of a contact
point to the ring in closed form instead of the tracked gap, the surface read at the point itself.
"""

from __future__ import annotations

from rover_pin.compiled.ground import Ground
from rover_pin.compiled.posed import Posed
from rover_pin.compiled.state import gravity_load
from rover_pin.compiled.walk import place, turn
from rover_pin.compiled.work import Work
from rover_pin.contact.place import distance
from rover_pin.mechanism.cable import OFF
from rover_pin.numerics import Array, formula, inlined
from rover_pin.terrain.surface import tabled


@inlined
def add_force(w: Work, b: int, x: float, y: float, z: float, fx: float, fy: float, fz: float) -> None:
    """Add a force [N] at a world point of body b to its wrench about the base's origin."""
    x, y, z = x - w.org[0, 0], y - w.org[0, 1], z - w.org[0, 2]
    w.wrench[b, 0] += fx
    w.wrench[b, 1] += fy
    w.wrench[b, 2] += fz
    w.wrench[b, 3] += y * fz - z * fy
    w.wrench[b, 4] += z * fx - x * fz
    w.wrench[b, 5] += x * fy - y * fx


@inlined
def equilibrium(p: Posed, w: Work, cy: float, sy: float) -> float:
    """Largest unbalanced generalised force: forces over weight, moments over weight times the wheels' span.

    Args:
        p: the machine.
        w: `wrench` holds what the ground gives to each body, `internal` (n,) the generalised force of stops,
            loops and springs; both are destroyed.
        cy: cosine of the yaw.
        sy: sine of the yaw.
    """
    bodies, n, internal = p.n_bodies, p.n_free, w.internal
    for b in range(bodies):
        mass = p.masses[b]
        if mass > 0.0:
            cx, cyy, cz = p.moments[b, 0] / mass, p.moments[b, 1] / mass, p.moments[b, 2] / mass
            x, y, z = place(w.rot, w.org, b, cx, cyy, cz)
            add_force(w, b, x, y, z, 0.0, 0.0, -mass * p.gravity)
    for b in range(bodies - 1, 0, -1):
        ax, ay, az = w.rot[b, 0, 2], w.rot[b, 1, 2], w.rot[b, 2, 2]
        fx, fy, fz = w.wrench[b, 0], w.wrench[b, 1], w.wrench[b, 2]
        value = ax * fx + ay * fy + az * fz
        if p.turning[b]:
            x, y, z = w.org[b, 0] - w.org[0, 0], w.org[b, 1] - w.org[0, 1], w.org[b, 2] - w.org[0, 2]
            mx, my = w.wrench[b, 3] - (y * fz - z * fy), w.wrench[b, 4] - (z * fx - x * fz)
            value = ax * mx + ay * my + az * (w.wrench[b, 5] - (x * fy - y * fx))
        for k in range(3, n):
            internal[k] += p.basis[b, k] * value
        for k in range(6):
            w.wrench[p.parents[b], k] += w.wrench[b, k]
    internal[0] += w.wrench[0, 2]
    internal[1] += cy * w.wrench[0, 4] - sy * w.wrench[0, 3]
    internal[2] += (
        w.rot[0, 0, 0] * w.wrench[0, 3] + w.rot[0, 1, 0] * w.wrench[0, 4] + w.rot[0, 2, 0] * w.wrench[0, 5]
    )
    worst = 0.0
    for k in range(n):
        worst = max(worst, abs(internal[k]) * p.units[k] / (p.weight * p.span))
    return worst


@inlined
def off_skin(p: Posed, ground: Ground, params: Array, table: Array, w: Work, s: int) -> float:
    """How far the contact point of shape s lies off the ground's surface or off the shape's skin [m]."""
    b = p.carriers[s]
    cx, cy, cz = place(w.rot, w.org, b, p.centers[s, 0], p.centers[s, 1], p.centers[s, 2])
    ax, ay, az = turn(w.rot, b, p.axes[s, 0], p.axes[s, 1], p.axes[s, 2])
    x, y, z = w.contacts[s, 1], w.contacts[s, 2], w.contacts[s, 3]
    off_surface = abs(tabled(ground.kind, table, params, x, y)[0] - z)
    frame = (ax, ay, az, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    away = distance(0, frame, cx, cy, cz, p.rings[s], x, y, z)
    worst: float = max(off_surface, abs(away - p.treads[s]))
    return worst


@formula
def recompute(
    p: Posed, ground: Ground, params: Array, table: Array, w: Work, z: Array, cy: float, sy: float,
    loads: Array, residuals: Array,
) -> None:  # fmt: skip
    """Loads (s,) [N] and residuals (4,) of a pose whose forces are known."""
    shapes, count, weight = p.n_shapes, w.n_touching, p.weight
    loads[:] = 0.0
    w.internal[:] = 0.0
    for b in range(p.n_bodies):
        for k in range(6):
            w.wrench[b, k] = 0.0
    gap, odd, opening = 0.0, 0.0, 0.0
    for i in range(shapes):
        odd = max(odd, -w.contacts[i, 0])
    gap = odd
    for i in range(count):
        row, force = w.touching[i], w.forces[i]
        odd = max(odd, abs(force * w.slack[row]) / weight)
        if row < shapes:
            loads[row] = force
            c = w.contacts
            add_force(w, p.carriers[row], c[row, 1], c[row, 2], c[row, 3], 0.0, 0.0, force)
            gap = max(gap, off_skin(p, ground, params, table, w, row))
        elif row >= shapes + p.n_stops + p.n_struts:
            track_forces(p, w, row - shapes - p.n_stops - p.n_struts, force)
        else:
            for k in range(p.n_free):
                w.internal[k] += force * w.force[row, k]
    for i in range(p.n_held_loops):
        for k in range(p.n_free):
            w.internal[k] += w.forces[count + i] * w.closing[p.held_loops[i], k]
    for k in range(p.n_loop_rows):
        opening = max(opening, abs(w.closure[k]))
    spring_forces(p, w, cy, sy)
    residuals[0] = equilibrium(p, w, cy, sy)
    residuals[1], residuals[2], residuals[3] = gap, opening, odd


@formula
def tensions(p: Posed, w: Work, out: Array) -> None:
    """Tension of every track (t,) [N]; 0 where it is slack."""
    first = p.n_shapes + p.n_stops + p.n_struts
    for t in range(p.n_tracks):
        out[t] = 0.0
        for i in range(w.n_touching):
            if w.touching[i] == first + t:
                out[t] = w.forces[i]


@inlined
def track_forces(p: Posed, w: Work, t: int, tension: float) -> None:
    """Add the pulls of a track's spans to the bodies, each where it leaves or meets its circle."""
    plane = w.plane[t]
    for a in range(p.track_starts[t], p.track_starts[t + 1]):
        if w.following[a] == OFF:
            continue
        b = p.track_starts[t] + w.following[a]
        tx, ty = w.spans[a, 0], w.spans[a, 1]
        for end in range(2):
            i = a if end == 0 else b
            rho, pull = p.track_rho[i], tension if end == 0 else -tension
            u, v = rho * ty, -rho * tx  # from the centre to where the span touches
            x = w.circles[i, 0] + u * plane[0, 0] + v * plane[0, 1]
            y = w.circles[i, 1] + u * plane[1, 0] + v * plane[1, 1]
            z = w.circles[i, 2] + u * plane[2, 0] + v * plane[2, 1]
            fx = pull * (tx * plane[0, 0] + ty * plane[0, 1])
            fy = pull * (tx * plane[1, 0] + ty * plane[1, 1])
            fz = pull * (tx * plane[2, 0] + ty * plane[2, 1])
            add_force(w, p.track_bodies[i], x, y, z, fx, fy, fz)


@inlined
def spring_forces(p: Posed, w: Work, cy: float, sy: float) -> None:
    """Add springs' generalised forces: what gravity alone would load less what is loaded."""
    if p.n_torsions > 0 or p.n_struts > 0:
        for k in range(p.n_free):
            w.internal[k] -= w.load[k]
        gravity_load(p, w, cy, sy)
        for k in range(p.n_free):
            w.internal[k] += w.load[k]
