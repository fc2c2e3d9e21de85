"""Where supports alone do not determine the pose: the stiffness of springs and weight decides with them."""

from __future__ import annotations

from rover_pin.compiled.ground import Ground
from rover_pin.compiled.linear import eliminate, is_positive, null_basis
from rover_pin.compiled.posed import Posed
from rover_pin.compiled.state import (
    follow_contact,
    force_row,
    gap_row,
    gravity_load,
    loop_rows,
    stop_rows,
    strut_rows,
    torsion_loads,
)
from rover_pin.compiled.walk import walk
from rover_pin.compiled.work import Work
from rover_pin.numerics import Array, formula

DIFFERENCE = 1e-6
"""Share of the span, or rad: step of the central differences, as on the plain path."""

STEADY = 1e-9
"""Share of weight times span, per rad: a stiffness above this resists."""


@formula
def held_forces(
    p: Posed, ground: Ground, params: Array, table: Array, w: Work, z: Array, cy: float, sy: float
) -> None:
    """Load in `w.load`; of what is held the rows and slacks in `w.rows`, `w.sides` (forces) and `w.gaps`."""
    shapes, n = p.n_shapes, p.n_free
    count = p.n_active
    gravity_load(p, w, cy, sy)
    torsion_loads(p, w, z)
    stop_rows(p, w, z)
    strut_rows(p, w, cy, sy)
    loop_rows(p, w, cy, sy)
    for i in range(count):
        row = p.active[i]
        if row < shapes:
            follow_contact(p, ground, params, table, w, row)
            w.slack[row] = w.contacts[row, 0]
            gap_row(p, w, cy, sy, row, w.motion[row])
            force_row(p, w, cy, sy, row)
        w.gaps[i] = w.slack[row]
        for c in range(n):
            w.rows[i, c], w.sides[i, c] = w.motion[row, c], w.force[row, c]
    for i in range(p.n_held_loops):
        row = p.held_loops[i]
        w.gaps[count + i] = w.closure[row]
        for c in range(n):
            w.rows[count + i, c] = w.sides[count + i, c] = w.closing[row, c]


@formula
def least_forces(p: Posed, w: Work, held: int, out: Array) -> bool:
    """Multipliers (held,) nearest to balance, by normal equations of scaled rows; False where singular."""
    n = p.n_free
    for i in range(held):
        out[i] = 0.0
        for j in range(held):
            w.system[i, j] = 0.0
        for c in range(n):
            u2 = p.units[c] * p.units[c]
            out[i] += w.sides[i, c] * w.load[c] * u2
            for j in range(held):
                w.system[i, j] += w.sides[i, c] * w.sides[j, c] * u2
    return eliminate(w.system, out, held) != 0.0


@formula
def stiffness(
    p: Posed,
    ground: Ground,
    params: Array,
    table: Array,
    w: Work,
    z: Array,
    x: float,
    y: float,
    cy: float,
    sy: float,
) -> None:
    """Derivative of load - sides' forces by z in `w.stiffness` (n, n), by central differences.

    Multipliers `w.forces` are kept; contact places move with z. Scratch rows are left at the last pose tried.
    """
    n = p.n_free
    held = p.n_active + p.n_held_loops
    w.kept[:] = w.places
    for j in range(n):
        step = DIFFERENCE * p.units[j]
        before = z[j]
        for side in range(2):
            z[j] = before + (step if side == 0 else -step)
            w.places[:] = w.kept
            walk(p, z, x, y, cy, sy, w.rot, w.org)
            held_forces(p, ground, params, table, w, z, cy, sy)
            for c in range(n):
                total = w.load[c]
                for i in range(held):
                    total -= w.sides[i, c] * w.forces[i]
                w.stiffness[c, j] = total if side == 0 else (w.stiffness[c, j] - total) / (2.0 * step)
        z[j] = before
    w.places[:] = w.kept


@formula
def elastic_system(
    p: Posed, ground: Ground, params: Array, table: Array, w: Work, z: Array, x: float, y: float, cy: float,
    sy: float, first: bool,
) -> bool:  # fmt: skip
    """One Newton step on balance, active gaps and loops: dz in `w.right`, multipliers in `w.forces`.

    Returns:
        False where the system is singular, as where nothing determines a coordinate.
    """
    n = p.n_free
    held = p.n_active + p.n_held_loops
    held_forces(p, ground, params, table, w, z, cy, sy)
    if first and not least_forces(p, w, held, w.forces):
        return False
    stiffness(p, ground, params, table, w, z, x, y, cy, sy)
    walk(p, z, x, y, cy, sy, w.rot, w.org)
    held_forces(p, ground, params, table, w, z, cy, sy)
    span, weight = p.span, p.weight
    size = n + held
    for r in range(n):
        scale = p.units[r] / (weight * span)
        total = -w.load[r]
        for c in range(n):
            w.system[r, c] = w.stiffness[r, c] * p.units[c] * scale
        for i in range(held):
            w.system[r, n + i] = -w.sides[i, r] * weight * scale
            total += w.sides[i, r] * w.forces[i]
        w.right[r] = total * scale
    for i in range(held):
        for c in range(n):
            w.system[n + i, c] = w.rows[i, c] * p.units[c] / span
        for j in range(held):
            w.system[n + i, n + j] = 0.0
        w.right[n + i] = -w.gaps[i] / span
    if eliminate(w.system, w.right, size) == 0.0:
        return False
    for c in range(n):
        w.right[c] *= p.units[c]
    for i in range(held):
        w.forces[i] += w.right[n + i] * weight
    return True


@formula
def is_steady(
    p: Posed,
    ground: Ground,
    params: Array,
    table: Array,
    w: Work,
    z: Array,
    x: float,
    y: float,
    cy: float,
    sy: float,
) -> bool:
    """Whether every motion that the supports leave free is resisted.

    The stiffness between free motions and motions across the forces; sufficient, not necessary: a stance that
    fails here is looked at by the plain path.
    """
    n = p.n_free
    held = p.n_active + p.n_held_loops
    free = n - held
    stiffness(p, ground, params, table, w, z, x, y, cy, sy)
    walk(p, z, x, y, cy, sy, w.rot, w.org)
    held_forces(p, ground, params, table, w, z, cy, sy)
    scale = 1.0 / (p.weight * p.span)
    for i in range(held):
        for c in range(n):
            w.rows[i, c] *= p.units[c]
            w.sides[i, c] *= p.units[c]
    if null_basis(w.rows, held, n, w.along) != free or null_basis(w.sides, held, n, w.across) != free:
        return False
    # X = (across' along)^-1 across' K along, column by column
    for d in range(free):
        for i in range(free):
            w.right[i] = 0.0
            for j in range(free):
                w.system[i, j] = 0.0
            for r in range(n):
                pushed = 0.0
                for c in range(n):
                    pushed += w.stiffness[r, c] * p.units[r] * p.units[c] * scale * w.along[c, d]
                w.right[i] += w.across[r, i] * pushed
                for j in range(free):
                    w.system[i, j] += w.across[r, i] * w.along[r, j]
        if eliminate(w.system, w.right, free) == 0.0:
            return False
        for i in range(free):
            w.reduced[i, d] = w.right[i]
    return is_positive(w.reduced, free, STEADY)
