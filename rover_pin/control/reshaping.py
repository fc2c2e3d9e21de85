"""How much the distance between front and second wheel changes for a rocker's turning, wheels standing."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rover_pin.control.kernels import rates_by_rockers
from rover_pin.kinematics.instant import Instant, Integers
from rover_pin.numerics import Array

if TYPE_CHECKING:
    from rover_pin.control.now import Now
    from rover_pin.control.stations import Stations

KEPT = 1e-6
"""Share of what a rocker's turning does to a row that may be left over before the rocker counts as stuck."""

STEEP = 1e6
"""Rates per rate of a rocker beyond which the rows count as singular."""

State = tuple[tuple[str, ...], tuple[str, ...]]


class Reshaping:
    """d(d_fm)/dw of each side, from Jacobians.

    One rocker turns, every other driven or locked joint and the base's place and heading are held; what is
    left of the rates (height, pitch, roll, passive joints) keeps the gaps of the wheels that stand, the
    couplings and the loops: least squares of A_free x = -A_rocker, the least x where they leave a freedom.
    """

    def __init__(self, stations: Stations) -> None:
        self.stations = stations
        rows = [coupling.row for coupling in stations.rover.couplings]
        self._couplings = np.array(rows).reshape(-1, stations.rover.model.nv)
        self._chosen: dict[State, tuple[Integers, Integers]] = {}
        self._latest: tuple[Instant, State, Array] | None = None

    def rates(self, now: Now) -> Array:
        """(2,) m per rad (or m) of the rocker, left and right; 0 of a rocker that the wheels do not let turn.

        Raises:
            InputError: a lifted wheel that the rover does not have.
        """
        state = (now.lifted, now.locked)
        if self._latest is None or self._latest[0] is not now.at or self._latest[1] != state:
            self._latest = now.at, state, self._work_out(now, state)
        return self._latest[2]

    def _work_out(self, now: Now, state: State) -> Array:
        if state not in self._chosen:
            self._chosen[state] = self._standing(now), self._free(now)
        stands, free = self._chosen[state]
        rows, rockers = self._rows(now.at, stands), self.stations.rockers
        apart = self.stations.at(now.at).apart_rows
        rates: Array
        if len(rows) == len(free):
            regular, rates = rates_by_rockers(rows, free, rockers, apart, STEEP, KEPT)
            if regular:
                return rates
        turning = rows[:, rockers]
        found = np.linalg.lstsq(rows[:, free], -turning, rcond=1e-9)[0]
        missed = np.abs(rows[:, free] @ found + turning).max(axis=0)
        rates = (apart[:, free] @ found).diagonal() + apart[[0, 1], rockers]
        return np.where(missed > KEPT * np.abs(turning).max(axis=0), 0.0, rates)

    def _rows(self, at: Instant, stands: Integers) -> Array:
        """Of gaps of standing wheels, couplings, loops."""
        gaps = at.normal_rows[stands]
        loops = [loop.jacobian(at.mechanism) for loop in at.rover.loops]
        rows: Array = np.concatenate([gaps, self._couplings, *loops])
        return rows

    def _standing(self, now: Now) -> Integers:
        """Places of the sides' wheels that are not lifted."""
        away = now.at.index(now.lifted).tolist()
        return np.array([w for w in self.stations.wheels.ravel().tolist() if w not in away], dtype=np.int64)

    def _free(self, now: Now) -> Integers:
        """Columns of height, pitch, roll and of passive joints that no clutch holds."""
        rover = now.at.rover
        held = {*rover.actuated, *now.locked, *rover.dof_names[:2], rover.dof_names[3]}
        held |= {wheel.drive for wheel in rover.wheels if wheel.drive is not None}
        return np.array([i for i, name in enumerate(rover.dof_names) if name not in held], dtype=np.int64)
