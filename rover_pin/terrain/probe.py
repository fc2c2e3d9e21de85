"""The user's height and gradient functions, tried once and made to take arrays."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rover_pin.errors import TerrainError
from rover_pin.numerics import Array

Extent = tuple[float, float, float, float]
Height = Callable[[Any, Any], Any]
Gradient = Callable[[Any, Any], Any]
OfArrays = Callable[[Array, Array], Array]

UNBOUNDED: Extent = (-np.inf, np.inf, -np.inf, np.inf)

_HEIGHT_CURE = "it takes x and y [m], two floats or two arrays of one shape, and returns the height z [m]"
_GRADIENT_CURE = "it takes x and y [m] and returns the pair (dz/dx, dz/dy)"


def height_of_arrays(height: Height, extent: Extent, spacing: float) -> OfArrays:
    """`height` as a function of two arrays (n,) giving (n,); floats-only functions are called point by point.

    Raises:
        TerrainError: it works neither on arrays nor on floats, or its shape or values are wrong.
    """
    if not callable(height):
        raise TerrainError(
            "the terrain's function cannot be called", value=type(height).__name__, cure=_HEIGHT_CURE
        )

    def whole(x: Array, y: Array) -> Array:
        return np.asarray(height(x, y), dtype=np.float64)

    def pointwise(x: Array, y: Array) -> Array:
        return np.array(
            [_number(height(a, b)) for a, b in zip(x.tolist(), y.tolist(), strict=True)], dtype=np.float64
        )

    return _choose(whole, pointwise, "the terrain's function", _HEIGHT_CURE, (), extent, spacing)


def gradient_of_arrays(gradient: Gradient, extent: Extent, spacing: float) -> OfArrays:
    """`gradient` as a function of two arrays (n,) giving (2, n).

    Raises:
        TerrainError: as for `height_of_arrays`.
    """
    if not callable(gradient):
        raise TerrainError(
            "the terrain's gradient cannot be called", value=type(gradient).__name__, cure=_GRADIENT_CURE
        )

    def whole(x: Array, y: Array) -> Array:
        gx, gy = gradient(x, y)
        return np.stack([np.asarray(g, dtype=np.float64) for g in (gx, gy)])

    def pointwise(x: Array, y: Array) -> Array:
        out = np.empty((2, x.size))
        for i, (a, b) in enumerate(zip(x.tolist(), y.tolist(), strict=True)):
            gx, gy = gradient(a, b)
            out[:, i] = _number(gx), _number(gy)
        return out

    return _choose(whole, pointwise, "the terrain's gradient", _GRADIENT_CURE, (2,), extent, spacing)


def _number(value: Any) -> float:
    """A float of a number or of an array of one element in no dimension."""
    if np.ndim(value) != 0:
        raise ValueError(f"an array of shape {np.shape(value)} for one point")
    return float(value)


def _choose(
    whole: OfArrays,
    pointwise: OfArrays,
    name: str,
    cure: str,
    lead: tuple[int, ...],
    extent: Extent,
    spacing: float,
) -> OfArrays:
    """`whole` where it agrees with `pointwise`, else the one of them that works."""
    x, y = probe_points(extent, spacing)
    shape = (*lead, x.size)
    answers: list[NDArray[np.float64] | None] = []
    complaint: object = None
    for way in (whole, pointwise):
        try:
            with np.errstate(all="ignore"):
                answer = way(x, y)
        except Exception as error:  # whatever the user's code raises
            answers.append(None)
            complaint = f"{type(error).__name__}: {error}"
            continue
        if answer.shape != shape:
            complaint = f"shape {answer.shape} for {x.size} points"
        answers.append(answer if answer.shape == shape else None)
    of_arrays, of_floats = answers
    best = of_arrays if of_arrays is not None else of_floats
    if best is None:
        raise TerrainError(f"{name} fails", value=complaint, cure=cure)
    if not np.isfinite(best).all():
        i = int(np.argwhere(~np.isfinite(best))[0][-1])
        raise TerrainError(
            f"{name} gives values that are not finite",
            value=f"{best[..., i]} at x = {x[i]:g}, y = {y[i]:g}",
            cure="state the `extent` where it is defined",
        )
    if of_arrays is not None and of_floats is not None and not np.allclose(of_arrays, of_floats, 1e-6, 1e-9):
        i = int(np.argmax(np.abs(of_arrays - of_floats).reshape(-1, x.size).max(axis=0)))
        raise TerrainError(
            f"{name} gives one value for an array and another for its elements",
            value=f"{of_arrays[..., i]} and {of_floats[..., i]} at x = {x[i]:g}, y = {y[i]:g}",
            cure="each point's value must depend on that point alone",
        )
    return whole if of_arrays is not None else pointwise


def probe_points(extent: Extent, spacing: float) -> tuple[Array, Array]:
    """A few points of the extent: its corners and places inside, or near the origin where unbounded."""
    reach = 20.0 * spacing
    ends = []
    for low, high in (extent[:2], extent[2:]):
        if not np.isfinite(low):
            low = -reach if not np.isfinite(high) else high - 2.0 * reach
        if not np.isfinite(high):
            high = low + 2.0 * reach
        ends.append((low, high))
    u = np.array([0.0, 0.0, 1.0, 1.0, 0.5, 0.31, 0.77])
    v = np.array([0.0, 1.0, 0.0, 1.0, 0.5, 0.68, 0.13])
    (x0, x1), (y0, y1) = ends
    return x0 + u * (x1 - x0), y0 + v * (y1 - y0)
