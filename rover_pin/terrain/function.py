"""Terrains that are Python functions, and the registry that compiled code reaches them through."""

from __future__ import annotations

import itertools
import math
import pickle
import weakref

import numpy as np

from rover_pin.errors import TerrainError
from rover_pin.numerics import Array
from rover_pin.terrain.probe import Extent, Gradient, Height, gradient_of_arrays, height_of_arrays

Six = tuple[float, float, float, float, float, float]

# Step of the difference formulas as a share of the feature size: the truncation of the five-point first
# derivative is then below 1e-12 of the slope for waves four features long, its round-off near 1e-12 too.
STEP = 1e-3

# Centre; x by 1, -1, 2, -2 steps; y likewise; the four corners.
_STENCIL_X = np.array([0, 1, -1, 2, -2, 0, 0, 0, 0, 1, 1, -1, -1], dtype=np.float64)
_STENCIL_Y = np.array([0, 0, 0, 0, 0, 1, -1, 2, -2, 1, -1, 1, -1], dtype=np.float64)
_CROSS = np.array([0, 1, 2, 5, 6])

_handles = itertools.count(1)
_functions: weakref.WeakValueDictionary[int, HeightFunction] = weakref.WeakValueDictionary()


class HeightFunction:
    """A height z = f(x, y) [m] with first and second derivatives, which compiled code knows by `handle`.

    Heights are f's own. Derivatives that the user does not give come from central differences with step e:
    first ones of fourth order, (8 (f1 - f-1) - (f2 - f-2)) / 12 e, second ones likewise, the mixed one from
    four corners; of a given gradient, second order. Near the border of the extent the stencil is moved
    inside and first derivatives are carried back by Taylor's formula. Outside the extent the surface goes on
    at the height of the border, as grids do.

    Attributes:
        handle: integer in the terrain's parameters; valid in this process while this object lives.
        extent: (xmin, xmax, ymin, ymax) [m] where the function may be called.
        spacing: feature size [m].

    Raises:
        TerrainError: the function fails, or gives a wrong shape or values that are not finite.
    """

    def __init__(self, height: Height, gradient: Gradient | None, extent: Extent, spacing: float) -> None:
        self.extent = extent
        self.spacing = spacing
        self._given = (height, gradient)
        self._step = STEP * spacing
        self._around = (self._step * _STENCIL_X, self._step * _STENCIL_Y)
        self._height = height_of_arrays(height, extent, spacing)
        self._gradient = None if gradient is None else gradient_of_arrays(gradient, extent, spacing)
        self.handle = next(_handles)
        _functions[self.handle] = self

    def __reduce__(self) -> tuple[object, ...]:
        """Pickle the user's functions; unpickling registers them anew, in whatever process that is.

        Raises:
            TerrainError: a function cannot be pickled.
        """
        try:
            pickle.dumps(self._given)
        except Exception as error:
            raise TerrainError(
                "the terrain's function cannot be sent to another process",
                value=f"{type(error).__name__}: {error}",
                cure="define it with def at the top of a module that can be imported, or use engine='serial'",
            ) from error
        return (HeightFunction, (*self._given, self.extent, self.spacing))

    def __deepcopy__(self, memo: object) -> HeightFunction:
        """Itself: it does not change."""
        return self

    def heights(self, x: Array, y: Array) -> Array:
        """Heights (n,) [m] at points x, y (n,) [m], clamped to the extent.

        Raises:
            TerrainError: a height is not finite.
        """
        xmin, xmax, ymin, ymax = self.extent
        heights = self._height(np.clip(x, xmin, xmax), np.clip(y, ymin, ymax))
        holes = ~np.isfinite(heights) & np.isfinite(x + y)
        if holes.any():
            i = int(np.argmax(holes))
            raise _hole(heights[i], x[i], y[i])
        return heights

    def derivatives(self, x: float, y: float) -> Six:
        """(h, hx, hy, hxx, hxy, hyy) at one point [m, -, -, 1/m, 1/m, 1/m]."""
        xmin, xmax, ymin, ymax = self.extent
        px, py = min(max(x, xmin), xmax), min(max(y, ymin), ymax)
        margin = 2.0 * self._step
        cx, cy = _inside(px, xmin, xmax, margin), _inside(py, ymin, ymax, margin)
        if self._gradient is None:
            h, hx, hy, hxx, hxy, hyy = self._from_heights(cx, cy)
            if cx != px or cy != py:
                h = float(self._height(np.array([px]), np.array([py]))[0])
        else:
            h = float(self._height(np.array([px]), np.array([py]))[0])
            hx, hy, hxx, hxy, hyy = self._from_gradient(self._gradient, cx, cy)
        dx, dy = px - cx, py - cy
        hx, hy = hx + hxx * dx + hxy * dy, hy + hxy * dx + hyy * dy
        if x != px:
            hx = hxx = hxy = 0.0
        if y != py:
            hy = hyy = hxy = 0.0
        return h, hx, hy, hxx, hxy, hyy

    def _from_heights(self, x: float, y: float) -> Six:
        e = self._step
        f = self._height(x + self._around[0], y + self._around[1]).tolist()
        hx = (8.0 * (f[1] - f[2]) - (f[3] - f[4])) / (12.0 * e)
        hy = (8.0 * (f[5] - f[6]) - (f[7] - f[8])) / (12.0 * e)
        hxx = (16.0 * (f[1] + f[2]) - (f[3] + f[4]) - 30.0 * f[0]) / (12.0 * e * e)
        hyy = (16.0 * (f[5] + f[6]) - (f[7] + f[8]) - 30.0 * f[0]) / (12.0 * e * e)
        hxy = (f[9] - f[10] - f[11] + f[12]) / (4.0 * e * e)
        return f[0], hx, hy, hxx, hxy, hyy

    def _from_gradient(
        self, gradient: Gradient, x: float, y: float
    ) -> tuple[float, float, float, float, float]:
        e = self._step
        dx, dy = self._around
        gx, gy = gradient(x + dx[_CROSS], y + dy[_CROSS])
        hxx = float(gx[1] - gx[2]) / (2.0 * e)
        hyy = float(gy[3] - gy[4]) / (2.0 * e)
        hxy = float(gx[3] - gx[4] + gy[1] - gy[2]) / (4.0 * e)
        return float(gx[0]), float(gy[0]), hxx, hxy, hyy


def evaluate(handle: int, x: float, y: float) -> Six:
    """The function of that handle at one point; called from compiled code.

    Raises:
        TerrainError: the terrain that owned the handle is gone, or its function gives no finite height there.
    """
    function = _functions.get(handle)
    if function is None:
        raise TerrainError(
            "the terrain's function is gone", cure="keep the Terrain while its table is in use"
        )
    values = function.derivatives(x, y)
    if not math.isfinite(sum(values)) and math.isfinite(x + y):
        raise _hole(values[0], x, y)
    return values


def _hole(height: float, x: float, y: float) -> TerrainError:
    return TerrainError(
        "the terrain's function gives a height or slope that is not finite",
        value=f"{height} at x = {x}, y = {y}",
        cure="state the `extent` where it is defined",
    )


def _inside(value: float, low: float, high: float, margin: float) -> float:
    """`value` moved to at least `margin` from both ends, or to the middle where there is no such place."""
    if high - low <= 2.0 * margin:
        return 0.5 * (low + high)
    return min(max(value, low + margin), high - margin)
