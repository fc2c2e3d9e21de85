"""From a rough place on a shape to the exact least distance near it."""

from __future__ import annotations

import math

from rover_pin.contact.crease import touch
from rover_pin.contact.nearest import Seven, upright
from rover_pin.contact.place import Frame, place
from rover_pin.numerics import Array, formula
from rover_pin.terrain.surface import surface


@formula
def newton(
    kind: int, table: Array, params: Array, form: int, frame: Frame, cx: float, cy: float, cz: float,
    ring: float, width: float, p: float, x: float, y: float,
) -> tuple[float, Seven, bool]:  # fmt: skip
    """Stationary distance between the shape's line and the surface, by Newton on (x, y, p).

    Equations, with P(p), T = dP/dp and N = (-hx, -hy, 1):
    (Px-x) + (Pz-h) hx = 0, (Py-y) + (Pz-h) hy = 0, T.N = 0. The first two are eliminated, so that the pivot
    of the third is the curvature of the distance along the line; where it is not positive the step goes
    downhill by `width`. Regular at distance zero, where the gradient of the distance itself is not.

    Args:
        kind: terrain kind.
        table: terrain table.
        params: terrain parameters.
        form: RING or SEGMENT.
        frame: nine numbers of `basis`.
        cx: centre, m.
        cy: centre, m.
        cz: centre, m.
        ring: ring radius or half length, m.
        width: longest step in p.
        p: start.
        x: start, m.
        y: start, m.

    Returns:
        p, (W (3), n (3), signed distance), True where it converged to a minimum.
    """
    lever = 1.0 if form == 1 else ring
    moves = lever > 0.0
    for _ in range(14):
        px, py, pz, tx, ty, tz, qx, qy, qz = place(form, frame, cx, cy, cz, ring, p)
        h, hx, hy, hxx, hxy, hyy = surface(kind, table, params, x, y)
        v = pz - h
        f1 = (px - x) + v * hx
        f2 = (py - y) + v * hy
        a11 = 1.0 + hx * hx - v * hxx
        a12 = hx * hy - v * hxy
        a22 = 1.0 + hy * hy - v * hyy
        det = a11 * a22 - a12 * a12
        if not (a11 > 0.0 and det > 1e-3 * a11 * a22):
            break
        s1 = (a22 * f1 - a12 * f2) / det
        s2 = (a11 * f2 - a12 * f1) / det
        sp = 0.0
        convex = True
        if moves:
            c1 = tx + tz * hx
            c2 = ty + tz * hy
            b1 = (a22 * c1 - a12 * c2) / det
            b2 = (a11 * c2 - a12 * c1) / det
            j1 = -(tx * hxx + ty * hxy)
            j2 = -(tx * hxy + ty * hyy)
            pivot = qz - qx * hx - qy * hy + j1 * b1 + j2 * b2
            f3 = tz - tx * hx - ty * hy + j1 * s1 + j2 * s2
            convex = pivot > 1e-9 * lever
            sp = -f3 / pivot if convex else -math.copysign(width, f3)
            sp = min(max(sp, -width), width)
            if form == 1:
                sp = min(max(p + sp, -ring), ring) - p
            s1 += b1 * sp
            s2 += b2 * sp
        x += s1
        y += s2
        p += sp
        if abs(s1) + abs(s2) + lever * abs(sp) < 1e-9:
            px, py, pz, tx, ty, tz, qx, qy, qz = place(form, frame, cx, cy, cz, ring, p)
            h, hx, hy, hxx, hxy, hyy = surface(kind, table, params, x, y)
            ends = form == 1 and abs(p) >= ring
            return p, upright(x, y, h, hx, hy, px, py, pz), convex or ends
    px, py, pz, tx, ty, tz, qx, qy, qz = place(form, frame, cx, cy, cz, ring, p)
    h, hx, hy, hxx, hxy, hyy = surface(kind, table, params, x, y)
    return p, upright(x, y, h, hx, hy, px, py, pz), False


@formula
def slope_at(
    kind: int, table: Array, params: Array, spacing: float, form: int, frame: Frame, cx: float, cy: float,
    cz: float, ring: float, p: float, x: float, y: float,
) -> tuple[float, Seven]:  # fmt: skip
    """Signed distance at `p`, its derivative by `p` (T.n), and W and n.

    Returns:
        Derivative, (W (3), n (3), signed distance).
    """
    px, py, pz, tx, ty, tz, _, _, _ = place(form, frame, cx, cy, cz, ring, p)
    found = touch(kind, table, params, spacing, px, py, pz, x, y)
    return tx * found[3] + ty * found[4] + tz * found[5], found


@formula
def nested(
    kind: int, table: Array, params: Array, spacing: float, form: int, frame: Frame, cx: float, cy: float,
    cz: float, ring: float, width: float, p: float, x: float, y: float,
) -> tuple[float, Seven]:  # fmt: skip
    """The same minimum where Newton fails: bracketed root of the derivative along the line.

    At each p the nearest surface point is found on its own, and the derivative of the distance is T.n. The
    bracket moves downhill until it holds a minimum, then shrinks by regula falsi (Illinois) and bisection.

    Args: as `newton`, and `spacing`, the terrain's feature size.

    Returns:
        p, (W (3), n (3), signed distance).
    """
    bound = ring if form == 1 else 1e300
    lo, hi = max(p - width, -bound), min(p + width, bound)
    a = slope_at(kind, table, params, spacing, form, frame, cx, cy, cz, ring, lo, x, y)
    b = slope_at(kind, table, params, spacing, form, frame, cx, cy, cz, ring, hi, x, y)
    for _ in range(6):
        if a[0] > 0.0 and lo > -bound:
            hi, b = lo, a
            lo = max(lo - width, -bound)
            a = slope_at(kind, table, params, spacing, form, frame, cx, cy, cz, ring, lo, a[1][0], a[1][1])
        elif b[0] < 0.0 and hi < bound:
            lo, a = hi, b
            hi = min(hi + width, bound)
            b = slope_at(kind, table, params, spacing, form, frame, cx, cy, cz, ring, hi, b[1][0], b[1][1])
        else:
            break
    if a[0] >= 0.0:
        return lo, a[1]
    if b[0] <= 0.0:
        return hi, b[1]
    ga, gb = a[0], b[0]
    side = 0
    c = a
    p = lo
    for i in range(60):
        p = 0.5 * (lo + hi) if i % 4 == 3 else (lo * gb - hi * ga) / (gb - ga)
        start = a if p - lo < hi - p else b
        c = slope_at(kind, table, params, spacing, form, frame, cx, cy, cz, ring, p, start[1][0], start[1][1])
        if abs(c[0]) < 1e-14 or hi - lo < 1e-12:
            break
        if c[0] < 0.0:
            lo, a, ga = p, c, c[0]
            if side == -1:
                gb *= 0.5
            side = -1
        else:
            hi, b, gb = p, c, c[0]
            if side == 1:
                ga *= 0.5
            side = 1
    return p, c[1]


@formula
def refine(
    kind: int, table: Array, params: Array, spacing: float, form: int, frame: Frame, cx: float, cy: float,
    cz: float, ring: float, width: float, p: float, x: float, y: float,
) -> Seven:  # fmt: skip
    """The minimum near a seed: Newton's, or `nested`'s where that is none, is farther or is another's.

    Returns:
        W (3), n (3), signed distance.
    """
    q, found, good = newton(kind, table, params, form, frame, cx, cy, cz, ring, width, p, x, y)
    px, py, pz, _, _, _, _, _, _ = place(form, frame, cx, cy, cz, ring, p)
    h = surface(kind, table, params, x, y)[0]
    start = math.sqrt((px - x) ** 2 + (py - y) ** 2 + (pz - h) ** 2)
    strayed = (found[0] - x) ** 2 + (found[1] - y) ** 2 > spacing * spacing
    if good and found[6] < 0.0:
        px, py, pz, _, _, _, _, _, _ = place(form, frame, cx, cy, cz, ring, q)
        good = pz <= surface(kind, table, params, px, py)[0]
        if good:
            return found
    good = good and found[6] <= start + 1e-12
    if good and not strayed:
        return found
    _, other = nested(kind, table, params, spacing, form, frame, cx, cy, cz, ring, width, p, x, y)
    return found if good and found[6] <= other[6] + 1e-9 else other
