"""The ground along a path as a page carries it: close-meshed where the rover goes, wide away from it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.viz.terrain_mesh import nice_step, window

if TYPE_CHECKING:
    from rover_pin.numerics import Array
    from rover_pin.terrain import Terrain

ROOM = 1.3
"""Wheel spans of close mesh around the path."""

WIDE = 3.0
"""Times as much ground as a stance has, where the terrain has no end."""

MOST = 90_000
"""Vertices of the close mesh."""

OUTER = 26
"""Lines from the close mesh to each border."""

TONE = 200.0
"""Code of the plain tone; one byte a vertex."""


def path_ground(terrain: Terrain, x: Array, y: Array, span: float) -> tuple[dict[str, Any], dict[str, bytes]]:
    """Heights and shades on a lattice whose lines are closer along the path.

    Args:
        terrain: read through `height` and `gradient`.
        x: of the path, m.
        y: of the path, m.
        span: wheel span, m.

    Returns:
        What the page needs to read it (`nx`, `ny`, `grid`: the step of drawn lines, m, `tone`: the code of
        the plain tone), and by name its bytes: `xs`, `ys` and `heights` (ny, nx) m as float32, `tones`
        (ny, nx).
    """
    middle = float(np.mean([x.min(), x.max()])), float(np.mean([y.min(), y.max()]))
    half = max(float(np.ptp(x)), float(np.ptp(y))) / 2
    xmin, xmax, ymin, ymax = window(terrain, *middle, WIDE * span + half / 4)
    near = [
        (max(float(v.min()) - ROOM * span, low), min(float(v.max()) + ROOM * span, high))
        for v, low, high in ((x, xmin, xmax), (y, ymin, ymax))
    ]
    grid = nice_step(span / 2, 1.0)
    origin = [end if np.isfinite(end) else 0.0 for end in terrain.extent[::2]]
    fine = _pitch(terrain, span, (near[0][1] - near[0][0]) * (near[1][1] - near[1][0]))
    xs, ys = (
        _lines(inner, outer, fine, start, grid)
        for inner, outer, start in zip(near, ((xmin, xmax), (ymin, ymax)), origin, strict=True)
    )
    X, Y = np.meshgrid(xs, ys)
    H = np.asarray(terrain.height(X, Y), dtype=np.float64)
    codes = np.clip(np.rint(TONE * _tones(H, np.asarray(terrain.gradient(X, Y)))), 0, 255)
    about = {"nx": len(xs), "ny": len(ys), "grid": grid, "tone": TONE}
    return about, {
        "xs": xs.astype("<f4").tobytes(),
        "ys": ys.astype("<f4").tobytes(),
        "heights": H.astype("<f4").tobytes(),
        "tones": codes.astype(np.uint8).tobytes(),
    }


def _tones(H: Array, gradient: Array) -> Array:
    """Factors on sand, (ny, nx): lighter uphill, darker on flanks, which are seen from above too."""
    reach = float(np.ptp(H))
    uphill = 0.94 + 0.08 * (H - float(H.min())) / reach if reach > 1e-6 else np.ones(H.shape)
    shades: Array = uphill * (1.0 - 0.16 * np.clip(np.linalg.norm(gradient, axis=-1), 0.0, 1.0))
    return shades


def _pitch(terrain: Terrain, span: float, area: float) -> float:
    """Of the close mesh: half the terrain's spacing, doubled until there are not too many vertices."""
    pitch = max(terrain.spacing / 2, span / 160) if np.isfinite(terrain.spacing) else span / 12
    while area / pitch**2 > MOST:
        pitch *= 2
    return float(pitch)


def _lines(
    inner: tuple[float, float], outer: tuple[float, float], pitch: float, origin: float, grid: float
) -> Array:
    """Coordinates: multiples of pitch and grid from the origin within `inner`, then wider out to `outer`."""

    def multiples(step: float, start: float) -> Array:
        low, high = (inner[0] - start) / step, (inner[1] - start) / step
        return start + step * np.arange(np.ceil(low - 1e-9), np.floor(high + 1e-9) + 1)

    close = np.sort(np.concatenate([multiples(pitch, origin), multiples(grid, 0.0), inner]))
    close = close[np.concatenate([[True], np.diff(close) > 1e-3 * pitch])]
    t = np.linspace(0.0, 1.0, OUTER + 1)[1:] ** 2.5
    left = inner[0] - t[::-1] * (inner[0] - outer[0])
    right = inner[1] + t * (outer[1] - inner[1])
    return np.concatenate([left[left < inner[0]], close, right[right > inner[1]]])
