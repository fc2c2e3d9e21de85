"""What the methods are asked: a robot, a surface, and places on it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.analysis.plan import wheel_reach
from rover_pin.compiled import COMPILED_MEASURES
from rover_pin.numerics import Array
from rover_pin.stability.report import inapplicable
from rover_pin.terrain import Terrain

if TYPE_CHECKING:
    from rover_pin.rover import Rover

MODERATE, ROUGH = "moderate", "rough"
SEED = 1
SIZE_M, SPACING_M = 20.0, 0.05
ROUGH_HURST = 0.5


@dataclass(frozen=True)
class Places:
    """Where and in which heading: x, y (n,) m, yaw (n,) rad."""

    x: Array
    y: Array
    yaw: Array

    def __len__(self) -> int:
        """How many."""
        return len(self.x)

    def first(self, count: int) -> Places:
        """The first so many."""
        return Places(self.x[:count], self.y[:count], self.yaw[:count])


@dataclass(frozen=True)
class Scene:
    """A robot on a surface.

    Attributes:
        rover: the robot.
        terrain: the surface.
        kind: `moderate` or `rough`.
        measures: the cheap measures that the robot can have.
    """

    rover: Rover
    terrain: Terrain
    kind: str

    @property
    def measures(self) -> tuple[str, ...]:
        """The cheap measures that the robot can have."""
        missing = inapplicable(self.rover, COMPILED_MEASURES)
        return tuple(name for name in COMPILED_MEASURES if name not in missing)

    def places(self, count: int) -> Places:
        """Random places, the same every time, whose wheels are over the map where they stand level."""
        random = np.random.default_rng(SEED)
        room = wheel_reach(self.rover)
        xmin, xmax, ymin, ymax = self.terrain.extent
        points = random.uniform(size=(count, 3))  # row by row: fewer places are the first of more
        return Places(
            xmin + room + points[:, 0] * (xmax - xmin - 2.0 * room),
            ymin + room + points[:, 1] * (ymax - ymin - 2.0 * room),
            2.0 * np.pi * points[:, 2],
        )


def moderate(rover: Rover, *, size: float = SIZE_M) -> Scene:
    """Ground of rms 0.05 m that a rover's wheel rolls over."""
    return Scene(rover, Terrain.rough(SEED, 0.05, 0.8, size=size, spacing=SPACING_M), MODERATE)


def rough(rover: Rover) -> Scene:
    """Ground of an rms of half the smallest wheel's radius, and jagged."""
    radius = min(shape.ring + shape.tread for shape in rover.shapes)
    terrain = Terrain.rough(SEED, 0.5 * radius, ROUGH_HURST, size=SIZE_M, spacing=SPACING_M)
    return Scene(rover, terrain, ROUGH)
