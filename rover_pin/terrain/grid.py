"""Grids of heights as the tables that `surface` reads."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import spline_filter

from rover_pin.numerics import Array
from rover_pin.terrain.probe import Extent
from rover_pin.terrain.surface import LINEAR, SMOOTH


def table_of(nodes: Array, interpolation: str) -> tuple[int, Array]:
    """(kind, table) of heights `nodes` (rows, columns) [m], rows along +y.

    `smooth`: the coefficients of the biquadratic spline through every node, mirrored about the border's nodes
    (Unser, Aldroubi and Eden, 1993, recursive prefilter), with one ring of mirrored coefficients around them.
    `linear`: the nodes themselves.
    """
    if interpolation == "linear":
        return LINEAR, nodes
    coefficients = spline_filter(nodes, order=2, mode="mirror")
    return SMOOTH, np.ascontiguousarray(np.pad(coefficients, 1, mode="reflect"), dtype=np.float64)


def grid_extent(shape: tuple[int, ...], spacing: float, origin: tuple[float, float]) -> Extent:
    """(xmin, xmax, ymin, ymax) [m] of a grid of (rows, columns) nodes whose first stands at `origin` [m]."""
    rows, columns = shape
    x, y = origin
    return x, x + (columns - 1) * spacing, y, y + (rows - 1) * spacing


def grid_params(spacing: float, origin: tuple[float, float]) -> Array:
    """Parameters of `surface` for a grid."""
    return np.array([0.0, 1.0, origin[0], origin[1], spacing])
