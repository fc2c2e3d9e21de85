"""The point of the surface nearest to a given point."""

from __future__ import annotations

import math

from rover_pin.numerics import Array, formula
from rover_pin.terrain.surface import surface

Seven = tuple[float, float, float, float, float, float, float]


@formula
def upright(x: float, y: float, h: float, hx: float, hy: float, px: float, py: float, pz: float) -> Seven:
    """Surface normal n at (x, y) and the offset (P - W).n of P along it.

    Returns:
        Seven numbers: W, n, offset.
    """
    s = 1.0 / math.sqrt(1.0 + hx * hx + hy * hy)
    offset = ((pz - h) - (px - x) * hx - (py - y) * hy) * s
    return x, y, h, -hx * s, -hy * s, s, offset


@formula
def nearest(
    kind: int,
    table: Array,
    params: Array,
    spacing: float,
    px: float,
    py: float,
    pz: float,
    x: float,
    y: float,
) -> tuple[Seven, bool]:
    """Local nearest point W of the surface to P, from the start (x, y), by damped Newton.

    Minimises f = |P - W(x, y)|^2 / 2; its gradient is -((Px-x) + (Pz-h) hx, (Py-y) + (Pz-h) hy), its Hessian
    I + grad h grad h' - (Pz-h) hess h, shifted to be positive where it is not.

    Args:
        kind: terrain kind.
        table: terrain table.
        params: terrain parameters.
        spacing: terrain's feature size, m; steps are kept to it.
        px: x of P, m.
        py: y of P.
        pz: z of P.
        x: start, m.
        y: start, m.

    Returns:
        (W (3), n (3), signed distance), True where f's gradient vanished.
    """
    h, hx, hy, hxx, hxy, hyy = surface(kind, table, params, x, y)
    reach = min(spacing, 1.0) + abs(pz - h)
    f = 0.5 * ((px - x) ** 2 + (py - y) ** 2 + (pz - h) ** 2)
    for _ in range(40):
        v = pz - h
        g1 = (px - x) + v * hx
        g2 = (py - y) + v * hy
        scale = 1.0 + hx * hx + hy * hy
        a11 = 1.0 + hx * hx - v * hxx
        a12 = hx * hy - v * hxy
        a22 = 1.0 + hy * hy - v * hyy
        low = 0.5 * (a11 + a22) - math.sqrt(0.25 * (a11 - a22) ** 2 + a12 * a12)
        if low < 0.05:
            a11 += 0.1 * scale - low
            a22 += 0.1 * scale - low
        det = a11 * a22 - a12 * a12
        s1 = (a22 * g1 - a12 * g2) / det
        s2 = (a11 * g2 - a12 * g1) / det
        size = math.sqrt(s1 * s1 + s2 * s2)
        if size < 1e-13 * (1.0 + abs(v)):
            return upright(x, y, h, hx, hy, px, py, pz), True
        if size > reach:
            s1 *= reach / size
            s2 *= reach / size
        slope = -(g1 * s1 + g2 * s2)
        t = 1.0
        better = False
        for _ in range(12):
            xn, yn = x + t * s1, y + t * s2
            h, hx, hy, hxx, hxy, hyy = surface(kind, table, params, xn, yn)
            fn = 0.5 * ((px - xn) ** 2 + (py - yn) ** 2 + (pz - h) ** 2)
            if fn <= f + 1e-4 * t * slope + 1e-15 * f:
                better = True
                break
            t *= 0.5
        if not better:
            h, hx, hy, hxx, hxy, hyy = surface(kind, table, params, x, y)
            small = size < 1e-8 * (1.0 + abs(v))
            return upright(x, y, h, hx, hy, px, py, pz), small
        x, y, f = xn, yn, fn
    return upright(x, y, h, hx, hy, px, py, pz), False
