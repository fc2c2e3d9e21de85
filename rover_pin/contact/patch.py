"""The nearest place of one cell of a bilinear map to a shape's line."""

from __future__ import annotations

import math

from rover_pin.contact.place import Frame, distance
from rover_pin.numerics import formula

Patch = tuple[float, float, float, float]
Pull = tuple[float, float, float, float, float, float, float]


@formula
def pull(
    form: int, frame: Frame, cx: float, cy: float, cz: float, ring: float, x: float, y: float, z: float
) -> Pull:
    """First and second derivative of half the squared distance of W = (x, y, z) to the shape's line.

    The first is g = W - P with P the line's nearest point, the second I - k t t' with t along the line at P:
    k = ring / (distance to the axis) on a ring, 1 on a segment, 0 at its ends.

    Returns:
        g (3), t sqrt(|k|) (3), sign of k.
    """
    ax, ay, az = frame[0], frame[1], frame[2]
    wx, wy, wz = x - cx, y - cy, z - cz
    along = wx * ax + wy * ay + wz * az
    if form == 1:
        q = min(max(along, -ring), ring)
        k = 1.0 if q == along else 0.0
        return wx - q * ax, wy - q * ay, wz - q * az, k * ax, k * ay, k * az, k
    rx, ry, rz = wx - along * ax, wy - along * ay, wz - along * az
    across = math.sqrt(rx * rx + ry * ry + rz * rz)
    if ring == 0.0 or across < 1e-12:
        return wx, wy, wz, 0.0, 0.0, 0.0, 0.0
    share = ring / across
    s = math.sqrt(share) / across
    tx, ty, tz = s * (ay * rz - az * ry), s * (az * rx - ax * rz), s * (ax * ry - ay * rx)
    return wx - share * rx, wy - share * ry, wz - share * rz, tx, ty, tz, 1.0


@formula
def newton_step(fu: float, fv: float, a11: float, a12: float, a22: float, free: int) -> tuple[float, float]:
    """Downhill step of the free variables (1: u, 2: v, 3: both); the matrix shifted where not positive."""
    least = 0.05
    if free == 1:
        return -fu / max(a11, least), 0.0
    if free == 2:
        return 0.0, -fv / max(a22, least)
    low = 0.5 * (a11 + a22) - math.sqrt(0.25 * (a11 - a22) ** 2 + a12 * a12)
    if low < least:
        a11 += 2.0 * least - low
        a22 += 2.0 * least - low
    det = a11 * a22 - a12 * a12
    return -(a22 * fu - a12 * fv) / det, -(a11 * fv - a12 * fu) / det


@formula
def room(u: float, su: float, side: float) -> float:
    """How many steps su from u stay within 0 and side."""
    if su > 0.0:
        return (side - u) / su
    return -u / su if su < 0.0 else math.inf


@formula
def descend(
    form: int, frame: Frame, cx: float, cy: float, cz: float, ring: float, x0: float, y0: float, side: float,
    patch: Patch, u: float, v: float,
) -> tuple[float, float, float, bool]:  # fmt: skip
    """Least distance of one cell's surface to the shape's line, by Newton kept within the cell.

    Args: form to ring as for `place`, and
        x0: the cell's corner, m.
        y0: the cell's corner, m.
        side: the cell's width, m.
        patch: (z, p, q, r): height z + p u + q v + r u v over the corner's (u, v).
        u: start, m from the corner.
        v: start, m from the corner.

    Returns:
        u, v, distance [m], True where it converged.
    """
    z0, hp, hq, hr = patch
    far = distance(form, frame, cx, cy, cz, ring, x0 + u, y0 + v, z0 + hp * u + hq * v + hr * u * v)
    for _ in range(40):
        hu, hv = hp + hr * v, hq + hr * u
        z = z0 + hp * u + hv * v
        gx, gy, gz, tx, ty, tz, k = pull(form, frame, cx, cy, cz, ring, x0 + u, y0 + v, z)
        fu, fv = gx + gz * hu, gy + gz * hv
        held_u = (u <= 0.0 and fu > 0.0) or (u >= side and fu < 0.0)
        held_v = (v <= 0.0 and fv > 0.0) or (v >= side and fv < 0.0)
        free = (0 if held_u else 1) + (0 if held_v else 2)
        if free == 0:
            return u, v, far, True
        bu, bv = tx + tz * hu, ty + tz * hv
        a11 = 1.0 + hu * hu - k * bu * bu
        a12 = hu * hv - k * bu * bv + gz * hr
        a22 = 1.0 + hv * hv - k * bv * bv
        su, sv = newton_step(fu, fv, a11, a12, a22, free)
        if free == 3 and min(room(u, su, side), room(v, sv, side)) <= 0.0:
            su, sv = newton_step(fu, fv, a11, a12, a22, 1)[0], newton_step(fu, fv, a11, a12, a22, 2)[1]
        size = math.sqrt(su * su + sv * sv)
        if size < 1e-13 * (side + far):
            return u, v, far, True
        t = min(1.0, room(u, su, side), room(v, sv, side))
        better = False
        for _ in range(14):
            un = min(max(u + t * su, 0.0), side)
            vn = min(max(v + t * sv, 0.0), side)
            zn = z0 + hp * un + hq * vn + hr * un * vn
            new = distance(form, frame, cx, cy, cz, ring, x0 + un, y0 + vn, zn)
            if new * new <= far * far + 2e-4 * t * (fu * su + fv * sv) + 1e-15 * far * far:
                better = True
                break
            t *= 0.5
        if not better:
            return u, v, far, size < 1e-7 * (side + far)
        u, v, far = un, vn, new
    return u, v, far, False
