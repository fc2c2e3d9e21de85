"""The tree walk of the compiled path: frames of bodies, and rows of points and directions on them."""

from __future__ import annotations

import math

from rover_pin.compiled.posed import Posed
from rover_pin.numerics import Array, inlined


@inlined
def walk(p: Posed, z: Array, x: float, y: float, cy: float, sy: float, rot: Array, org: Array) -> None:
    """Frames of all bodies at free coordinates z.

    Args:
        p: the machine.
        z: (n,) height, pitch, roll, passive joints.
        x: of the base [m].
        y: of the base [m].
        cy: cosine of the yaw.
        sy: sine of the yaw.
        rot: (b, 3, 3) receives rotations, world.
        org: (b, 3) receives origins [m], world.
    """
    cp, sp = math.cos(z[1]), math.sin(z[1])
    cr, sr = math.cos(z[2]), math.sin(z[2])
    rot[0, 0, 0], rot[0, 0, 1], rot[0, 0, 2] = cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr
    rot[0, 1, 0], rot[0, 1, 1], rot[0, 1, 2] = sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr
    rot[0, 2, 0], rot[0, 2, 1], rot[0, 2, 2] = -sp, cp * sr, cp * cr
    org[0, 0], org[0, 1], org[0, 2] = x, y, z[0]
    n = p.n_free
    for b in range(1, p.n_bodies):
        q = p.offsets[b]
        for k in range(3, n):
            q += p.basis[b, k] * z[k]
        a = p.parents[b]
        t0, t1, t2 = p.translations[b, 0], p.translations[b, 1], p.translations[b, 2]
        turns = p.turning[b]
        c, s = (math.cos(q), math.sin(q)) if turns else (1.0, 0.0)
        slide = 0.0 if turns else q
        for i in range(3):
            r0, r1, r2 = rot[a, i, 0], rot[a, i, 1], rot[a, i, 2]
            u = r0 * p.rotations[b, 0, 0] + r1 * p.rotations[b, 1, 0] + r2 * p.rotations[b, 2, 0]
            v = r0 * p.rotations[b, 0, 1] + r1 * p.rotations[b, 1, 1] + r2 * p.rotations[b, 2, 1]
            w = r0 * p.rotations[b, 0, 2] + r1 * p.rotations[b, 1, 2] + r2 * p.rotations[b, 2, 2]
            org[b, i] = org[a, i] + r0 * t0 + r1 * t1 + r2 * t2 + w * slide
            rot[b, i, 0] = c * u + s * v
            rot[b, i, 1] = c * v - s * u
            rot[b, i, 2] = w


@inlined
def place(rot: Array, org: Array, b: int, u: float, v: float, w: float) -> tuple[float, float, float]:
    """World place of a body's point (u, v, w)."""
    return (
        org[b, 0] + rot[b, 0, 0] * u + rot[b, 0, 1] * v + rot[b, 0, 2] * w,
        org[b, 1] + rot[b, 1, 0] * u + rot[b, 1, 1] * v + rot[b, 1, 2] * w,
        org[b, 2] + rot[b, 2, 0] * u + rot[b, 2, 1] * v + rot[b, 2, 2] * w,
    )


@inlined
def turn(rot: Array, b: int, u: float, v: float, w: float) -> tuple[float, float, float]:
    """World components of a body's direction (u, v, w)."""
    return (
        rot[b, 0, 0] * u + rot[b, 0, 1] * v + rot[b, 0, 2] * w,
        rot[b, 1, 0] * u + rot[b, 1, 1] * v + rot[b, 1, 2] * w,
        rot[b, 2, 0] * u + rot[b, 2, 1] * v + rot[b, 2, 2] * w,
    )


@inlined
def point_row(
    p: Posed, rot: Array, org: Array, cy: float, sy: float, body: int,
    px: float, py: float, pz: float, dx: float, dy: float, dz: float, share: float, row: Array,
) -> None:  # fmt: skip
    """Add to `row` (n,) `share` times the velocity along d, per free coordinate, of the body's point at p."""
    rx, ry, rz = px - org[0, 0], py - org[0, 1], pz - org[0, 2]
    mx, my, mz = ry * dz - rz * dy, rz * dx - rx * dz, rx * dy - ry * dx
    row[0] += share * dz
    row[1] += share * (cy * my - sy * mx)
    row[2] += share * (rot[0, 0, 0] * mx + rot[0, 1, 0] * my + rot[0, 2, 0] * mz)
    n = p.n_free
    b = body
    while b > 0:
        ax, ay, az = rot[b, 0, 2], rot[b, 1, 2], rot[b, 2, 2]
        if p.turning[b]:
            rx, ry, rz = px - org[b, 0], py - org[b, 1], pz - org[b, 2]
            v = ax * (ry * dz - rz * dy) + ay * (rz * dx - rx * dz) + az * (rx * dy - ry * dx)
        else:
            v = ax * dx + ay * dy + az * dz
        v *= share
        for k in range(3, n):
            row[k] += v * p.basis[b, k]
        b = p.parents[b]


@inlined
def turn_row(
    p: Posed, rot: Array, cy: float, sy: float, body: int,
    dx: float, dy: float, dz: float, row: Array,
) -> None:  # fmt: skip
    """Add to `row` (n,) the body's angular velocity along d, per free coordinate."""
    row[1] += cy * dy - sy * dx
    row[2] += rot[0, 0, 0] * dx + rot[0, 1, 0] * dy + rot[0, 2, 0] * dz
    n = p.n_free
    b = body
    while b > 0:
        if p.turning[b]:
            v = rot[b, 0, 2] * dx + rot[b, 1, 2] * dy + rot[b, 2, 2] * dz
            for k in range(3, n):
                row[k] += v * p.basis[b, k]
        b = p.parents[b]
