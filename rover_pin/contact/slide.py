"""How the place where a wheel touches smooth ground slides as the wheel moves."""

from __future__ import annotations

import math

from rover_pin.numerics import Array, formula
from rover_pin.terrain.surface import tabled


@formula
def slide(
    kind: int, table: Array, params: Array, cx: float, cy: float, cz: float, ax: float, ay: float, az: float,
    ring: float, x: float, y: float, out: Array,
) -> None:  # fmt: skip
    """Derivative of a contact's (x, y) by the centre C and the axis a of its ring.

    The contact obeys f1 = (Px - x) + (Pz - h) hx = 0 and f2 = (Py - y) + (Pz - h) hy = 0, P the point of the
    ring that is farthest against the normal, P = C + ring D / |D|, D = (hx, hy, -1) + nn a,
    nn = az - hx ax - hy ay. Implicit differentiation; the ground must be smooth there.

    Args:
        kind: of the surface, no CALLABLE.
        table: its table.
        params: its parameters.
        cx: x of the centre [m].
        cy: y of the centre [m].
        cz: z of the centre [m].
        ax: x of the unit axis.
        ay: y of the unit axis.
        az: z of the unit axis.
        ring: m, radius of the ring.
        x: of the contact [m].
        y: of the contact [m].
        out: (2, 6) receives d(x, y) / d(C, a) [-, m].
    """
    h, hx, hy, hxx, hxy, hyy = tabled(kind, table, params, x, y)
    nn = az - hx * ax - hy * ay
    dx, dy, dz = hx + nn * ax, hy + nn * ay, nn * az - 1.0
    size = max(math.sqrt(dx * dx + dy * dy + dz * dz), 1e-12)
    dx, dy, dz = dx / size, dy / size, dz / size
    s = ring / size
    v = cz + ring * dz - h
    # columns of E = nn 1 + a N', projected across D: P moves by s (1 - d d') E da
    for k in range(3):
        nk = -hx if k == 0 else (-hy if k == 1 else 1.0)
        ex = ax * nk + (nn if k == 0 else 0.0)
        ey = ay * nk + (nn if k == 1 else 0.0)
        ez = az * nk + (nn if k == 2 else 0.0)
        along = dx * ex + dy * ey + dz * ez
        px, py, pz = s * (ex - along * dx), s * (ey - along * dy), s * (ez - along * dz)
        out[0, 3 + k], out[1, 3 + k] = px + hx * pz, py + hy * pz
    out[0, 0], out[0, 1], out[0, 2] = 1.0, 0.0, hx
    out[1, 0], out[1, 1], out[1, 2] = 0.0, 1.0, hy
    # P moves by one and other with hx and hy
    ux, uy, uz = 1.0 - ax * ax, -ax * ay, -ax * az
    along = dx * ux + dy * uy + dz * uz
    ux, uy, uz = s * (ux - along * dx), s * (uy - along * dy), s * (uz - along * dz)
    wx, wy, wz = -ax * ay, 1.0 - ay * ay, -ay * az
    along = dx * wx + dy * wy + dz * wz
    wx, wy, wz = s * (wx - along * dx), s * (wy - along * dy), s * (wz - along * dz)
    b11, b12 = ux + hx * uz, wx + hx * wz
    b21, b22 = uy + hy * uz, wy + hy * wz
    m11 = 1.0 + hx * hx - v * hxx - (b11 * hxx + b12 * hxy)
    m12 = hx * hy - v * hxy - (b11 * hxy + b12 * hyy)
    m21 = hx * hy - v * hxy - (b21 * hxx + b22 * hxy)
    m22 = 1.0 + hy * hy - v * hyy - (b21 * hxy + b22 * hyy)
    det = m11 * m22 - m12 * m21
    for k in range(6):
        f1, f2 = out[0, k], out[1, k]
        out[0, k], out[1, k] = (m22 * f1 - m12 * f2) / det, (m11 * f2 - m21 * f1) / det
