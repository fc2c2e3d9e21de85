"""What motion constraints on velocities share: a value that is linear in the velocity."""

from __future__ import annotations

from abc import abstractmethod

from rover_pin.control.motion_constraints.constraint import MotionConstraint, Options
from rover_pin.control.now import Now
from rover_pin.control.stations import Stations
from rover_pin.numerics import Array


class OfRates(MotionConstraint):
    """value = gradient v + offset; the gradient of the latest `Now` is kept."""

    kind = "velocity"

    def __init__(self, stations: Stations, options: Options | None = None) -> None:
        super().__init__(stations, options)
        self._latest: tuple[Now, Array] | None = None

    @abstractmethod
    def rows(self, now: Now) -> Array:
        """(parts, nv) of the value."""

    def value(self, now: Now) -> Array:
        """(parts,) gradient v + offset; NaN where it does not apply."""
        value: Array = self.gradient(now) @ now.v + self.offset(now)
        return value

    def gradient(self, now: Now) -> Array:
        """(parts, nv) d value / dv; zeros where it does not apply. Not to be written to."""
        if self._latest is None or self._latest[0] is not now:
            rows = self.rows(now)
            rows.setflags(write=False)
            self._latest = now, rows
        return self._latest[1]


class ChangeOfRates(OfRates):
    """The same of what the velocity looked at has more than the commanded one."""

    def offset(self, now: Now) -> Array:
        """(parts,) less what is commanded."""
        value: Array = -(self.gradient(now) @ now.nominal)
        return value


