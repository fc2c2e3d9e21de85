"""Ground for one wheel: level, but for what is put under it."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.analysis.papers.polibot.reading import wheel_centers
from rover_pin.statics.settle import settle
from rover_pin.terrain import Terrain

if TYPE_CHECKING:
    from rover_pin.numerics import Array
    from rover_pin.rover import Rover
    from rover_pin.statics.stance import Stance

SPACING = 0.005
REACH = 1.2
HALF, RAMP = 0.045, 0.03
"""m: a wheel that is lifted moves along by up to 35 mm and has to stay on top; its neighbours are 190 mm
off."""


def obstacle(x: float, height: float) -> Terrain:
    """A flat-topped obstacle of that height about x [m]."""
    return _profile(lambda at: height * np.clip((HALF + RAMP - np.abs(at - x)) / RAMP, 0.0, 1.0))


def ledge(x: float, height: float, ramp: float = RAMP) -> Terrain:
    """Level ground at 0 before x - ramp and at `height` from x on [m]."""
    return _profile(lambda at: height * np.clip(1.0 + (at - x) / ramp, 0.0, 1.0))


def _profile(height: Callable[[Array], Array]) -> Terrain:
    x = np.arange(-REACH, REACH + SPACING / 2, SPACING)
    rows = round(REACH / SPACING)  # wide enough for the rover's length, which a map has to be
    return Terrain.from_grid(np.tile(height(x), (rows, 1)), SPACING, (x[0], -REACH / 2), "linear")


def on_obstacle(rover: Rover, wheel: str, height: float, baseline: Stance) -> Stance:
    """The stance with an obstacle of `height` [m] under one wheel.

    Args:
        rover: stands with its root's origin where `baseline` does.
        wheel: that is lifted.
        height: of the obstacle.
        baseline: the stance on level ground.
    """
    place = wheel_centers(baseline)[wheel][0]
    return settle(rover, obstacle(float(place), height))
