"""One Newton step of a contact that is followed from pose to pose."""

from __future__ import annotations

import math

from rover_pin.numerics import Array, inlined
from rover_pin.terrain.surface import tabled

Track = tuple[float, float, float, float, float, float, float, float]


@inlined
def track(
    kind: int, table: Array, params: Array, cx: float, cy: float, cz: float, ax: float, ay: float, az: float,
    ring: float, tread: float, x: float, y: float,
) -> Track:  # fmt: skip
    """Signed distance of a ring-shaped skin to the ground, from a contact place (x, y) nearby.

    The ground's normal N = (-hx, -hy, 1) at (x, y) picks the point of the ring that is farthest against it,
    P = C + ring d, d = -(N - (N.a) a) / |N - (N.a) a|. The contact is where P stands over (x, y) along N,
    (Px - x) + (Pz - h) hx = 0 and (Py - y) + (Pz - h) hy = 0: the equations of `rover_pin.contact.refine`
    with the third, T.N = 0, solved in closed form, and the same elimination. Regular at any depth.

    One step is taken (where the equations are no minimum's, to the foot of P along N), and height, normal and
    distance are carried along it to second order. The distance (P - W).n - tread is stationary in (x, y), so
    that it errs by the square of the step.

    Returns:
        gap, W (3), n (3), length of the step [m].
    """
    h, hx, hy, hxx, hxy, hyy = tabled(kind, table, params, x, y)
    nn = az - hx * ax - hy * ay
    dx, dy, dz = hx + nn * ax, hy + nn * ay, nn * az - 1.0
    length = math.sqrt(dx * dx + dy * dy + dz * dz)
    lever = ring / max(length, 1e-12)
    px, py, pz = cx + lever * dx, cy + lever * dy, cz + lever * dz
    v = pz - h
    f1, f2 = (px - x) + v * hx, (py - y) + v * hy
    a11, a12, a22 = 1.0 + hx * hx - v * hxx, hx * hy - v * hxy, 1.0 + hy * hy - v * hyy
    det = a11 * a22 - a12 * a12
    good = a11 > 0.0 and det > 1e-3 * a11 * a22
    inverse = 1.0 / det
    s1, s2 = (a22 * f1 - a12 * f2) * inverse, (a11 * f2 - a12 * f1) * inverse
    if ring > 0.0:
        good = good and length > 1e-3
        tx, ty, tz = lever * (ay * dz - az * dy), lever * (az * dx - ax * dz), lever * (ax * dy - ay * dx)
        c1, c2 = tx + tz * hx, ty + tz * hy
        b1, b2 = (a22 * c1 - a12 * c2) * inverse, (a11 * c2 - a12 * c1) * inverse
        j1, j2 = -(tx * hxx + ty * hxy), -(tx * hxy + ty * hyy)
        pivot = ring * length + j1 * b1 + j2 * b2
        good = good and pivot > 1e-3 * ring
        sp = -(j1 * s1 + j2 * s2) / pivot
        s1, s2 = s1 + b1 * sp, s2 + b2 * sp
    if not good:
        unit = 1.0 / math.sqrt(1.0 + hx * hx + hy * hy)
        away = (v - (px - x) * hx - (py - y) * hy) * unit * unit
        s1, s2 = (px - x) + away * hx, (py - y) + away * hy
    size = math.sqrt(s1 * s1 + s2 * s2)
    most = ring + tread + abs(v)
    if size > most:
        s1, s2 = s1 * most / size, s2 * most / size
    g1, g2 = hxx * s1 + hxy * s2, hxy * s1 + hyy * s2
    x, y, h = x + s1, y + s2, h + (hx + 0.5 * g1) * s1 + (hy + 0.5 * g2) * s2
    hx, hy = hx + g1, hy + g2
    unit = 1.0 / math.sqrt(1.0 + hx * hx + hy * hy)
    nx, ny, nz = -hx * unit, -hy * unit, unit
    nn = nx * ax + ny * ay + nz * az
    over = (cx - x) * nx + (cy - y) * ny + (cz - h) * nz
    gap = over - ring * math.sqrt(max(1.0 - nn * nn, 0.0)) - tread
    return gap, x, y, h, nx, ny, nz, size
