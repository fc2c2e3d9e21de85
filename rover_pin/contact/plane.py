"""Contacts with a plane, in closed form."""

from __future__ import annotations

import math

from rover_pin.contact.place import basis, place
from rover_pin.numerics import Array, formula
from rover_pin.terrain.surface import surface


@formula
def plane_contacts(
    kind: int, table: Array, params: Array, form: int, center: Array, axis: Array, ring: float, tread: float,
    window: float, out: Array,
) -> int:  # fmt: skip
    """Rows of `out` for a plane with unit normal n; see `find_contacts`.

    Ring: the nearest point lies along -n projected across the axis, at (C - W0).n - ring |n_perp|. Where the
    whole ring comes within `window` of the plane it stands on four quarters of it. Segment: an end; both
    where both are within `window`.

    Returns:
        Number of rows.
    """
    cx, cy, cz = center[0], center[1], center[2]
    h, hx, hy, _, _, _ = surface(kind, table, params, cx, cy)
    s = 1.0 / math.sqrt(1.0 + hx * hx + hy * hy)
    nx, ny, nz = -hx * s, -hy * s, s
    frame = basis(form, ring, axis[0], axis[1], axis[2])
    ax, ay, az, dx, dy, dz, ex, ey, ez = frame
    if form == 1:
        first = -math.copysign(ring, ax * nx + ay * ny + az * nz)
        tilt = ring * abs(ax * nx + ay * ny + az * nz)
        places, turn = (2, -2.0 * first) if ring > 0.0 and 2.0 * tilt <= window else (1, 0.0)
    else:
        down = dx * nx + dy * ny + dz * nz
        side = ex * nx + ey * ny + ez * nz
        first = math.atan2(-side, -down) if ring > 0.0 else 0.0
        tilt = ring * math.sqrt(down * down + side * side)
        places, turn = (4, 0.5 * math.pi) if ring > 0.0 and 2.0 * tilt <= window else (1, 0.0)
    count: int = min(places, out.shape[0])
    for k in range(count):
        px, py, pz, _, _, _, _, _, _ = place(form, frame, cx, cy, cz, ring, first + k * turn)
        far = (px - cx) * nx + (py - cy) * ny + (pz - h) * nz
        put(out, k, far - tread, px - far * nx, py - far * ny, pz - far * nz, nx, ny, nz)
    return count


@formula
def put(
    out: Array, k: int, gap: float, wx: float, wy: float, wz: float, nx: float, ny: float, nz: float
) -> None:
    """Write row k of `out`: gap, point on the surface, normal."""
    out[k, 0] = gap
    out[k, 1] = wx
    out[k, 2] = wy
    out[k, 3] = wz
    out[k, 4] = nx
    out[k, 5] = ny
    out[k, 6] = nz
