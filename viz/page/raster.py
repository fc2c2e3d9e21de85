"""The ground as a page carries it: heights on a regular grid, 16 bits each, differences along rows."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.viz.page.columns import planes
from rover_pin.viz.terrain_mesh import nice_step

if TYPE_CHECKING:
    from rover_pin.numerics import Array
    from rover_pin.terrain import Terrain

FINEST = 640  # nodes along the longer side


def ground_raster(terrain: Terrain, x: Array, y: Array, span: float) -> tuple[dict[str, Any], bytes]:
    """Heights over the cases with room around them, within the map.

    Args:
        terrain: read through `height`.
        x: of the cases, m.
        y: of the cases, m.
        span: wheel span, m; two spans of ground are kept around the cases.

    Returns:
        What the page needs to read it (`nx, ny, x0, y0, dx, dy, low, step, contour`), and the bytes.
    """
    xmin, xmax, ymin, ymax = terrain.extent
    left, right = max(float(np.min(x)) - 2 * span, xmin), min(float(np.max(x)) + 2 * span, xmax)
    down, up = max(float(np.min(y)) - 2 * span, ymin), min(float(np.max(y)) + 2 * span, ymax)
    spacing = terrain.spacing if np.isfinite(terrain.spacing) else 0.1 * span
    pitch = max(spacing, max(right - left, up - down) / (FINEST - 1))
    nx, ny = (max(int(np.ceil(side / pitch)) + 1, 2) for side in (right - left, up - down))
    X, Y = np.meshgrid(np.linspace(left, right, nx), np.linspace(down, up, ny))
    H = np.asarray(terrain.height(X, Y), dtype=np.float64)
    low, reach = float(H.min()), float(np.ptp(H))
    step = reach / 65535 if reach > 0 else 1.0
    codes = np.rint((H - low) / step).astype(np.uint16)
    rows = codes.copy()
    rows[:, 1:] -= codes[:, :-1]  # wraps, as the page adds them up again in 16 bits
    about = {
        "nx": nx,
        "ny": ny,
        "x0": left,
        "y0": down,
        "dx": (right - left) / (nx - 1),
        "dy": (up - down) / (ny - 1),
        "low": low,
        "step": step,
        "contour": nice_step(reach, 14.0),
    }
    return about, planes(rows.ravel())
