"""Shapes as arrays for `find_all`, and how far a shape reaches sideways."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rover_pin.contact.place import SEGMENT
from rover_pin.numerics import Array, frozen


class Shape(Protocol):
    """What every contact shape offers (form 0: ring, 1: segment with its half length in `ring`)."""

    @property
    def name(self) -> str: ...  # noqa: D102
    @property
    def joint(self) -> int: ...  # noqa: D102
    @property
    def center(self) -> Array: ...  # noqa: D102
    @property
    def axis(self) -> Array: ...  # noqa: D102
    @property
    def ring(self) -> float: ...  # noqa: D102
    @property
    def tread(self) -> float: ...  # noqa: D102
    @property
    def friction(self) -> float: ...  # noqa: D102
    @property
    def form(self) -> int: ...  # noqa: D102


class Packed(NamedTuple):
    """Shapes side by side, read-only; centres and axes in their joints' frames.

    Attributes:
        forms: (m,) int.
        joints: (m,) int.
        centers: (m, 3) m.
        axes: (m, 3) unit.
        rings: (m,) m.
        treads: (m,) m.
    """

    forms: NDArray[np.int64]
    joints: NDArray[np.int64]
    centers: Array
    axes: Array
    rings: Array
    treads: Array


def pack(shapes: Sequence[Shape]) -> Packed:
    """The shapes' numbers as arrays."""
    return Packed(
        _integers([s.form for s in shapes]),
        _integers([s.joint for s in shapes]),
        frozen(np.reshape([s.center for s in shapes], (-1, 3))),
        frozen(np.reshape([s.axis for s in shapes], (-1, 3))),
        frozen([s.ring for s in shapes]),
        frozen([s.tread for s in shapes]),
    )


def half_extents(forms: ArrayLike, axes: ArrayLike, rings: ArrayLike, treads: ArrayLike) -> Array:
    """Half of the shapes' extents along world x and y [m], every point of the shape counted.

    A ring of radius R about unit axis a reaches R sqrt(1 - a_x^2) along x, a segment of half length R reaches
    R |a_x|; the ball adds its radius c.

    Args:
        forms: (m,).
        axes: (m, 3) unit, world.
        rings: (m,) m.
        treads: (m,) m.

    Returns:
        (m, 2).
    """
    across = np.asarray(axes, dtype=np.float64)[..., :2]
    form = np.asarray(forms)[..., None]
    reach = np.where(form == SEGMENT, np.abs(across), np.sqrt(np.clip(1.0 - across**2, 0.0, 1.0)))
    ring = np.asarray(rings, dtype=np.float64)[..., None]
    tread = np.asarray(treads, dtype=np.float64)[..., None]
    extents: Array = ring * reach + tread
    return extents


def _integers(values: list[int]) -> NDArray[np.int64]:
    array = np.array(values, dtype=np.int64)
    array.setflags(write=False)
    return array
