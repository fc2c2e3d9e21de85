"""How generalised forces change as a tree of joints moves: second derivatives, in closed form.

Trees are given by columns as in `rover_pin.mechanism.columns`. Of two columns c and j, c the nearer to the
root, the second derivative of a point p is turn_c x v_j(p); a direction d fixed to the body has
turn_c x (turn_j x d).

Elements between bodies do not feel columns that move all their bodies alike: those are left out.
"""

from __future__ import annotations

import math

from rover_pin.mechanism.cable import OFF
from rover_pin.mechanism.columns import Integers, is_above, speed
from rover_pin.numerics import Array, formula


@formula
def add_dead_force(
    ref: Array, e: int, x: float, y: float, z: float, fx: float, fy: float, fz: float, pull: Array,
    spread: Array,
) -> None:  # fmt: skip
    """A force F that keeps its direction, at a point of the body of column e: adds F and (p - ref) F'.

    Args:
        ref: (3,) m.
        e: column.
        x: of the point [m].
        y: of the point [m].
        z: of the point [m].
        fx: N.
        fy: N.
        fz: N.
        pull: (m, 3) forces on the columns' bodies.
        spread: (m, 3, 3) their first moments.
    """
    rx, ry, rz = x - ref[0], y - ref[1], z - ref[2]
    pull[e, 0] += fx
    pull[e, 1] += fy
    pull[e, 2] += fz
    spread[e, 0, 0] += rx * fx
    spread[e, 0, 1] += rx * fy
    spread[e, 0, 2] += rx * fz
    spread[e, 1, 0] += ry * fx
    spread[e, 1, 1] += ry * fy
    spread[e, 1, 2] += ry * fz
    spread[e, 2, 0] += rz * fx
    spread[e, 2, 1] += rz * fy
    spread[e, 2, 2] += rz * fz


@formula
def bend_dead_forces(
    parent: Integers, turn: Array, move: Array, pull: Array, spread: Array, out: Array
) -> None:
    """Take the derivative of the dead forces' generalised force off `out` (m, m).

    sum over the points of F . (turn_c x v_j(p)) = F . (turn_c x move_j) + turn_c' Q turn_j
    - tr Q turn_c . turn_j, with F and Q = sum r F' of the whole subtree of j.

    Args:
        parent: (m,).
        turn: (m, 3).
        move: (m, 3).
        pull: (m, 3) of `add_dead_force`; becomes the subtrees'.
        spread: (m, 3, 3) likewise.
        out: (m, m).
    """
    for j in range(parent.shape[0] - 1, -1, -1):
        a = parent[j]
        if a >= 0:
            for i in range(3):
                pull[a, i] += pull[j, i]
                for k in range(3):
                    spread[a, i, k] += spread[j, i, k]
        wx, wy, wz = turn[j, 0], turn[j, 1], turn[j, 2]
        fx, fy, fz = pull[j, 0], pull[j, 1], pull[j, 2]
        vx, vy, vz = move[j, 0], move[j, 1], move[j, 2]
        q = spread[j]
        trace = q[0, 0] + q[1, 1] + q[2, 2]
        gx = vy * fz - vz * fy + q[0, 0] * wx + q[0, 1] * wy + q[0, 2] * wz - trace * wx
        gy = vz * fx - vx * fz + q[1, 0] * wx + q[1, 1] * wy + q[1, 2] * wz - trace * wy
        gz = vx * fy - vy * fx + q[2, 0] * wx + q[2, 1] * wy + q[2, 2] * wz - trace * wz
        c = j
        while c >= 0:
            value = turn[c, 0] * gx + turn[c, 1] * gy + turn[c, 2] * gz
            out[c, j] -= value
            if c != j:
                out[j, c] -= value
            c = parent[c]


@formula
def bend_sliding_load(
    parent: Integers, turn: Array, move: Array, ref: Array, e: int, load: float, slide: Array, center: Array,
    axis: Array, point: Array, out: Array,
) -> None:  # fmt: skip
    """What a vertical load adds because its contact point slides over the body it rests on.

    Args:
        parent: (m,).
        turn: (m, 3).
        move: (m, 3).
        ref: (3,) m.
        e: the carrier's column.
        load: N, upwards.
        slide: (2, 6) of `rover_pin.contact.slide`.
        center: (3,) m, the wheel's centre, world.
        axis: (3,) its axis.
        point: (3,) m, the contact.
        out: (m, m).
    """
    j = e
    while j >= 0:
        ux, uy, uz = speed(turn, move, ref, j, center[0], center[1], center[2])
        wx, wy, wz = turn[j, 0], turn[j, 1], turn[j, 2]
        ax, ay, az = wy * axis[2] - wz * axis[1], wz * axis[0] - wx * axis[2], wx * axis[1] - wy * axis[0]
        vx, vy, _ = speed(turn, move, ref, j, point[0], point[1], point[2])
        s = slide
        dx = s[0, 0] * ux + s[0, 1] * uy + s[0, 2] * uz + s[0, 3] * ax + s[0, 4] * ay + s[0, 5] * az - vx
        dy = s[1, 0] * ux + s[1, 1] * uy + s[1, 2] * uz + s[1, 3] * ax + s[1, 4] * ay + s[1, 5] * az - vy
        if dx != 0.0 or dy != 0.0:
            c = e
            while c >= 0:
                out[c, j] -= load * (turn[c, 0] * dy - turn[c, 1] * dx)
                c = parent[c]
        j = parent[j]


@formula
def bend_fixed_pull(
    parent: Integers, turn: Array, move: Array, ref: Array, e: int, other: int, x: float, y: float, z: float,
    fx: float, fy: float, fz: float, out: Array,
) -> None:  # fmt: skip
    """A dead force at a point of column e's body, seen only by columns that do not move `other` too.

    Args:
        parent: (m,).
        turn: (m, 3).
        move: (m, 3).
        ref: (3,) m.
        e: column.
        other: column of the body that pulls.
        x: of the point [m].
        y: of the point [m].
        z: of the point [m].
        fx: N.
        fy: N.
        fz: N.
        out: (m, m), reduced by the derivative.
    """
    j = e
    while j >= 0 and not is_above(parent, j, other):
        vx, vy, vz = speed(turn, move, ref, j, x, y, z)
        gx, gy, gz = vy * fz - vz * fy, vz * fx - vx * fz, vx * fy - vy * fx
        c = j
        while c >= 0 and not is_above(parent, c, other):
            value = turn[c, 0] * gx + turn[c, 1] * gy + turn[c, 2] * gz
            out[c, j] -= value
            if c != j:
                out[j, c] -= value
            c = parent[c]
        j = parent[j]


@formula
def bend_strut(
    parent: Integers, turn: Array, move: Array, ref: Array, ends: Integers, points: Array, force: float,
    stiffness: float, rates: Array, out: Array,
) -> None:  # fmt: skip
    """A push along the line between two points, F = force e, that falls by `stiffness` with their distance.

    Off comes sum dJ' F + J' dF with dF = -stiffness e (e . dr) + force (dr - e (e . dr)) / L.

    Args:
        parent: (m,).
        turn: (m, 3).
        move: (m, 3).
        ref: (3,) m.
        ends: (2,) columns of the bodies.
        points: (2, 3) m, world.
        force: N, pushing the points apart.
        stiffness: N/m.
        rates: (m, 3) scratch.
        out: (m, m).
    """
    ex, ey, ez = points[1, 0] - points[0, 0], points[1, 1] - points[0, 1], points[1, 2] - points[0, 2]
    length = math.sqrt(ex * ex + ey * ey + ez * ez)
    if not length > 0.0:
        return
    ex, ey, ez = ex / length, ey / length, ez / length
    for i in range(2):
        sign = 1.0 if i == 1 else -1.0
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        f = sign * force
        bend_fixed_pull(
            parent, turn, move, ref, ends[i], ends[1 - i], x, y, z, f * ex, f * ey, f * ez, out
        )  # fmt: skip
        c = ends[i]
        while c >= 0 and not is_above(parent, c, ends[1 - i]):
            vx, vy, vz = speed(turn, move, ref, c, x, y, z)
            rates[c, 0], rates[c, 1], rates[c, 2] = sign * vx, sign * vy, sign * vz
            c = parent[c]
    side = force / length
    for i in range(2):
        c = ends[i]
        while c >= 0 and not is_above(parent, c, ends[1 - i]):
            along = ex * rates[c, 0] + ey * rates[c, 1] + ez * rates[c, 2]
            for k in range(2):
                d = ends[k]
                while d >= 0 and not is_above(parent, d, ends[1 - k]):
                    with_d = ex * rates[d, 0] + ey * rates[d, 1] + ez * rates[d, 2]
                    dot = rates[c, 0] * rates[d, 0] + rates[c, 1] * rates[d, 1] + rates[c, 2] * rates[d, 2]
                    out[c, d] += (stiffness + side) * along * with_d - side * dot
                    d = parent[d]
            c = parent[c]


@formula
def bend_cable(
    parent: Integers, turn: Array, move: Array, ref: Array, ends: Integers, points: Array, plane: Array,
    following: Integers, spans: Array, tension: float, rates: Array, out: Array,
) -> None:  # fmt: skip
    """A taut cable: dead pulls at the circles, and spans that turn by n . (v_b - v_a) / s.

    The second derivative of the length is that of the centres along t_in - t_out, plus the sum over spans of
    g g' / s with g = n . (v_b - v_a), n across the span in the plane and s its length.

    Args:
        parent: (m,).
        turn: (m, 3).
        move: (m, 3).
        ref: (3,) m.
        ends: (k,) columns of the circles' bodies.
        points: (k, 3) m, centres, world.
        plane: (3, >= 2) columns u, v of the plane, world.
        following: (k,) as of `rover_pin.mechanism.cable.taut`.
        spans: (k, 3) likewise.
        tension: N.
        rates: (m, 3) scratch.
        out: (m, m).
    """
    count = ends.shape[0]
    shared = ends[0]  # the last column that moves all circles alike
    for i in range(1, count):
        while shared >= 0 and not is_above(parent, shared, ends[i]):
            shared = parent[shared]
    for a in range(count):
        b = following[a]
        if b == OFF:
            continue
        u, v = spans[a, 0], spans[a, 1]
        tx = plane[0, 0] * u + plane[0, 1] * v
        ty = plane[1, 0] * u + plane[1, 1] * v
        tz = plane[2, 0] * u + plane[2, 1] * v
        nx = plane[0, 1] * u - plane[0, 0] * v
        ny = plane[1, 1] * u - plane[1, 0] * v
        nz = plane[2, 1] * u - plane[2, 0] * v
        for i in range(2):
            e, sign = (a, 1.0) if i == 0 else (b, -1.0)
            c = ends[e]
            while c > shared:
                rates[c, 0] = 0.0
                c = parent[c]
        for i in range(2):
            e, sign = (a, 1.0) if i == 0 else (b, -1.0)
            f = sign * tension
            x, y, z = points[e, 0], points[e, 1], points[e, 2]
            j = ends[e]
            while j > shared:
                vx, vy, vz = speed(turn, move, ref, j, x, y, z)
                rates[j, 0] -= sign * (nx * vx + ny * vy + nz * vz)
                gx, gy, gz = f * (vy * tz - vz * ty), f * (vz * tx - vx * tz), f * (vx * ty - vy * tx)
                c = j
                while c > shared:
                    value = turn[c, 0] * gx + turn[c, 1] * gy + turn[c, 2] * gz
                    out[c, j] -= value
                    if c != j:
                        out[j, c] -= value
                    c = parent[c]
                j = parent[j]
        share = tension / spans[a, 2]
        for i in range(2):
            c = ends[a] if i == 0 else ends[b]
            while c > shared and not (i == 1 and is_above(parent, c, ends[a])):
                for k in range(2):
                    d = ends[a] if k == 0 else ends[b]
                    while d > shared and not (k == 1 and is_above(parent, d, ends[a])):
                        out[c, d] += share * rates[c, 0] * rates[d, 0]
                        d = parent[d]
                c = parent[c]
