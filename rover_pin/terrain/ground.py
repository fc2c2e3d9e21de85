"""The ground as everyone asks for it: height, gradient and normal of one surface."""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rover_pin.errors import TerrainError
from rover_pin.numerics import Array, frozen
from rover_pin.terrain import query
from rover_pin.terrain.function import HeightFunction
from rover_pin.terrain.probe import Extent, probe_points
from rover_pin.terrain.summary import Summary, summarize
from rover_pin.terrain.surface import LINEAR, SMOOTH

Self = TypeVar("Self", bound="Ground")


@dataclass(frozen=True, eq=False)
class Ground:
    """One surface z = h(x, y), metres, z up, and what can be asked of it.

    Outside the extent the surface goes on at the height of its border, so that every query has an answer;
    whether a place may be used is asked of `covers`. Compiled loops read `kind`, `table` and `params`
    through `rover_pin.terrain.surface`.

    Attributes:
        kind: PLANE, SMOOTH, LINEAR or CALLABLE.
        table: two-dimensional float64, read-only; what it holds depends on the kind.
        params: (n,) float64, read-only; params[0] + params[1] * raw is the height.
        extent: (xmin, xmax, ymin, ymax) [m]; infinite where unbounded.
        spacing: from node to node [m]; of a function its feature size; infinite for a plane.
        interpolation: `smooth`, `linear` or `exact`.
        label: how the user named it.
        function: the Python function of a CALLABLE.
    """

    kind: int
    table: Array
    params: Array
    extent: Extent
    spacing: float
    interpolation: str
    label: str
    function: HeightFunction | None = None

    def __post_init__(self) -> None:
        """Make the arrays read-only; write the function's handle of this process."""
        params = np.array(self.params, dtype=np.float64)
        if self.function is not None:
            params[2] = self.function.handle
        object.__setattr__(self, "params", frozen(params))
        if self.table.flags.writeable or not self.table.flags.c_contiguous:
            object.__setattr__(self, "table", frozen(np.ascontiguousarray(self.table)))

    def __reduce__(self) -> tuple[object, ...]:
        """Pickle by fields: arrays come back read-only, functions registered."""
        fields = (self.kind, self.table, self.params, self.extent, self.spacing)
        return (type(self), (*fields, self.interpolation, self.label, self.function))

    def __repr__(self) -> str:
        where = ", ".join(f"{end:g}" for end in self.extent)
        name = type(self).__name__
        return f"{name}({self.label!r}, {self.interpolation}, [{where}], spacing {self.spacing:g})"

    def height(self, x: ArrayLike, y: ArrayLike) -> Array:
        """Heights [m] at points x, y [m], broadcast together."""
        px, py, shape = _points(x, y)
        if self.function is not None:
            flat = self.params[0] + self.params[1] * self.function.heights(px, py)
        else:
            flat = query.heights(self.kind, self.table, self.params, px, py)
        result: Array = flat.reshape(shape)[()]
        return result

    def gradient(self, x: ArrayLike, y: ArrayLike) -> Array:
        """Slopes (..., 2) [-] along x and y at points x, y [m], broadcast together."""
        px, py, shape = _points(x, y)
        return query.gradients(self.kind, self.table, self.params, px, py).reshape(*shape, 2)

    def normal(self, x: ArrayLike, y: ArrayLike) -> Array:
        """Unit normals (..., 3), out of the ground, at points x, y [m], broadcast together."""
        slope = self.gradient(x, y)
        upward = np.concatenate([-slope, np.ones((*slope.shape[:-1], 1))], axis=-1)
        return np.asarray(upward / np.linalg.norm(upward, axis=-1, keepdims=True), dtype=np.float64)

    def covers(self, x: ArrayLike, y: ArrayLike) -> NDArray[np.bool_]:
        """Whether points x, y [m] lie on the map, border included; broadcast together."""
        px, py = np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64)
        xmin, xmax, ymin, ymax = self.extent
        inside: NDArray[np.bool_] = (px >= xmin) & (px <= xmax) & (py >= ymin) & (py <= ymax)
        return inside

    def blended(self: Self, h0: float, s: float) -> Self:
        """h0 + s (h - h0): level at h0 [m] for s = 0, this terrain for s = 1; the table is shared."""
        if s == 1.0:
            return self
        params = np.array(self.params)
        params[0] = h0 + s * (params[0] - h0)
        params[1] = s * params[1]
        return replace(self, params=params)

    @property
    def bounded(self) -> bool:
        """Whether the extent is finite on every side."""
        return all(math.isfinite(end) for end in self.extent)

    @property
    def nodes(self) -> tuple[Array, Array] | None:
        """(x, y) coordinates [m] of a grid's columns and rows; None for what is no grid."""
        if self.kind not in (SMOOTH, LINEAR):
            return None
        ring = 2 if self.kind == SMOOTH else 0
        rows, columns = self.table.shape[0] - ring, self.table.shape[1] - ring
        x0, y0, spacing = self.params[2:5]
        return frozen(x0 + spacing * np.arange(columns)), frozen(y0 + spacing * np.arange(rows))

    @cached_property
    def digest(self) -> str:
        """Hexadecimal SHA-256 of the surface: its table and numbers, or samples of its function."""
        content = hashlib.sha256(f"{self.kind} {self.interpolation} {self.extent} {self.spacing!r}".encode())
        if self.function is None:
            content.update(
                np.array(self.table.shape).tobytes() + self.table.tobytes() + self.params.tobytes()
            )
        else:
            x, y = (np.linspace(p.min(), p.max(), 64) for p in probe_points(self.extent, self.spacing))
            content.update(self.height(x[None, :], y[:, None]).tobytes())
        return content.hexdigest()

    def summary(self) -> Summary:
        """Size, heights and slopes in figures; of an unbounded terrain those of a square about the origin."""
        return summarize(self.height, self.gradient, self.extent, self.spacing, self.label)

    def require_room(self, span: float, who: str) -> None:
        """Refuse a map narrower than `span` [m], the largest distance between points of `who` on the ground.

        Raises:
            TerrainError: the map is too small.
        """
        xmin, xmax, ymin, ymax = self.extent
        if min(xmax - xmin, ymax - ymin) < span:
            raise TerrainError(
                f"the map of {xmax - xmin:g} x {ymax - ymin:g} m is too small for {who}",
                element=self.label,
                cure=f"it must be over {span:g} m wide; is the spacing of {self.spacing:g} m right?",
            )


def _points(x: ArrayLike, y: ArrayLike) -> tuple[Array, Array, tuple[int, ...]]:
    """The points as two flat arrays (n,), and the shape they were broadcast to."""
    px, py = np.broadcast_arrays(np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64))
    return np.array(px.ravel()), np.array(py.ravel()), px.shape
