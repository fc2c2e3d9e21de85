"""Newton straight to the ground on a set of supports, the twin of `rover_pin.statics.newton.land`."""

from __future__ import annotations

import math

from rover_pin.compiled.elastic import elastic_system
from rover_pin.compiled.ground import Ground
from rover_pin.compiled.internal import internal_rows
from rover_pin.compiled.linear import eliminate
from rover_pin.compiled.posed import Posed
from rover_pin.compiled.state import follow_contact, gap_row, loop_rows, stop_rows
from rover_pin.compiled.walk import walk
from rover_pin.compiled.work import Work
from rover_pin.numerics import Array, formula, inlined
from rover_pin.statics.adapt import JUMP

ITERATIONS = 12
STEP = 1e-7
"""Share of the span, or rad: Newton squares its error, so the step that is this small is the last."""

REACH = 2.0 * JUMP
"""Farthest landing, as a share of the wheels' span and in rad, as on the plain path."""


@inlined
def newton_step(p: Posed, w: Work, z: Array, cy: float, sy: float) -> float:
    """Step of the free coordinates in `w.right` that closes gaps of active rows, and loops.

    The frames and the contacts of active shapes are at z.

    Returns:
        Sign of the determinant, 0 where there is no step.
    """
    shapes, n, count = p.n_shapes, p.n_free, w.n_active
    if count > 0 and w.active[count - 1] >= shapes:
        stop_rows(p, w, z)
        w.load[:] = 0.0
        internal_rows(p, w, cy, sy)
    if p.n_loops > 0:
        loop_rows(p, w, cy, sy)
    for i in range(count):
        row = w.active[i]
        if row < shapes:
            w.right[i] = -w.contacts[row, 0]
            gap_row(p, w, cy, sy, row, w.system[i])
        else:
            w.right[i] = -w.slack[row]
            for c in range(n):
                w.system[i, c] = w.motion[row, c]
    for i in range(p.n_held_loops):
        row = p.held_loops[i]
        w.right[count + i] = -w.closure[row]
        for c in range(n):
            w.system[count + i, c] = w.closing[row, c]
    return eliminate(w.system, w.right, n)


@inlined
def take_step(p: Posed, w: Work, z: Array) -> tuple[float, float]:
    """Move z by `w.right`: the largest part of the step, and how far z is from where it began, in units."""
    largest, moved = 0.0, 0.0
    for c in range(p.n_free):
        largest = max(largest, abs(w.right[c]) / p.units[c])
        z[c] += w.right[c]
        moved = max(moved, abs(z[c] - w.start[c]) / p.units[c])
    return largest, moved


@formula
def land(
    p: Posed, ground: Ground, params: Array, table: Array, w: Work, z: Array, x: float, y: float, cy: float,
    sy: float,
) -> tuple[bool, float]:  # fmt: skip
    """Move z to where the supports touch, loops close and forces balance; contacts are followed.

    Args:
        p: the machine.
        ground: the surface.
        params: its parameters.
        table: its table.
        w: scratch; places of contacts and `start` are given, contacts are left one step before the landing.
        z: (>= n,) start, receives the landing.
        x: of the base [m].
        y: of the base [m].
        cy: cosine of the yaw.
        sy: sine of the yaw.

    Returns:
        whether it landed, and the sign of the determinant (0 where supports do not determine the pose).
    """
    determinate = w.n_active + p.n_held_loops == p.n_free
    for i in range(ITERATIONS):
        if determinate:
            walk(p, z, x, y, cy, sy, w.rot, w.org)
            for k in range(w.n_active):
                if w.active[k] < p.n_shapes:
                    follow_contact(p, ground, params, table, w, w.active[k])
            sign = newton_step(p, w, z, cy, sy)
            if sign == 0.0:
                return False, 0.0
        else:
            sign = 0.0
            walk(p, z, x, y, cy, sy, w.rot, w.org)
            if not elastic_system(p, ground, params, table, w, z, cy, sy, i == 0):
                return False, 0.0
        largest, moved = take_step(p, w, z)
        if not moved <= p.reach:
            return False, 0.0
        if largest < STEP:
            return True, sign
    return False, math.nan
