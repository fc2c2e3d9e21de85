"""Heights and slopes of many points in compiled loops over `surface`."""

from __future__ import annotations

import numpy as np

from rover_pin.numerics import Array, formula
from rover_pin.terrain.surface import surface


@formula
def heights(kind: int, table: Array, params: Array, x: Array, y: Array) -> Array:
    """Heights (n,) [m] at points x, y (n,) [m]."""
    out = np.empty(x.size)
    for i in range(x.size):
        out[i] = surface(kind, table, params, x[i], y[i])[0]
    return out


@formula
def gradients(kind: int, table: Array, params: Array, x: Array, y: Array) -> Array:
    """Slopes (n, 2) [-] along x and y at points x, y (n,) [m]."""
    out = np.empty((x.size, 2))
    for i in range(x.size):
        values = surface(kind, table, params, x[i], y[i])
        out[i, 0] = values[1]
        out[i, 1] = values[2]
    return out
