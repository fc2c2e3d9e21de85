"""Front and second wheel turn as fast as the arms between them change their distance."""

from __future__ import annotations

import numpy as np

from rover_pin.control.motion_constraints.of_rates import OfRates
from rover_pin.control.now import Now
from rover_pin.numerics import Array


class Coordination(OfRates):
    """v_F - v_M - d(d_fm)/dt of each side [m/s] (motion constraint 2), heading axes.

    v_F and v_M are what the wheels' turning makes of their centres' speed: (turning of the wheel, which is
    the drive's with the carrier's) x (centre - contact point), along the heading; d_fm is how far the front
    wheel's centre is ahead of the second one's, and changes as their centres move. As centre and turning
    together move the material point at the contact, the value is how much faster the second wheel's contact
    point slides than the front one's: 0 where neither slides, on any ground, at any pitch rate. The paper's
    closed form holds for arms without pillar and without a pitch rate only.

    A side whose front or second wheel is lifted has nothing to coordinate: NaN, and a row of zeros.
    """

    name = "coordination"
    number = 2
    unit = "m/s"
    by_side = True

    def value(self, now: Now) -> Array:
        """(2,) m/s, positive where the front wheel turns too fast; NaN where a wheel of the two is lifted."""
        values = super().value(now)
        if now.lifted:
            values[np.logical_not(self.applies(now))] = np.nan
        return values

    def rows(self, now: Now) -> Array:
        """(2, nv) sliding along the heading of the second less that of the front wheel's contact point."""
        at, placed = now.at, self.stations.at(now.at)
        pair = self.stations.pairs
        along = np.empty((4, 3))
        along[:] = placed.heading
        sliding = at.rows(at.bodies.rolling_joints[pair], at.contacts[pair, 1:4], along)
        rows: Array = sliding[2:] - sliding[:2]
        if now.lifted:
            rows[np.logical_not(self.applies(now))] = 0.0
        return rows

    def applies(self, now: Now) -> Array:
        """(2,) bool: sides whose front and second wheel stand."""
        sides = self.stations.layout.sides
        return np.array([not set(side.wheels[:2]) & set(now.lifted) for side in sides])


CONSTRAINT = Coordination
