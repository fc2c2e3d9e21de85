"""The terrain's surface as one compiled formula: height, first and second derivatives at a point.

A terrain is (kind, table, params), so that compiled loops of any room can carry it. The height is
`params[0] + params[1] * raw`; `params[2:]` belongs to the kind:

| kind | table | params[2:] |
|---|---|---|
| PLANE | unused (1, 1) | height at the origin [m], slope along x, slope along y |
| SMOOTH | spline coefficients (rows + 2, columns + 2) [m] | x and y of the first node [m], spacing [m] |
| LINEAR | heights of nodes (rows, columns) [m] | x and y of the first node [m], spacing [m] |
| CALLABLE | unused (1, 1) | handle, see `rover_pin.terrain.function` |

Rows run along +y, columns along +x. Outside a grid the surface goes on at the height of its border.
"""

from __future__ import annotations

import math

from numba import objmode

from rover_pin.numerics import Array, formula, inlined
from rover_pin.terrain.function import Six, evaluate

PLANE = 0
SMOOTH = 1
LINEAR = 2
CALLABLE = 3


@formula
def surface(kind: int, table: Array, params: Array, x: float, y: float) -> Six:
    """Height and derivatives (h, hx, hy, hxx, hxy, hyy) [m, -, -, 1/m, 1/m, 1/m] at (x, y) [m, world].

    Finite for every finite point; NaN for a point that is not a number.
    """
    if kind != CALLABLE or math.isnan(x) or math.isnan(y):
        return tabled(kind, table, params, x, y)
    offset, scale = params[0], params[1]
    h, hx, hy, hxx, hxy, hyy = called(params[2], x, y)
    return offset + scale * h, scale * hx, scale * hy, scale * hxx, scale * hxy, scale * hyy


@inlined
def tabled(kind: int, table: Array, params: Array, x: float, y: float) -> Six:
    """`surface` of every kind that is no Python function: the one that compiled batches carry."""
    offset, scale = params[0], params[1]
    if math.isnan(x) or math.isnan(y):
        return math.nan, math.nan, math.nan, math.nan, math.nan, math.nan
    if kind == PLANE:
        h, hx, hy = params[2] + params[3] * x + params[4] * y, params[3], params[4]
        return offset + scale * h, scale * hx, scale * hy, 0.0, 0.0, 0.0
    if kind == SMOOTH:
        h, hx, hy, hxx, hxy, hyy = smooth(table, params, x, y)
    else:
        h, hx, hy, hxx, hxy, hyy = linear(table, params, x, y)
    return offset + scale * h, scale * hx, scale * hy, scale * hxx, scale * hxy, scale * hyy


@inlined
def smooth(c: Array, params: Array, x: float, y: float) -> Six:
    """Biquadratic B-spline over coefficients `c` [m], whose border of one is the mirror of its inside.

    With t in [-1/2, 1/2] from the nearest node the weights of the three nodes about it are
    (1/2 - t)^2 / 2, 3/4 - t^2, (1/2 + t)^2 / 2 (Unser, Splines: a perfect fit, 1999, B-spline of degree 2).
    """
    spacing = params[4]
    u, v = (x - params[2]) / spacing, (y - params[3]) / spacing
    last_u, last_v = c.shape[1] - 3.0, c.shape[0] - 3.0
    in_u, in_v = 0.0 <= u <= last_u, 0.0 <= v <= last_v
    u, v = min(max(u, 0.0), last_u), min(max(v, 0.0), last_v)
    j, i = int(u + 0.5), int(v + 0.5)
    s, t = u - j, v - i
    a0, a1, a2 = 0.5 * (0.5 - s) * (0.5 - s), 0.75 - s * s, 0.5 * (0.5 + s) * (0.5 + s)
    b0, b1, b2 = 0.5 * (0.5 - t) * (0.5 - t), 0.75 - t * t, 0.5 * (0.5 + t) * (0.5 + t)
    d0, d1, d2 = s - 0.5, -2.0 * s, s + 0.5
    c00, c01, c02 = c[i, j], c[i, j + 1], c[i, j + 2]
    c10, c11, c12 = c[i + 1, j], c[i + 1, j + 1], c[i + 1, j + 2]
    c20, c21, c22 = c[i + 2, j], c[i + 2, j + 1], c[i + 2, j + 2]
    r0, r1, r2 = (
        a0 * c00 + a1 * c01 + a2 * c02,
        a0 * c10 + a1 * c11 + a2 * c12,
        a0 * c20 + a1 * c21 + a2 * c22,
    )
    p0, p1, p2 = (
        d0 * c00 + d1 * c01 + d2 * c02,
        d0 * c10 + d1 * c11 + d2 * c12,
        d0 * c20 + d1 * c21 + d2 * c22,
    )
    q0, q1, q2 = c00 - 2.0 * c01 + c02, c10 - 2.0 * c11 + c12, c20 - 2.0 * c21 + c22
    e0, e1, e2 = t - 0.5, -2.0 * t, t + 0.5
    k = 1.0 / spacing
    h = b0 * r0 + b1 * r1 + b2 * r2
    hx = k * (b0 * p0 + b1 * p1 + b2 * p2) if in_u else 0.0
    hy = k * (e0 * r0 + e1 * r1 + e2 * r2) if in_v else 0.0
    hxx = k * k * (b0 * q0 + b1 * q1 + b2 * q2) if in_u else 0.0
    hxy = k * k * (e0 * p0 + e1 * p1 + e2 * p2) if in_u and in_v else 0.0
    hyy = k * k * (r0 - 2.0 * r1 + r2) if in_v else 0.0
    return h, hx, hy, hxx, hxy, hyy


@inlined
def linear(z: Array, params: Array, x: float, y: float) -> Six:
    """Bilinear between the four nodes about the point; on a line of nodes the cell above it counts."""
    spacing = params[4]
    u, v = (x - params[2]) / spacing, (y - params[3]) / spacing
    last_u, last_v = z.shape[1] - 1.0, z.shape[0] - 1.0
    in_u, in_v = 0.0 <= u <= last_u, 0.0 <= v <= last_v
    u, v = min(max(u, 0.0), last_u), min(max(v, 0.0), last_v)
    j, i = min(int(u), z.shape[1] - 2), min(int(v), z.shape[0] - 2)
    s, t = u - j, v - i
    z00, z01, z10, z11 = z[i, j], z[i, j + 1], z[i + 1, j], z[i + 1, j + 1]
    k = 1.0 / spacing
    h = (1.0 - t) * ((1.0 - s) * z00 + s * z01) + t * ((1.0 - s) * z10 + s * z11)
    hx = k * ((1.0 - t) * (z01 - z00) + t * (z11 - z10)) if in_u else 0.0
    hy = k * ((1.0 - s) * (z10 - z00) + s * (z11 - z01)) if in_v else 0.0
    hxy = k * k * (z11 - z10 - z01 + z00) if in_u and in_v else 0.0
    return h, hx, hy, 0.0, hxy, 0.0


@formula
def called(handle: float, x: float, y: float) -> Six:
    """A registered Python function's height and derivatives (one call into the interpreter)."""
    with objmode(h="float64", hx="float64", hy="float64", hxx="float64", hxy="float64", hyy="float64"):
        h, hx, hy, hxx, hxy, hyy = evaluate(int(handle), x, y)
    return h, hx, hy, hxx, hxy, hyy
