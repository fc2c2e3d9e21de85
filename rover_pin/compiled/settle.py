"""One case inside the kernels: straight to the ground, loads, residuals, or left open for the plain path."""

from __future__ import annotations

import math

from rover_pin.compiled.bounds import HEIGHT, RINGS, Tiles, sure_within, tile
from rover_pin.compiled.elastic import held_forces, is_steady
from rover_pin.compiled.ground import Ground
from rover_pin.compiled.land import ITERATIONS, STEP, land, newton_step, take_step
from rover_pin.compiled.linear import eliminate
from rover_pin.compiled.posed import Posed
from rover_pin.compiled.residuals import recompute
from rover_pin.compiled.search import Search
from rover_pin.compiled.share import share
from rover_pin.compiled.state import follow_contact, search_contact, start_contacts, tilt_cosine
from rover_pin.compiled.sweep import DEEPER, UNDECIDED, sweep
from rover_pin.compiled.underside import CLEAR, IN_GROUND, look_below
from rover_pin.compiled.walk import place, turn, walk
from rover_pin.compiled.work import Work
from rover_pin.numerics import Array, formula, inlined
from rover_pin.statics.adapt import MOST_CHANGES, NOT_NEGATIVE
from rover_pin.statics.adapt import OPEN as PENETRATION
from rover_pin.statics.loads import TOUCHING
from rover_pin.statics.relax import UPRIGHT as MOST_TILT
from rover_pin.statics.report import ACCEPTED as LARGEST
from rover_pin.statics.report import BALANCED
from rover_pin.terrain.surface import LINEAR, tabled

SETTLED, GROUNDED, OFF_MAP, OPEN = 0, 1, 2, 255
SAME, CHANGED, IMPOSSIBLE = 0, 1, 2

ACCEPTED = min(LARGEST.values())
UPRIGHT = math.cos(MOST_TILT)

WINDOW = 1e-5
"""m: further places of a shape within this of its least gap are looked for."""

REPEATS = 4
"""Landings tried where a shape turns out to touch nearer elsewhere."""

CLOSED = 1e-9
"""m: gaps of supports that are wider after the last step are closed by further ones."""

FOLLOWED = 8
"""Steps to follow a contact at the landing."""

MOVED = 3e-6
"""m: a followed contact that moves less than this is exact after the step, which squares its error."""


@formula
def settle_one(
    p: Posed, ground: Ground, params: Array, table: Array, tiles: Tiles, skin: Array, search: Search,
    w: Work, x: float,
    y: float, yaw: float, z: Array, loads: Array, residuals: Array,
) -> tuple[int, int, float, int]:  # fmt: skip
    """A rover at a place.

    Args:
        p: the machine.
        ground: the surface.
        params: its parameters.
        table: its table.
        tiles: its bounds.
        skin: (h, 4) points of the underside and their radii [m].
        search: the contact search.
        w: scratch; afterwards it holds the pose's frames and contacts.
        x: m.
        y: m.
        yaw: rad.
        z: (>= n,) receives the pose.
        loads: (s,) receives loads [N].
        residuals: (4,) receives equilibrium, gap, loop, complementarity.

    Returns:
        SETTLED, GROUNDED, OFF_MAP or OPEN; the underside's point or the wheel it is about; how deep [m]; how
        many more supports there are than equilibrium determines.
    """
    cy, sy = math.cos(yaw), math.sin(yaw)
    begin(p, w, z, x, y, cy, sy, tabled(ground.kind, table, params, x, y)[0])
    stands, changes = False, 0
    for _ in range(REPEATS + MOST_CHANGES):
        if ground.kind == LINEAR:
            landed, sign = False, 0.0
            for _ in range(ITERATIONS if w.n_active + p.n_held_loops == p.n_free else 0):
                walk(p, z, x, y, cy, sy, w.rot, w.org)
                for k in range(w.n_active):
                    if w.active[k] < p.n_shapes:
                        search_contact(p, ground, params, table, search, w, w.active[k], 0.0)
                sign = newton_step(p, w, z, cy, sy)
                largest, moved = take_step(p, w, z)
                landed = sign != 0.0 and moved <= p.reach and largest < STEP
                if landed or sign == 0.0 or not moved <= p.reach:
                    break
        else:
            landed, sign = land(p, ground, params, table, w, z, x, y, cy, sy)
        walk(p, z, x, y, cy, sy, w.rot, w.org)
        sprung = p.n_torsions + p.n_struts > 0 and ground.kind != LINEAR
        if not landed or (changes == 0 and sign != p.sign):
            if changes > 0 or not sprung:
                return OPEN, -1, 0.0, 0
            begin(p, w, z, x, y, cy, sy, tabled(ground.kind, table, params, x, y)[0])
            drop_internal(p, w)
            changes += 1
            continue
        if sprung and changes < MOST_CHANGES:
            change = change_supports(p, ground, params, table, tiles, w, z, cy, sy)
            if change == IMPOSSIBLE:
                return OPEN, -1, 0.0, 0
            if change == CHANGED:
                changes += 1
                continue
        if is_loose(p, ground, params, table, w, z, cy, sy):
            return OPEN, -1, 0.0, 0
        lowest, open_gap = 0.0, 0.0
        for i in range(p.n_shapes):
            if not is_proven(p, ground, params, table, tiles, w, i):
                count = search_contact(p, ground, params, table, search, w, i, WINDOW)
                if count > 1 and w.found[1, 0] <= TOUCHING:
                    return OPEN, -1, 0.0, 0
            w.slack[i] = w.contacts[i, 0]
            lowest = min(lowest, w.slack[i])
        for k in range(w.n_active):
            if w.active[k] < p.n_shapes:
                open_gap = max(open_gap, abs(w.slack[w.active[k]]))
        stands = lowest >= PENETRATION and open_gap < CLOSED
        if stands:
            break
    if not stands or tilt_cosine(z) < UPRIGHT:
        return OPEN, -1, 0.0, 0
    return judge(p, ground, params, table, tiles, skin, w, z, cy, sy, loads, residuals)


@formula
def change_supports(
    p: Posed, ground: Ground, params: Array, table: Array, tiles: Tiles, w: Work, z: Array, cy: float,
    sy: float,
) -> int:  # fmt: skip
    """Drop supports that would pull, take up rows that are violated, as `rover_pin.statics.adapt.adapted`.

    Returns:
        SAME, CHANGED, or IMPOSSIBLE where the rows that carry are too many.
    """
    shapes, n = p.n_shapes, p.n_free
    rows = shapes + p.n_stops + p.n_struts + p.n_tracks
    held_forces(p, ground, params, table, w, z, cy, sy)
    if w.n_active + p.n_held_loops == n:
        for c in range(n):
            w.forces[c] = w.load[c]
            for i in range(n):
                w.system[c, i] = w.sides[i, c]
        if eliminate(w.system, w.forces, n) == 0.0:
            return IMPOSSIBLE
    changed, count, i = False, 0, 0
    for row in range(rows):
        if i < w.n_active and w.active[i] == row:
            keep = w.forces[i] >= NOT_NEGATIVE * p.weight
            i += 1
            changed = changed or not keep
        else:
            if row < shapes:
                is_proven(p, ground, params, table, tiles, w, row)
                w.slack[row] = w.contacts[row, 0]
            keep = not w.slack[row] >= PENETRATION
            changed = changed or keep
        if keep:
            if count + p.n_held_loops == n:
                return IMPOSSIBLE
            w.chosen_rows[count] = row
            count += 1
    if not changed:
        return SAME
    w.n_active = count
    for k in range(count):
        w.active[k] = w.chosen_rows[k]
    return CHANGED


@inlined
def drop_internal(p: Posed, w: Work) -> None:
    """Leave only contacts among the supports taken as carrying."""
    while w.n_active > 0 and w.active[w.n_active - 1] >= p.n_shapes:
        w.n_active -= 1


@inlined
def begin(p: Posed, w: Work, z: Array, x: float, y: float, cy: float, sy: float, level: float) -> None:
    """Put the rover on level ground at the height below its base, its contacts below its shapes' centres."""
    for c in range(p.n_free):
        z[c] = p.start[c]
    z[0] += level
    w.n_active = p.n_active
    for i in range(p.n_active):
        w.active[i] = p.active[i]
    for c in range(p.n_free):
        w.start[c] = z[c]
    walk(p, z, x, y, cy, sy, w.rot, w.org)
    start_contacts(p, w)


@formula
def is_loose(
    p: Posed, ground: Ground, params: Array, table: Array, w: Work, z: Array, cy: float, sy: float
) -> bool:
    """Whether the pose hangs on a stiffness that does not resist every free motion."""
    if w.n_active + p.n_held_loops == p.n_free:
        return False
    return not is_steady(p, ground, params, table, w, z, cy, sy)


@formula
def is_proven(p: Posed, ground: Ground, params: Array, table: Array, tiles: Tiles, w: Work, i: int) -> bool:
    """Follow the contact of shape i at the landing to its end; whether it is known to be the least.

    By the ground's bounds, else by a look along the ring, which may find a deeper one.
    """
    if ground.kind == LINEAR:
        return False
    size = math.inf
    for _ in range(FOLLOWED):
        size = follow_contact(p, ground, params, table, w, i)
        if size < MOVED:
            break
    if not size < MOVED:
        return False
    b, c = p.carriers[i], w.contacts[i]
    cx, cy, cz = place(w.rot, w.org, b, p.centers[i, 0], p.centers[i, 1], p.centers[i, 2])
    ax, ay, az = turn(w.rot, b, p.axes[i, 0], p.axes[i, 1], p.axes[i, 2])
    off = math.sqrt((c[1] - cx) ** 2 + (c[2] - cy) ** 2)
    r = p.reach_of[i]
    sure = sure_within(ground, tiles, r, c[1], c[2], off, az, p.rings[i], p.treads[i], c[0])
    if sure == math.inf:
        return True
    if p.rings[i] == 0.0 or ground.bounded == 0 or off + p.rings[i] > ground.reaches[r + RINGS - 1]:
        return False
    row, column = tile(ground, tiles, c[1], c[2])
    top = tiles[r + RINGS - 1, row, column, HEIGHT]
    found = sweep(
        ground, params, table, cx, cy, cz, ax, ay, az, p.rings[i], p.treads[i], top, sure, c
    )  # fmt: skip
    if found == DEEPER:
        w.places[i, 0], w.places[i, 1] = c[1], c[2]
    return found != UNDECIDED


@formula
def judge(
    p: Posed, ground: Ground, params: Array, table: Array, tiles: Tiles, skin: Array, w: Work, z: Array,
    cy: float, sy: float, loads: Array, residuals: Array,
) -> tuple[int, int, float, int]:  # fmt: skip
    """What a landing is: off the map, in the ground, settled with its loads, or for the plain path to say."""
    off = off_map(p, ground, w)
    if off >= 0:
        return OFF_MAP, off, 0.0, 0
    redundant = share(p, w, z, cy, sy)
    if redundant < 0:
        return OPEN, -1, 0.0, 0
    kind, point, depth = look_below(p, ground, params, table, tiles, skin, w)
    if kind != CLEAR:
        return (GROUNDED if kind == IN_GROUND else OPEN), point, depth, 0
    recompute(p, ground, params, table, w, z, cy, sy, loads, residuals)
    worst = max(max(residuals[0], residuals[1]), max(residuals[2], residuals[3]))
    unique = redundant == 0 and w.n_active + p.n_held_loops == p.n_free
    if not worst <= ACCEPTED or (not unique and residuals[0] > BALANCED):
        return OPEN, -1, 0.0, 0
    return SETTLED, -1, 0.0, redundant


@formula
def off_map(p: Posed, ground: Ground, w: Work) -> int:
    """The first shape with a point that is not over the map, or -1."""
    e = ground.extent
    if e[0] == -math.inf and e[1] == math.inf and e[2] == -math.inf and e[3] == math.inf:
        return -1
    for i in range(p.n_shapes):
        b = p.carriers[i]
        cx, cy, _ = place(w.rot, w.org, b, p.centers[i, 0], p.centers[i, 1], p.centers[i, 2])
        ax, ay, _ = turn(w.rot, b, p.axes[i, 0], p.axes[i, 1], p.axes[i, 2])
        rx = p.rings[i] * math.sqrt(max(1.0 - ax * ax, 0.0)) + p.treads[i]
        ry = p.rings[i] * math.sqrt(max(1.0 - ay * ay, 0.0)) + p.treads[i]
        if cx - rx < e[0] or cx + rx > e[1] or cy - ry < e[2] or cy + ry > e[3]:
            return i
    return -1
