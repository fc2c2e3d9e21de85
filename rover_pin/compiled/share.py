"""Forces of all that touches at a pose, as `rover_pin.statics.loads` has them."""

from __future__ import annotations

from rover_pin.compiled.elastic import least_forces
from rover_pin.compiled.internal import internal_rows
from rover_pin.compiled.linear import eliminate
from rover_pin.compiled.posed import Posed
from rover_pin.compiled.state import force_row, gravity_load, loop_rows, stop_rows, torsion_loads
from rover_pin.compiled.work import Work
from rover_pin.numerics import Array, formula
from rover_pin.statics.adapt import NOT_NEGATIVE
from rover_pin.statics.adapt import OPEN as PENETRATION
from rover_pin.statics.loads import STOPPED, TOUCHING


@formula
def share(p: Posed, w: Work, z: Array, cy: float, sy: float) -> int:
    """Multipliers of all that touches: `w.touching` and `w.forces`; loops' come after the supports'.

    Where supports are redundant, the least sum of squares over contacts.

    Returns:
        How redundant the supports are, -1 where the plain path has to say: a negative load, stops or loops
        among redundant supports, or other supports than those landed on.
    """
    n, shapes = p.n_free, p.n_shapes
    rows = shapes + p.n_stops + p.n_struts + p.n_tracks
    gravity_load(p, w, cy, sy)
    for i in range(3):
        w.com[i] = w.subtree[0, i] / w.masses[0]
    if p.n_torsions > 0:
        torsion_loads(p, w, z)
    if p.n_stops > 0:
        stop_rows(p, w, z)
    internal_rows(p, w, cy, sy)
    if p.n_loops > 0:
        loop_rows(p, w, cy, sy)
    count = 0
    for row in range(rows):
        if row >= shapes and not w.slack[row] >= PENETRATION:
            return -1
        if w.slack[row] <= (TOUCHING if row < shapes else STOPPED):
            if row < shapes:
                force_row(p, w, cy, sy, row)
            w.touching[count] = row
            for c in range(n):
                w.sides[count, c] = w.force[row, c]
            count += 1
    w.n_touching = count
    loops = p.n_held_loops
    for i in range(loops):
        for c in range(n):
            w.sides[count + i, c] = w.closing[p.held_loops[i], c]
    held = count + loops
    if held > n:
        if loops > 0 or w.touching[count - 1] >= shapes or not least_squares(p, w, held, n):
            return -1
    elif count != w.n_active:
        return -1
    elif held == n:
        for c in range(n):
            w.forces[c] = w.load[c]
            for i in range(n):
                w.system[c, i] = w.sides[i, c]
        if eliminate(w.system, w.forces, n) == 0.0:
            return -1
    elif not least_forces(p, w, held, w.forces):
        return -1
    for i in range(count):
        if w.forces[i] < NOT_NEGATIVE * p.weight:
            return -1
        w.forces[i] = max(w.forces[i], 0.0)
    redundant: int = max(held - n, 0)
    return redundant


@formula
def least_squares(p: Posed, w: Work, held: int, n: int) -> bool:
    """Forces of least squares that balance the load: sides y with sides' sides y = load, in scaled rows."""
    for r in range(n):
        w.right[r] = w.load[r] * p.units[r]
        for c in range(n):
            total = 0.0
            for i in range(held):
                total += w.sides[i, r] * w.sides[i, c]
            w.system[r, c] = total * p.units[r] * p.units[c]
    if eliminate(w.system, w.right, n) == 0.0:
        return False
    for i in range(held):
        w.forces[i] = 0.0
        for c in range(n):
            w.forces[i] += w.sides[i, c] * p.units[c] * w.right[c]
    return True
