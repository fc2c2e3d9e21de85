"""A coarse look over the lower skin of a shape: where it comes near the ground."""

from __future__ import annotations

import math

import numpy as np

from rover_pin.contact.place import Frame
from rover_pin.numerics import Array, formula
from rover_pin.terrain.surface import surface

MOST_ROWS = 128
MOST_COLUMNS = 15
STRIDE = 3

Grid = tuple[int, int, int, float, float, float, bool, float]


@formula
def lattice(
    kind: int, spacing: float, form: int, frame: Frame, ring: float, ball: float, thorough: bool
) -> Grid:
    """How finely to look: rows along the line, columns around the ball.

    Neighbours are at most half of the terrain's `spacing` apart, a quarter where thorough (within the bounds
    on rows and columns), rows at most an eighth of the shape. A ring whose axis is level needs its lower half
    only: of two points one above the other the lower is the nearer to a height field.

    Args:
        kind: terrain kind.
        spacing: terrain's feature size, m.
        form: RING or SEGMENT.
        frame: nine numbers of `basis`.
        ring: ring radius or half length, m.
        ball: radius of the tube looked at, m.
        thorough: whether dips that differ by less than a thousandth of the spacing must be told apart.

    Returns:
        rows, columns, rows of one cap (segments), first p, step of p, step of the column angle, True for a
        closed ring, arc between rows [m].
    """
    share = 1.0 if kind == 3 else (0.25 if thorough else 0.5)
    fine = max(share * spacing, 1e-6)
    step = max(min(fine, (ring + ball) / 8.0), 1e-6)
    columns = 1
    if ball > 0.0:
        wanted = math.ceil(min(math.pi * ball / fine, 100.0))
        columns = max(min(wanted + 1 - wanted % 2, MOST_COLUMNS), 3)
    turn = math.pi / columns
    if form == 1:
        cap = 3 if ball > 0.0 else 0
        n = max(min(math.ceil(min(2.0 * ring / step, 1e6)), MOST_ROWS - 8), 1)
        return n + 1 + 2 * cap, columns, cap, -ring, 2.0 * ring / n, turn, False, 2.0 * ring / n
    if ring + ball == 0.0:
        return 1, 1, 0, 0.0, 0.0, turn, False, 0.0
    closed = abs(frame[2]) > 0.02
    span = 2.0 * math.pi if closed else 1.04 * math.pi
    n = max(min(math.ceil(span * (ring + ball) / step), MOST_ROWS), 8)
    arc = span * (ring + ball) / n
    return (n if closed else n + 1), columns, 0, -0.5 * span, span / n, turn, closed, arc


@formula
def skin_point(
    form: int,
    frame: Frame,
    cx: float,
    cy: float,
    cz: float,
    ring: float,
    ball: float,
    grid: Grid,
    i: int,
    j: int,
) -> tuple[float, float, float, float, float]:
    """Skin point of row i, column j: parameter p, the point, and its outward direction's z.

    Ring: u = r(p) cos b + a sin b. Segment: u = d cos b + e sin b, leaning out along the axis in the caps.

    Returns:
        p, point (3), z of the outward direction (-1 where the tube has no thickness).
    """
    ax, ay, az, dx, dy, dz, ex, ey, ez = frame
    rows, columns, cap, first, step, turn = grid[0], grid[1], grid[2], grid[3], grid[4], grid[5]
    b = (j - 0.5 * (columns - 1)) * turn
    cb, sb = math.cos(b), math.sin(b)
    if form == 1:
        p = min(first + min(max(i - cap, 0), rows - 1 - 2 * cap) * step, ring)
        lean = 0.0
        if i < cap:
            lean = (i - cap) * math.pi / 7.0
        elif i > rows - 1 - cap:
            lean = (i - (rows - 1 - cap)) * math.pi / 7.0
        cl, sl = math.cos(lean), math.sin(lean)
        ux = cl * (cb * dx + sb * ex) + sl * ax
        uy = cl * (cb * dy + sb * ey) + sl * ay
        uz = cl * (cb * dz + sb * ez) + sl * az
        px, py, pz = cx + p * ax, cy + p * ay, cz + p * az
    else:
        p = first + i * step
        cp, sp = math.cos(p), math.sin(p)
        rx, ry, rz = cp * dx + sp * ex, cp * dy + sp * ey, cp * dz + sp * ez
        ux, uy, uz = cb * rx + sb * ax, cb * ry + sb * ay, cb * rz + sb * az
        px, py, pz = cx + ring * rx, cy + ring * ry, cz + ring * rz
    if ball == 0.0:
        return p, px, py, pz, -1.0
    return p, px + ball * ux, py + ball * uy, pz + ball * uz, uz


@formula
def look(
    kind: int, table: Array, params: Array, form: int, frame: Frame, cx: float, cy: float, cz: float,
    ring: float, ball: float, grid: Grid, i: int, near: Array,
) -> float:  # fmt: skip
    """Fill row i of `near`: vertical clearance / sqrt(1 + |grad h|^2); infinity where the skin faces up.

    Returns:
        The least of the row.
    """
    least = math.inf
    for j in range(grid[1]):
        _, x, y, z, uz = skin_point(form, frame, cx, cy, cz, ring, ball, grid, i, j)
        if uz < -0.02:
            h, hx, hy, _, _, _ = surface(kind, table, params, x, y)
            near[i, j] = (z - h) / math.sqrt(1.0 + hx * hx + hy * hy)
            least = min(least, near[i, j])
    return least


@formula
def slack(window: float, arc: float, ball: float, least: float) -> float:
    """How far above the least estimate a hollow is still wanted: the window and what estimates can err by."""
    return window + 0.3 * arc + 0.15 * ball + 0.3 * abs(least)


@formula
def clearances(
    kind: int, table: Array, params: Array, form: int, frame: Frame, cx: float, cy: float, cz: float,
    ring: float, ball: float, grid: Grid, window: float, near: Array,
) -> float:  # fmt: skip
    """Estimated distance to the surface at the skin points that matter, infinity elsewhere.

    Every third row is looked at; the rows between only where they could come within the slack, the estimate
    falling by no more than twice the arc.

    Returns:
        The least, m; `near` (rows, columns) is filled.
    """
    rows, closed, arc = grid[0], grid[6], grid[7]
    near[:, :] = math.inf
    row = np.full(rows, math.inf)
    least = math.inf
    for i in range(0, rows, STRIDE):
        row[i] = look(kind, table, params, form, frame, cx, cy, cz, ring, ball, grid, i, near)
        least = min(least, row[i])
    for i in range(rows):
        if i % STRIDE == 0:
            continue
        before = i - i % STRIDE
        after = before + STRIDE
        if after >= rows and closed:
            after = 0
        bound = row[before] - 2.0 * arc * (i - before)
        if after < rows:
            bound = min(bound, row[after] - 2.0 * arc * (before + STRIDE - i))
        if bound <= max(least, 0.0) + slack(window, arc, ball, least) or (
            form == 1 and i >= rows - 1 - grid[2]
        ):
            least = min(least, look(kind, table, params, form, frame, cx, cy, cz, ring, ball, grid, i, near))
    return least


@formula
def hollow(near: Array, i: int, j: int, closed: bool) -> bool:
    """Whether entry (i, j) is no larger than its eight neighbours (ties go to the first)."""
    rows, columns = near.shape
    here = near[i, j]
    if not here < math.inf:
        return False
    for di in range(-1, 2):
        k = i + di
        if closed:
            k = k % rows
        elif k < 0 or k >= rows:
            continue
        for dj in range(-1, 2):
            m = j + dj
            if m < 0 or m >= columns or (di == 0 and dj == 0):
                continue
            before = k < i or (k == i and m < j)
            if near[k, m] < here or (before and near[k, m] == here):
                return False
    return True
