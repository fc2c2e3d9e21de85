"""Independent draws over what varies; what is fixed takes no number."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rover_pin.analysis.quantities import Quantity
from rover_pin.analysis.sobol import spread_all
from rover_pin.numerics import Array


class Independent:
    """Draws of PCG64, which is put at any case in no time: one number a quantity and case."""

    def __init__(self, columns: Mapping[str, Quantity], seed: int) -> None:
        self._asked = dict(columns)
        self._varying = [name for name, asked in columns.items() if asked.varies]
        self._seed = seed

    def columns(self, start: int, stop: int) -> dict[str, Array]:
        """Every quantity of the draws from `start` to before `stop`."""
        source = np.random.PCG64([self._seed])
        source.advance(start * len(self._varying))
        points = np.random.Generator(source).random((stop - start, len(self._varying)))
        return spread_all(self._asked, points)
