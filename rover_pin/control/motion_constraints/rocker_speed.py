"""No rocker so fast that it takes all of its side's speed."""

from __future__ import annotations

import numpy as np

from rover_pin.control.motion_constraints.of_rates import OfRates
from rover_pin.control.now import Now
from rover_pin.control.reshaping import Reshaping
from rover_pin.numerics import Array


class RockerSpeed(OfRates):
    """w / w_max of each side's rocker, where |d(d_fm)/dt| at w_max is the side's speed (motion constraint 6).

    w is the rocker's rate, d(d_fm)/dt = w d(d_fm)/dw with the wheels kept on the ground (`Reshaping`), and
    the side's speed the mean commanded one of its wheels' centres along the heading, at least the floor. At 1
    the distance of front and second wheel changes as fast as the side drives, and one of them stands still.
    """

    name = "rocker_speed"
    number = 6
    unit = "1"
    by_side = True

    def rows(self, now: Now) -> Array:
        """(2, nv) s/rad, in the rocker's column 1 / w_max."""
        speeds = self.stations.at(now.at).center_rows @ now.nominal
        speed = np.abs(speeds.sum(axis=1)) / speeds.shape[1]
        rows = np.zeros((2, len(now.v)))
        rates = np.abs(self._reshaping.rates(now))
        rows[[0, 1], self.stations.rockers] = rates / np.maximum(speed, self.options.speed_floor)
        return rows

    @property
    def _reshaping(self) -> Reshaping:
        return self.stations.reshaping


CONSTRAINT = RockerSpeed
