"""The ground as one mesh: fine where the rover stands, coarser away from it, to the edge of the map."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rover_pin.numerics import Array
from rover_pin.viz.colours import SAND
from rover_pin.viz.surfaces import Surface

if TYPE_CHECKING:
    from rover_pin.terrain import Terrain

STEPS = 112  # vertices to each side of the rover
FARTHEST = 60.0  # m; a larger map is cut there


def stretched(center: float, near: float, low: float, high: float, steps: int = STEPS) -> Array:
    """Coordinates that lie close together within `near` of the centre and reach from `low` to `high`."""
    t = np.linspace(0.0, 1.0, steps + 1)

    def side(reach: float) -> Array:
        if reach <= 0:
            return np.zeros(1)
        inner = min(1.25 * near, reach)
        return inner * t + (reach - inner) * t**5

    return center + np.concatenate([-side(center - low)[:0:-1], side(high - center)])


def window(terrain: Terrain, x: float, y: float, span: float) -> tuple[float, float, float, float]:
    """(xmin, xmax, ymin, ymax) to draw: the map, or where it has no end a square around the rover."""
    far = 4.0 * span
    xmin, xmax, ymin, ymax = terrain.extent

    def cut(center: float, low: float, high: float) -> tuple[float, float]:
        low = max(low, center - FARTHEST) if np.isfinite(low) else center - far
        high = min(high, center + FARTHEST) if np.isfinite(high) else center + far
        return min(low, center), max(high, center)

    return (*cut(x, xmin, xmax), *cut(y, ymin, ymax))


def nice_step(reach: float, lines: float = 10.0) -> float:
    """The 1-2-5 number nearest below `reach / lines`; 0 where there is nothing to divide."""
    if not reach > 1e-6:
        return 0.0
    power = 10.0 ** np.floor(np.log10(reach / lines))
    return float(max(f * power for f in (1.0, 2.0, 5.0) if f * power <= reach / lines * 1.0001))


def ground_surface(terrain: Terrain, x: float, y: float, span: float) -> tuple[Surface, float]:
    """The ground around (x, y) with contour lines in its vertex colours, and the contours' step in m.

    Args:
        terrain: read through `height` and `gradient`, so the picture is the surface the solver stood on.
        x: where the rover stands, m.
        y: where the rover stands, m.
        span: the rover's wheel span, m.
    """
    xmin, xmax, ymin, ymax = window(terrain, x, y, span)
    xs, ys = stretched(x, 1.2 * span, xmin, xmax), stretched(y, 1.2 * span, ymin, ymax)
    X, Y = np.meshgrid(xs, ys)
    H = np.asarray(terrain.height(X, Y), dtype=np.float64)
    near = H[(np.abs(X - x) < 2 * span) & (np.abs(Y - y) < 2 * span)]
    step = nice_step(float(np.ptp(near)))
    colours = _shades(H, _steepness(terrain, X, Y), step, _pitch(xs, ys))
    rows, columns = H.shape
    i, j = np.meshgrid(np.arange(rows - 1), np.arange(columns - 1), indexing="ij")
    a = (i * columns + j).ravel()
    faces = np.concatenate(
        [np.stack([a, a + 1, a + columns], 1), np.stack([a + 1, a + columns + 1, a + columns], 1)]
    )
    return Surface(np.stack([X, Y, H], axis=-1).reshape(-1, 3), faces, colours.reshape(-1, 3)), step


def _steepness(terrain: Terrain, X: Array, Y: Array) -> Array:
    return np.asarray(np.linalg.norm(terrain.gradient(X, Y), axis=-1), dtype=np.float64)


def _pitch(xs: Array, ys: Array) -> Array:
    """Largest distance to the next vertex, (rows, columns)."""
    return np.asarray(np.maximum.outer(np.gradient(ys), np.gradient(xs)), dtype=np.float64)


def _shades(H: Array, steepness: Array, step: float, pitch: Array) -> Array:
    """Sand, a little lighter uphill, darker on contours; none where they would smear or merge."""
    low, reach = float(H.min()), max(float(np.ptp(H)), 1e-9)
    tone = 0.92 + 0.12 * (H - low) / reach if step else np.full(H.shape, 1.0)
    if step:
        away = np.abs(H / step - np.round(H / step)) * step / np.maximum(steepness, 1e-6)
        apart = step / np.maximum(steepness, 1e-6)
        fade = np.clip(apart / (5 * pitch) - 0.6, 0.0, 1.0) * np.clip(
            2.5 - pitch / float(pitch.min()), 0.0, 1.0
        )
        fade *= np.clip(steepness / 2e-3, 0.0, 1.0)  # a level place at a contour's height is no line
        tone = tone * (1 - 0.22 * fade * np.clip(1.1 - away / pitch, 0.0, 1.0))
    return np.asarray(tone[..., None] * np.array(SAND), dtype=np.float64)
