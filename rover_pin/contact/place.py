"""Where a shape's ball centres lie: a ring about an axis, or a segment along it."""

from __future__ import annotations

import math

from rover_pin.numerics import formula

RING = 0
SEGMENT = 1

Frame = tuple[float, float, float, float, float, float, float, float, float]


@formula
def basis(form: int, ring: float, ax: float, ay: float, az: float) -> Frame:
    """Orthonormal axis `a`, down `d` and side `e` of a shape.

    `d` is -z projected across the axis, `e = a x d` is horizontal. Where the axis is vertical every
    perpendicular is as low as any other and `d` is the x direction's. A ring of no radius (a sphere) has no
    axis of its own and takes y.

    Args:
        form: RING or SEGMENT.
        ring: ring radius or half length, m.
        ax: x component of the unit axis, world.
        ay: y component.
        az: z component.

    Returns:
        Nine numbers: a, d, e.
    """
    if form == 0 and ring == 0.0:
        return 0.0, 1.0, 0.0, 0.0, 0.0, -1.0, -1.0, 0.0, 0.0
    s = math.sqrt(ax * ax + ay * ay)
    if s > 1e-9:
        dx, dy, dz = az * ax / s, az * ay / s, -s
    else:
        dx, dy, dz = 1.0, 0.0, 0.0
    return ax, ay, az, dx, dy, dz, ay * dz - az * dy, az * dx - ax * dz, ax * dy - ay * dx


@formula
def place(form: int, frame: Frame, cx: float, cy: float, cz: float, ring: float, p: float) -> Frame:
    """Ball centre at parameter `p`, and its first and second derivative by `p`.

    Ring: P = C + ring (d cos p + e sin p), p in rad. Segment: P = C + p a, p in m within +- ring.

    Args:
        form: RING or SEGMENT.
        frame: nine numbers of `basis`.
        cx: x of the shape's centre, m, world.
        cy: y.
        cz: z.
        ring: ring radius or half length, m.
        p: parameter.

    Returns:
        Nine numbers: P, dP/dp, d2P/dp2.
    """
    ax, ay, az, dx, dy, dz, ex, ey, ez = frame
    if form == 1:
        return cx + p * ax, cy + p * ay, cz + p * az, ax, ay, az, 0.0, 0.0, 0.0
    u = ring * math.cos(p)
    w = ring * math.sin(p)
    rx, ry, rz = u * dx + w * ex, u * dy + w * ey, u * dz + w * ez
    return (
        cx + rx, cy + ry, cz + rz,
        u * ex - w * dx, u * ey - w * dy, u * ez - w * dz,
        -rx, -ry, -rz,
    )  # fmt: skip


@formula
def distance(
    form: int, frame: Frame, cx: float, cy: float, cz: float, ring: float, x: float, y: float, z: float
) -> float:
    """Distance [m] of (x, y, z) to the shape's line: hypot(w.a, |w x a| - ring), or to the segment."""
    ax, ay, az = frame[0], frame[1], frame[2]
    wx, wy, wz = x - cx, y - cy, z - cz
    along = wx * ax + wy * ay + wz * az
    across = math.sqrt(max(wx * wx + wy * wy + wz * wz - along * along, 0.0))
    if form == 1:
        along -= min(max(along, -ring), ring)
        return math.sqrt(across * across + along * along)
    return math.sqrt(along * along + (across - ring) ** 2)


@formula
def param_near(
    form: int, frame: Frame, cx: float, cy: float, cz: float, ring: float, x: float, y: float, z: float
) -> float:
    """Parameter of the line's point nearest to (x, y, z): its angle, or its place along the axis."""
    ax, ay, az, dx, dy, dz, ex, ey, ez = frame
    wx, wy, wz = x - cx, y - cy, z - cz
    if form == 1:
        return min(max(wx * ax + wy * ay + wz * az, -ring), ring)
    return math.atan2(wx * ex + wy * ey + wz * ez, wx * dx + wy * dy + wz * dz)
