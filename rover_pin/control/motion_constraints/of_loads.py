"""What motion constraints on loads share: the loads of wheels that stand, and finite differences."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Mapping

import numpy as np

from rover_pin.control.motion_constraints.constraint import MotionConstraint
from rover_pin.control.now import Now
from rover_pin.errors import InputError
from rover_pin.numerics import Array


class OfLoads(MotionConstraint):
    """A statistic of the loads of wheels in contact.

    In contact are the wheels of the sides that are not lifted. One that carries nothing though it is not
    lifted counts with its 0 N: that is what these constraints are there to see.
    """

    unit = "N"
    kind = "load"

    @abstractmethod
    def statistic(self, loads: Array) -> float:
        """Of loads (k,) N, k > 0."""

    def value(self, now: Now) -> Array:
        """(1,) N.

        Raises:
            InputError: loads are not known, miss a standing wheel's or are not finite; or no wheel stands.
        """
        if now.loads is None:
            raise InputError(
                "needs the wheels' loads", element=self.name, cure="give `loads`, or leave it out of this cycle"
            )
        return np.array([self._of(now.loads, now.lifted)])

    def gradient(self, now: Now) -> Array:
        """(1, nv) N per rad or m in the rockers' columns, else 0: central differences of `Options.loads_at`.

        Where two wheels carry the most or the least alike there is a kink, and this the mean of its slopes.

        Raises:
            InputError: nothing was given that settles the rover, or as `value` beside q.
        """
        loads_at, step = self.options.loads_at, self.options.load_step
        if loads_at is None:
            raise InputError(
                "has no gradient without the statics",
                element=self.name,
                cure="give `Options(loads_at=...)`, such as `settled_loads(rover, terrain)`",
            )
        rows = np.zeros((1, len(now.v)))
        for column in self.stations.rockers.tolist():
            above, below = np.array(now.at.q), np.array(now.at.q)
            above[column] += step
            below[column] -= step
            change = self._of(loads_at(above), now.lifted) - self._of(loads_at(below), now.lifted)
            rows[0, column] = change / (2.0 * step)
        return rows

    def _of(self, loads: Mapping[str, float], lifted: tuple[str, ...]) -> float:
        layout = self.stations.layout
        for wheel in lifted:
            layout.side_of(wheel)
        standing = [wheel for wheel in layout.wheels if wheel not in lifted]
        if not standing:
            raise InputError("no wheel stands", element=self.name, value=", ".join(lifted))
        for wheel in standing:
            if wheel not in loads:
                raise InputError("has no load", element=wheel, cure=f"{self.name} needs every standing wheel's")
            if not math.isfinite(loads[wheel]):
                raise InputError("is no finite number", element=f"load of {wheel}", value=loads[wheel])
        return self.statistic(np.array([loads[wheel] for wheel in standing]))
