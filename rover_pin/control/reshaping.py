"""How much the distance between front and second wheel changes for a rocker's turning, wheels on the ground."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rover_pin.kinematics.instant import Instant, Integers
from rover_pin.numerics import Array

if TYPE_CHECKING:
    from rover_pin.control.now import Now
    from rover_pin.control.stations import Stations

KEPT = 1e-6
"""Share of what a rocker's turning does to a row that may be left over before the rocker counts as stuck."""


class Reshaping:
    """d(d_fm)/dw of each side, from Jacobians.

    One rocker turns, every other driven or locked joint and the base's place and heading are held; what is
    left of the rates (height, pitch, roll, passive joints) keeps the gaps of the wheels that stand, the
    couplings and the loops: least squares of A_free x = -A_rocker, the least x where they leave a freedom.
    """

    def __init__(self, stations: Stations) -> None:
        self.stations = stations
        self._columns: dict[tuple[str, ...], Integers] = {}
        self._latest: tuple[Instant, tuple[str, ...], tuple[str, ...], Array] | None = None

    def rates(self, now: Now) -> Array:
        """(2,) m per rad (or m) of the rocker, left and right; 0 of a rocker that the wheels do not let turn.

        Raises:
            InputError: a lifted wheel that the rover does not have.
        """
        kept = self._latest
        if kept is None or kept[0] is not now.at or kept[1:3] != (now.lifted, now.locked):
            kept = self._latest = (now.at, now.lifted, now.locked, self._work_out(now))
        return kept[3]

    def _work_out(self, now: Now) -> Array:
        if now.locked not in self._columns:
            self._columns[now.locked] = self._free(now)
        rows, free = self._rows(now), self._columns[now.locked]
        rockers = self.stations.rockers
        turning = rows[:, rockers]
        found = np.linalg.lstsq(rows[:, free], -turning, rcond=1e-9)[0]
        apart = self.stations.at(now.at).apart_rows
        rates: Array = (apart[:, free] @ found).diagonal() + apart[[0, 1], rockers]
        missed = np.abs(rows[:, free] @ found + turning).max(axis=0)
        return np.where(missed > KEPT * np.abs(turning).max(axis=0), 0.0, rates)

    def _rows(self, now: Now) -> Array:
        """Of gaps of standing wheels, couplings, loops."""
        at = now.at
        away = set(at.index(now.lifted).tolist()) if now.lifted else set()
        stands = np.array([w for w in self.stations.wheels.ravel().tolist() if w not in away], dtype=np.int64)
        gaps = at.rows(at.bodies.packed.joints[stands], at.contacts[stands, 1:4], at.contacts[stands, 4:7])
        rows = [gaps, *(coupling.row[None, :] for coupling in at.rover.couplings)]
        rows += [loop.jacobian(at.mechanism) for loop in at.rover.loops]
        return np.vstack(rows)

    def _free(self, now: Now) -> Integers:
        """Columns of height, pitch, roll and of passive joints that no clutch holds."""
        rover = now.at.rover
        held = {*rover.actuated, *now.locked, *rover.dof_names[:2], rover.dof_names[3]}
        held |= {wheel.drive for wheel in rover.wheels if wheel.drive is not None}
        return np.array([i for i, name in enumerate(rover.dof_names) if name not in held], dtype=np.int64)
