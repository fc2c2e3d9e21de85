"""Terrain: every way to make the ground."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from rover_pin.errors import TerrainError
from rover_pin.numerics import frozen
from rover_pin.terrain import checks
from rover_pin.terrain.function import HeightFunction
from rover_pin.terrain.grid import grid_extent, grid_params, table_of
from rover_pin.terrain.ground import Ground
from rover_pin.terrain.probe import UNBOUNDED, Gradient, Height
from rover_pin.terrain.readers import read_heights
from rover_pin.terrain.rough import rough_heights
from rover_pin.terrain.surface import CALLABLE, LINEAR, PLANE
from rover_pin.terrain.words import split_word

_UNUSED = frozen([[0.0]])
_MOST_NODES = 20_000


class Terrain(Ground):
    """The ground: `flat`, `slope`, `step`, `rough`, `from_function`, `from_grid`, `from_file` or `parse`."""

    @classmethod
    def flat(cls, height: float = 0.0) -> Terrain:
        """Level ground at `height` [m]."""
        level = checks.finite("the height", height)
        label = "flat" if level == 0.0 else f"flat at {_short(level)} m"
        return cls._plane((level, 0.0, 0.0), label)

    @classmethod
    def slope(cls, deg: float, heading_deg: float = 0.0) -> Terrain:
        """A plane through the origin, rising by `deg` along the heading (from +x, positive to the left).

        Raises:
            TerrainError: not between -90 and 90 deg.
        """
        angle, heading = (
            checks.finite("the slope", deg),
            math.radians(checks.finite("the heading", heading_deg)),
        )
        if abs(angle) >= 90.0:
            raise TerrainError("a slope must be between -90 and 90 deg", value=deg)
        rise = math.tan(math.radians(angle))
        label = f"slope:{_short(angle)}" + ("" if heading == 0.0 else f" towards {_short(heading_deg)} deg")
        return cls._plane((0.0, rise * math.cos(heading), rise * math.sin(heading)), label)

    @classmethod
    def _plane(cls, plane: tuple[float, float, float], label: str) -> Terrain:
        return cls(PLANE, _UNUSED, np.array([0.0, 1.0, *plane]), UNBOUNDED, math.inf, "exact", label)

    @classmethod
    def step(cls, height: float, x: float = 0.0, spacing: float = 0.05) -> Terrain:
        """Level ground at 0 that rises to `height` [m] at `x` [m] by a straight ramp over [x - spacing, x].

        Raises:
            TerrainError: a number that is not finite, or a spacing that is not positive.
        """
        rise, edge = checks.finite("the height", height), checks.finite("the step's x", x)
        run = checks.positive("the spacing", spacing)
        table = np.array([[0.0, rise], [0.0, rise]])
        params = grid_params(run, (edge - run, 0.0))
        return cls(LINEAR, table, params, UNBOUNDED, run, "linear", f"step:{_short(rise)},{_short(edge)}")

    @classmethod
    def rough(
        cls,
        seed: int,
        rms: float,
        hurst: float,
        size: float = 20.0,
        spacing: float = 0.05,
        shortest: float | None = None,
        interpolation: str = "smooth",
    ) -> Terrain:
        """A random self-affine square about the origin (`rough_heights`): mean 0, rms exact over its nodes.

        Args:
            seed: whole number, 0 or more.
            rms: root mean square of the heights [m].
            hurst: Hurst exponent, 0 (jagged) to 1 (rolling).
            size: side [m]; rounded to whole spacings.
            spacing: from node to node [m].
            shortest: shortest wave [m]; four spacings unless given, at least two.
            interpolation: `smooth` or `linear`.

        Raises:
            TerrainError: a number out of its range.
        """
        pitch, side = checks.positive("the spacing", spacing), checks.positive("the size", size)
        if not isinstance(seed, (int, np.integer)) or isinstance(seed, bool) or seed < 0:
            raise TerrainError("the seed must be a whole number, 0 or more", value=seed)
        if checks.finite("the rms", rms) < 0.0:
            raise TerrainError("the rms must not be negative", value=rms)
        if not 0.0 <= checks.finite("the Hurst exponent", hurst) <= 1.0:
            raise TerrainError("the Hurst exponent must be between 0 and 1", value=hurst)
        wave = 4.0 * pitch if shortest is None else checks.positive("the shortest wave", shortest)
        count = round(side / pitch) + 1
        if count > _MOST_NODES:
            raise TerrainError(
                "the map would be too large", value=f"{count} x {count} nodes", cure="widen the spacing"
            )
        if wave < 2.0 * pitch or wave > 0.5 * side:
            cure = f"between two spacings ({2 * pitch:g} m) and half the size ({0.5 * side:g} m)"
            raise TerrainError("the shortest wave does not fit the map", value=wave, cure=cure)
        heights = rough_heights(int(seed), rms, hurst, count, pitch, wave)
        corner = -0.5 * (count - 1) * pitch
        label = f"rough:{int(seed)},{_short(rms)},{_short(hurst)}"
        return cls.from_grid(heights, pitch, (corner, corner), interpolation, label=label)

    @classmethod
    def from_function(
        cls,
        f: Height,
        gradient: Gradient | None = None,
        extent: Sequence[float] | None = None,
        spacing: float = 0.05,
    ) -> Terrain:
        """The surface z = f(x, y) itself, not samples of it.

        Args:
            f: height [m] of two floats or two arrays [m].
            gradient: (dz/dx, dz/dy) of the same; by differences of f where None.
            extent: (xmin, xmax, ymin, ymax) [m] where f is defined; everywhere where None.
            spacing: size of the smallest feature [m]: how finely contacts are looked for.

        Raises:
            TerrainError: f or the gradient fails when tried, or gives a wrong shape or no finite value.
        """
        where = checks.extent_of(extent)
        feature = checks.positive("the spacing", spacing)
        function = HeightFunction(f, gradient, where, feature)
        name = getattr(f, "__qualname__", type(f).__name__).rpartition(".")[2]
        params = np.array([0.0, 1.0, float(function.handle)])
        return cls(CALLABLE, _UNUSED, params, where, feature, "exact", f"function {name}", function)

    @classmethod
    def from_grid(
        cls,
        Z: ArrayLike,
        spacing: float | None,
        origin: Sequence[float] = (0.0, 0.0),
        interpolation: str = "smooth",
        *,
        label: str = "grid",
        file: Path | None = None,
    ) -> Terrain:
        """The surface through heights Z[i, j] [m] at x = origin_x + j spacing, y = origin_y + i spacing.

        Args:
            Z: (rows, columns), at least 3 x 3 for `smooth`, 2 x 2 for `linear`.
            spacing: from node to node [m], along x and y alike.
            origin: (x, y) [m] of Z[0, 0].
            interpolation: `smooth` (biquadratic spline through every node) or `linear` (bilinear).
            label: how to call it.
            file: where it comes from, for messages.

        Raises:
            TerrainError: heights that are not finite numbers in two dimensions, too few, or no spacing.
        """
        nodes = checks.heights(Z, interpolation, file)
        pitch, corner = checks.grid_spacing(spacing, file), checks.pair("the origin", origin, file)
        kind, table = table_of(nodes, interpolation)
        where = grid_extent(nodes.shape, pitch, corner)
        return cls(kind, frozen(table), grid_params(pitch, corner), where, pitch, interpolation, label)

    @classmethod
    def from_file(
        cls,
        path: str | Path,
        spacing: float | None = None,
        origin: Sequence[float] | None = None,
        interpolation: str = "smooth",
        height_scale: float | None = None,
        height_offset: float = 0.0,
    ) -> Terrain:
        """A height map from a file: TIFF or GeoTIFF, .npy, .npz, .csv, .png, .asc; rows along +y.

        The order is the file's, save that of an .asc, whose last row lies south and so comes first.

        Args:
            path: the file.
            spacing: from node to node [m]; where None, what the file says.
            origin: (x, y) [m] of the first height; where None, what the file says, else (0, 0).
            interpolation: `smooth` or `linear`.
            height_scale: metres a unit of what the file holds; needed for a PNG, where it is metres a grey
                level as stored, else 1.
            height_offset: height [m] where the file holds 0.

        Raises:
            TerrainError: no such file, one that cannot be read, or heights that `from_grid` refuses.
        """
        file = Path(path)
        found = read_heights(file, spacing is not None)
        scale, offset = checks.height_unit(found.levels_of, height_scale, height_offset, file)
        nodes = found.heights
        if (scale, offset) != (1.0, 0.0):
            nodes = offset + scale * checks.heights(nodes, interpolation, file)
        corner = origin if origin is not None else found.origin if found.origin is not None else (0.0, 0.0)
        pitch = found.spacing if spacing is None else spacing
        return cls.from_grid(nodes, pitch, corner, interpolation, label=file.name, file=file)

    @classmethod
    def parse(
        cls,
        text: str,
        spacing: float | None = None,
        interpolation: str = "smooth",
        height_scale: float | None = None,
        height_offset: float = 0.0,
    ) -> Terrain:
        """The command line's terrain: `flat`, `slope:DEG`, `step:HEIGHT,X`, `rough:SEED,RMS,HURST`, a file.

        Raises:
            TerrainError: none of these, or numbers that the terrain refuses.
        """
        found = split_word(text)
        if found is None:
            return cls.from_file(text, spacing, None, interpolation, height_scale, height_offset)
        if height_scale is not None or height_offset != 0.0:
            raise TerrainError("only a file has a height scale", value=text, cure="leave it out")
        word, numbers = found
        pitch: dict[str, Any] = {} if spacing is None else {"spacing": spacing}
        if word == "flat":
            return cls.flat()
        if word == "slope":
            return cls.slope(numbers[0])
        if word == "step":
            return cls.step(numbers[0], numbers[1], **pitch)
        return cls.rough(int(numbers[0]), numbers[1], numbers[2], interpolation=interpolation, **pitch)


def _short(value: float) -> str:
    """A number as people write it, with every digit that it has."""
    return repr(float(value)).removesuffix(".0")
