"""Level ground with boxes on it: walls, piles, bricks and stairs of the tasks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rover_pin.terrain import Terrain

SPACING = 0.02
"""m: a face rises within this."""


@dataclass(frozen=True)
class Box:
    """An obstacle with a flat top.

    Attributes:
        x: m, from and to.
        y: m, from and to.
        height: m.
    """

    x: tuple[float, float]
    y: tuple[float, float]
    height: float


def ground(boxes: tuple[Box, ...], x: tuple[float, float], y: tuple[float, float], label: str) -> Terrain:
    """Boxes on level ground.

    Args:
        boxes: obstacles.
        x: m, extent of the map.
        y: m, likewise.
        label: what the map is called.
    """
    across = np.arange(x[0], x[1] + SPACING / 2, SPACING)
    along = np.arange(y[0], y[1] + SPACING / 2, SPACING)
    heights = np.zeros((len(along), len(across)))
    for box in boxes:
        inside = _between(along, box.y)[:, None] & _between(across, box.x)[None, :]
        heights[inside] = np.maximum(heights[inside], box.height)
    return Terrain.from_grid(heights, SPACING, (x[0], y[0]), "linear", label=label)


def _between(values: np.ndarray, span: tuple[float, float]) -> np.ndarray:
    found: np.ndarray = (values >= span[0] - 1e-9) & (values <= span[1] + 1e-9)
    return found
