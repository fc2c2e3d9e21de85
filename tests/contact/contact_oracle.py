"""Least distance of shapes to a terrain by brute force; shares nothing with the search but `surface`."""

from __future__ import annotations

import math

import numba
import numpy as np
from scipy.optimize import minimize

from rover_pin.contact.search import find_contacts
from rover_pin.terrain import Terrain
from rover_pin.terrain.surface import surface

K = 8


def contacts(terrain, shape, window=1e-6):
    """Rows of the search for shape = (form, center, axis, ring, tread)."""
    form, center, axis, ring, tread = shape
    out = np.full((K, 7), np.nan)
    center, axis = np.asarray(center, float), np.asarray(axis, float)
    n = find_contacts(
        terrain.kind,
        terrain.table,
        terrain.params,
        terrain.spacing,
        form,
        center,
        axis,
        ring,
        tread,
        window,
        out,
    )
    return out[:n]


@numba.njit
def _heights(kind, table, params, x, y):
    h = np.empty(x.size)
    for i in range(x.size):
        h[i] = surface(kind, table, params, x[i], y[i])[0]
    return h


def heights(terrain, x, y):
    return _heights(terrain.kind, terrain.table, terrain.params, np.ravel(x), np.ravel(y))


def to_line(shape, x, y, z):
    """Distance of points to the shape's circle or segment."""
    form, center, axis, ring, _ = shape
    w = np.stack([x, y, z], axis=-1) - center
    along = w @ np.asarray(axis)
    across = np.sqrt(np.maximum((w * w).sum(-1) - along**2, 0.0))
    if form == 1:
        return np.hypot(across, along - np.clip(along, -ring, ring))
    return np.hypot(along, across - ring)


def brute(terrain, shape, margin=0.02, n=300):
    """Gap of a shape whose line is above the ground: a dense look at the ground below, then ever closer.

    The five best separate places of the look are refined (Nelder-Mead, then grids a seventh as wide each).
    """
    form, center, axis, ring, tread = shape
    axis = np.asarray(axis)
    reach = ring * (np.sqrt(1 - axis[:2] ** 2) if form == 0 else np.abs(axis[:2])) + tread + margin
    x, y = (np.linspace(center[k] - reach[k], center[k] + reach[k], n) for k in (0, 1))
    gx, gy = (g.ravel() for g in np.meshgrid(x, y))
    d = to_line(shape, gx, gy, heights(terrain, gx, gy))
    order = np.argsort(d)[:400]
    starts: list[int] = []
    for i in order:
        if all(math.hypot(gx[i] - gx[j], gy[i] - gy[j]) > 0.005 for j in starts):
            starts.append(i)
        if len(starts) == 5:
            break

    def cost(p):
        return float(to_line(shape, p[:1], p[1:], heights(terrain, p[:1], p[1:]))[0])

    best, at = math.inf, None
    for i in starts:
        got = minimize(cost, [gx[i], gy[i]], method="Nelder-Mead", options={"xatol": 1e-10, "fatol": 1e-13})
        place, least = got.x, got.fun
        if d[i] < least:
            place, least = np.array([gx[i], gy[i]]), d[i]
        wide = 2 * max(x[1] - x[0], y[1] - y[0])
        for _ in range(8):
            u = np.linspace(-wide, wide, 29)
            px, py = ((place[k] + g).ravel() for k, g in enumerate(np.meshgrid(u, u)))
            dd = to_line(shape, px, py, heights(terrain, px, py))
            j = int(np.argmin(dd))
            if dd[j] < least:
                place, least = np.array([px[j], py[j]]), dd[j]
            wide /= 7
        if least < best:
            best, at = least, place
    return best - tread, at


def unit(v):
    v = np.asarray(v, float)
    return v / np.linalg.norm(v)


def wheel_axis(yaw, camber):
    """Axis of a wheel heading along yaw, leaning by camber."""
    return np.array([-math.sin(yaw) * math.cos(camber), math.cos(yaw) * math.cos(camber), math.sin(camber)])


def rough_map(n, spacing, rms, seed, interpolation="smooth"):
    """A seeded map with waves down to three spacings."""
    rng = np.random.default_rng(seed)
    k = np.hypot(*np.meshgrid(np.fft.fftfreq(n, spacing), np.fft.fftfreq(n, spacing)))
    k[0, 0] = math.inf
    band = (k < 1 / (3 * spacing)) & (k > 1 / 20)
    z = np.fft.ifft2(np.fft.fft2(rng.normal(size=(n, n))) * np.where(band, k, np.inf) ** -1.8).real
    return Terrain.from_grid(z / z.std() * rms, spacing, interpolation=interpolation)


def lowered(terrain, shape, gap=0.0):
    """The shape moved up or down until its gap is `gap` (secant on the search itself)."""
    form, center, axis, ring, tread = shape
    center = np.array(center, float)
    for _ in range(60):
        row = contacts(terrain, (form, center, axis, ring, tread))[0]
        if abs(row[0] - gap) < 1e-12:
            break
        center[2] -= (row[0] - gap) / max(row[6], 0.3)
    return form, center, axis, ring, tread


@numba.njit
def _far(kind, table, params, form, c, a, ring, x, y):
    wx, wy, wz = x - c[0], y - c[1], surface(kind, table, params, x, y)[0] - c[2]
    along = wx * a[0] + wy * a[1] + wz * a[2]
    across = math.sqrt(max(wx * wx + wy * wy + wz * wz - along * along, 0.0))
    if form == 1:
        return math.hypot(across, along - min(max(along, -ring), ring))
    return math.hypot(along, across - ring)


@numba.njit
def _dense(kind, table, params, form, c, a, ring, x0, y0, nx, ny, pitch):
    """Least of a grid's far values after every low place is followed on 9 x 9 grids, ever narrower."""
    d = np.empty((nx, ny))
    for i in range(nx):
        for j in range(ny):
            d[i, j] = _far(kind, table, params, form, c, a, ring, x0 + i * pitch, y0 + j * pitch)
    best = d.min()
    limit = best + pitch
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            if d[i, j] > limit or d[i, j] > d[i - 1 : i + 2, j - 1 : j + 2].min():
                continue
            x, y, wide, least = x0 + i * pitch, y0 + j * pitch, pitch, d[i, j]
            for _ in range(400):
                px, py, before = x, y, least
                for k in range(81):
                    qx, qy = x + wide * (k // 9 - 4) / 4, y + wide * (k % 9 - 4) / 4
                    far = _far(kind, table, params, form, c, a, ring, qx, qy)
                    if far < least:
                        px, py, least = qx, qy, far
                x, y = px, py
                if least > before - 1e-3 * wide * wide:
                    wide *= 0.4
                if wide < 1e-9:
                    break
            best = min(best, least)
    return best


def dense(terrain, shape, finest=0.003):
    """Gap of a shape whose line is above a bilinear map: a grid with all nodes, its low places refined."""
    form, center, axis, ring, tread = shape
    reach = ring * (np.sqrt(1 - axis[:2] ** 2) if form == 0 else np.abs(axis[:2])) + tread + 0.02
    pitch = terrain.spacing / math.ceil(max(terrain.spacing / finest, 16.0))
    corner = np.floor((center[:2] - reach - terrain.params[2:4]) / terrain.spacing) * terrain.spacing
    corner += terrain.params[2:4] - pitch
    nx, ny = (np.ceil((center[:2] + reach - corner) / pitch) + 2).astype(int)
    return (
        _dense(
            terrain.kind, terrain.table, terrain.params, form, center, axis, ring, *corner, nx, ny, pitch,
        )
        - tread
    )  # fmt: skip


def is_minimum(terrain, shape, x, y, step=1e-6):
    """Whether the shape's line is no nearer on a small circle about (x, y) than there."""
    turn = np.linspace(0.0, 2.0 * math.pi, 33)
    px, py = np.append(x + step * np.cos(turn), x), np.append(y + step * np.sin(turn), y)
    far = to_line(shape, px, py, heights(terrain, px, py))
    return bool(np.min(far[:-1]) > far[-1] - 1e-12)
