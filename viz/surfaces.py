"""Triangle meshes made from numbers: swept rings, tubes, arrows, balls; one colour a vertex."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rover_pin.numerics import Array

RGB = tuple[float, float, float]


@dataclass(frozen=True)
class Surface:
    """Triangles.

    Attributes:
        vertices: (n, 3) m.
        faces: (m, 3) indices.
        colours: (n, 3) in [0, 1].
    """

    vertices: Array
    faces: NDArray[np.int64]
    colours: Array


def joined(parts: Sequence[Surface]) -> Surface:
    """One mesh of several."""
    starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
    if not parts:
        return Surface(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64), np.zeros((0, 3)))
    return Surface(
        np.vstack([part.vertices for part in parts]),
        np.vstack([part.faces + start for part, start in zip(parts, starts[:-1], strict=True)]),
        np.vstack([part.colours for part in parts]),
    )


def frame_along(axis: Array) -> Array:
    """(3, 3) rotation whose third column is `axis` made unit."""
    third = np.asarray(axis, dtype=np.float64) / np.linalg.norm(axis)
    helper = np.eye(3)[np.argmin(np.abs(third))]
    first = np.cross(helper, third)
    first /= np.linalg.norm(first)
    return np.column_stack([first, np.cross(third, first), third])


def revolved(profile: Array, colours: Array, start: Array, axis: Array, segments: int = 24) -> Surface:
    """A profile (k, 2) of (distance from the axis, way along it) turned about the axis through `start`."""
    angles = np.linspace(0.0, 2 * np.pi, segments + 1)
    rows, columns = len(profile), segments + 1
    radial, along = profile[:, 0][:, None], np.broadcast_to(profile[:, 1][:, None], (rows, columns))
    local = np.stack([radial * np.cos(angles), radial * np.sin(angles), along], axis=-1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(rows - 1), np.arange(segments), indexing="ij")
    a = (i * columns + j).ravel()
    faces = np.concatenate(
        [np.stack([a, a + 1, a + columns], 1), np.stack([a + 1, a + columns + 1, a + columns], 1)]
    )
    return Surface(local @ frame_along(axis).T + start, faces, np.repeat(colours, columns, axis=0))


def tube(start: Array, end: Array, radius: float, colour: RGB, segments: int = 8) -> Surface:
    """A straight round bar."""
    length = float(np.linalg.norm(end - start))
    profile = np.array([[0.0, 0.0], [radius, 0.0], [radius, length], [0.0, length]])
    return revolved(profile, np.tile(colour, (4, 1)), start, end - start, segments)


def arrow(start: Array, end: Array, radius: float, colour: RGB) -> Surface:
    """A bar with a cone at its end; a short one is all cone."""
    length = float(np.linalg.norm(end - start))
    neck = max(length - 6.5 * radius, 0.0)
    head = 2.6 * radius
    profile = np.array([[0, 0], [radius, 0], [radius, neck], [head, neck], [0, length]], dtype=np.float64)
    return revolved(profile, np.tile(colour, (5, 1)), start, end - start, 14)


def ball(center: Array, radius: float, colour: RGB) -> Surface:
    """A sphere."""
    angles = np.linspace(-np.pi / 2, np.pi / 2, 15)
    profile = radius * np.column_stack([np.cos(angles), np.sin(angles)])
    return revolved(profile, np.tile(colour, (15, 1)), np.asarray(center), np.array([0.0, 0.0, 1.0]))


def ring_profile(ring: float, tread: float, steps: int = 10) -> Array:
    """(k, 2) half section of a wheel: a disc of radius `ring` swept by a ball of radius `tread`."""
    angles = np.linspace(-np.pi / 2, np.pi / 2, 2 * steps + 1)
    arc = np.column_stack([ring + tread * np.cos(angles), tread * np.sin(angles)])
    return np.vstack([[0.0, -tread], arc, [0.0, tread]]) if ring > 0 else arc


def rope(points: Array, radius: float, colour: RGB, segments: int = 6) -> Surface:
    """A round bar along a polyline (n, 3) whose points differ from their neighbours."""
    ways = np.gradient(points, axis=0)
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    side = frame_along(ways[0])[:, 0]
    rings = []
    angles = np.linspace(0.0, 2 * np.pi, segments + 1)[:, None]
    for point, way in zip(points, ways, strict=True):
        side = side - (side @ way) * way
        side /= np.linalg.norm(side)
        rings.append(point + radius * (np.cos(angles) * side + np.sin(angles) * np.cross(way, side)))
    return sheet(np.array(rings), np.tile(colour, (len(points), 1)))


def sheet(rows: Array, colours: Array) -> Surface:
    """Rows (n, k, 3) of points joined to a mesh, one colour (n, 3) a row."""
    count, across = rows.shape[:2]
    i, j = np.meshgrid(np.arange(count - 1), np.arange(across - 1), indexing="ij")
    a = (i * across + j).ravel()
    faces = np.concatenate(
        [np.stack([a, a + 1, a + across], 1), np.stack([a + 1, a + across + 1, a + across], 1)]
    )
    return Surface(rows.reshape(-1, 3), faces, np.repeat(colours, across, axis=0))
