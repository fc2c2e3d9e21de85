"""Where supports alone do not determine the pose: the stiffness of springs and weight decides with them."""

from __future__ import annotations

from rover_pin.compiled.ground import Ground
from rover_pin.compiled.internal import COLUMN, columns, internal_rows, strut_slope, wrap
from rover_pin.compiled.linear import eliminate, is_positive, null_basis
from rover_pin.compiled.posed import Posed
from rover_pin.compiled.state import (
    follow_contact,
    force_row,
    gap_row,
    gravity_load,
    loop_rows,
    stop_rows,
    torsion_loads,
)
from rover_pin.compiled.walk import place, turn
from rover_pin.compiled.work import Work
from rover_pin.contact.slide import slide
from rover_pin.mechanism.bending import (
    add_dead_force,
    bend_cable,
    bend_dead_forces,
    bend_sliding_load,
    bend_strut,
)
from rover_pin.mechanism.closure import push
from rover_pin.mechanism.closure_bending import bend_loop
from rover_pin.numerics import Array, formula

STEADY = 1e-9
"""Share of weight times span, per rad: a stiffness above this resists."""


@formula
def held_forces(
    p: Posed, ground: Ground, params: Array, table: Array, w: Work, z: Array, cy: float, sy: float
) -> None:
    """Load in `w.load`; of what is held the rows and slacks in `w.rows`, `w.sides` (forces) and `w.gaps`."""
    shapes, n = p.n_shapes, p.n_free
    count = w.n_active
    gravity_load(p, w, cy, sy)
    torsion_loads(p, w, z)
    stop_rows(p, w, z)
    internal_rows(p, w, cy, sy)
    loop_rows(p, w, cy, sy)
    for i in range(count):
        row = w.active[i]
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
def stiffness(p: Posed, ground: Ground, params: Array, table: Array, w: Work, cy: float, sy: float) -> None:
    """Derivative of load - sides' forces by the free coordinates in `w.stiffness` (n, n), in closed form.

    Frames and contacts are those of the pose; multipliers `w.forces` are kept, contact places slide.
    """
    m, shapes, count = COLUMN + p.n_bodies, p.n_shapes, w.n_active
    above, ref, curved = p.above[:m], w.org[0], w.curved
    columns(p, w, cy, sy)
    curved[:] = 0.0
    w.pull[:] = 0.0
    w.spread[:] = 0.0
    for b in range(p.n_bodies):
        mass = p.masses[b]
        if mass > 0.0:
            x, y, z = turn(w.rot, b, p.moments[b, 0], p.moments[b, 1], p.moments[b, 2])
            x, y, z = w.org[b, 0] + x / mass, w.org[b, 1] + y / mass, w.org[b, 2] + z / mass
            add_dead_force(ref, COLUMN + b, x, y, z, 0.0, 0.0, -mass * p.gravity, w.pull, w.spread)
    for i in range(count):
        if w.active[i] < shapes:
            bend_contact(p, ground, params, table, w, w.active[i], w.forces[i])
    bend_dead_forces(above, w.turn, w.move, w.pull, w.spread, curved)
    for k in range(p.n_torsions):
        c = COLUMN + p.torsion_bodies[k]
        curved[c, c] += p.torsions[k, 0]
    for f in range(p.n_struts):
        length = strut_slope(p, w, f)
        force = push(length, p.struts[f, 0], p.struts[f, 1], p.struts[f, 2])
        force -= multiplier(p, w, shapes + p.n_stops + f)
        bend_strut(above, w.turn, w.move, ref, w.ends, w.tips, force, p.struts[f, 0], w.rates, curved)
    for t in range(p.n_tracks):
        tension = multiplier(p, w, shapes + p.n_stops + p.n_struts + t)
        start, stop = p.track_starts[t], p.track_starts[t + 1]
        if tension != 0.0:
            wrap(p, w, t)
            bend_cable(
                above, w.turn, w.move, ref, w.carriers[start:stop], w.circles[start:stop], w.plane[t],
                w.following[start:stop], w.spans[start:stop], tension, w.rates, curved,
            )  # fmt: skip
    for i in range(p.n_loops):
        bend_one_loop(p, w, i)
    reduce_curved(p, w)


@formula
def multiplier(p: Posed, w: Work, row: int) -> float:
    """The multiplier of a one-sided row; 0 where it does not carry."""
    for i in range(w.n_active):
        if w.active[i] == row:
            force: float = w.forces[i]
            return force
    return 0.0


@formula
def bend_contact(p: Posed, ground: Ground, params: Array, table: Array, w: Work, s: int, load: float) -> None:
    """What the load of shape s adds: a dead force, and its point sliding over the shape."""
    m, b, c = COLUMN + p.n_bodies, p.carriers[s], w.contacts[s]
    cx, cy, cz = place(w.rot, w.org, b, p.centers[s, 0], p.centers[s, 1], p.centers[s, 2])
    ax, ay, az = turn(w.rot, b, p.axes[s, 0], p.axes[s, 1], p.axes[s, 2])
    add_dead_force(w.org[0], COLUMN + b, c[1], c[2], c[3], 0.0, 0.0, load, w.pull, w.spread)
    slide(ground.kind, table, params, cx, cy, cz, ax, ay, az, p.rings[s], c[1], c[2], w.slide)
    w.tips[0, 0], w.tips[0, 1], w.tips[0, 2] = cx, cy, cz
    w.tips[1, 0], w.tips[1, 1], w.tips[1, 2] = ax, ay, az
    bend_sliding_load(
        p.above[:m], w.turn, w.move, w.org[0], COLUMN + b, load, w.slide, w.tips[0], w.tips[1], c[1:4],
        w.curved,
    )  # fmt: skip


@formula
def bend_one_loop(p: Posed, w: Work, i: int) -> None:
    """What the multipliers of loop i add."""
    start, m = p.loop_starts[i], COLUMN + p.n_bodies
    w.pulls[:] = 0.0
    for k in range(p.n_held_loops):
        if start <= p.held_loops[k] < p.loop_starts[i + 1]:
            w.pulls[p.held_loops[k] - start] = w.forces[w.n_active + k]
    for e in range(2):
        b = p.loop_bodies[i, e]
        w.ends[e] = COLUMN + b
        o, r = p.loop_origins[i, e], p.loop_rotations[i, e]
        w.origin[e, 0], w.origin[e, 1], w.origin[e, 2] = place(w.rot, w.org, b, o[0], o[1], o[2])
        for c in range(3):
            x, y, z = turn(w.rot, b, r[0, c], r[1, c], r[2, c])
            w.frame[e, 0, c], w.frame[e, 1, c], w.frame[e, 2, c] = x, y, z
    bend_loop(
        p.loop_kinds[i], p.loop_across[i], p.above[:m], w.turn, w.move, w.org[0], w.ends, w.origin, w.frame,
        w.pulls, w.rates, w.curved,
    )  # fmt: skip


@formula
def reduce_curved(p: Posed, w: Work) -> None:
    """Second derivatives by columns brought to the free coordinates: basis' curved basis."""
    n, m = p.n_free, COLUMN + p.n_bodies
    for c in range(m):
        for k in range(n):
            total = w.curved[c, k] if k < 3 else 0.0
            if k >= 3:
                for b in range(1, p.n_bodies):
                    total += w.curved[c, COLUMN + b] * p.basis[b, k]
            w.half[c, k] = total
    for i in range(n):
        for k in range(n):
            total = w.half[i, k] if i < 3 else 0.0
            if i >= 3:
                for b in range(1, p.n_bodies):
                    total += p.basis[b, i] * w.half[COLUMN + b, k]
            w.stiffness[i, k] = total


@formula
def elastic_system(
    p: Posed, ground: Ground, params: Array, table: Array, w: Work, z: Array, cy: float, sy: float,
    first: bool,
) -> bool:  # fmt: skip
    """One Newton step on balance, active gaps and loops: dz in `w.right`, multipliers in `w.forces`.

    Returns:
        False where the system is singular, as where nothing determines a coordinate.
    """
    n = p.n_free
    held = w.n_active + p.n_held_loops
    held_forces(p, ground, params, table, w, z, cy, sy)
    if first and not least_forces(p, w, held, w.forces):
        return False
    stiffness(p, ground, params, table, w, cy, sy)
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
    p: Posed, ground: Ground, params: Array, table: Array, w: Work, z: Array, cy: float, sy: float
) -> bool:
    """Whether every motion that the supports leave free is resisted.

    The stiffness between free motions and motions across the forces; sufficient, not necessary: a stance that
    fails here is looked at by the plain path.
    """
    n = p.n_free
    held = w.n_active + p.n_held_loops
    free = n - held
    held_forces(p, ground, params, table, w, z, cy, sy)
    stiffness(p, ground, params, table, w, cy, sy)
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
