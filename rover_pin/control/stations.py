"""Where the wheels and hinges of a rover's sides are along its heading, and how fast they move."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import pinocchio as pin

from rover_pin.control.layout import Layout, hinge_span
from rover_pin.control.reshaping import Reshaping
from rover_pin.errors import InputError
from rover_pin.kinematics.instant import Instant, index_of
from rover_pin.numerics import Array, frozen

if TYPE_CHECKING:
    from rover_pin.rover import Rover

YAW = 3
"""Column of the heading's rate."""

UP = np.array([0.0, 0.0, 1.0])


class Stations:
    """A rover's sides as motion constraints see them; shared, so that an instant is worked out once.

    Attributes:
        rover, layout: whose.
        span: distance between the hinges [m].
        home: (2,) m, front wheel's centre ahead of the second one's at home, left and right.
        home_ahead: (2,) m, hinge ahead of the second wheel's centre at home.
        wheels: (2, n) places of wheels in the order of the rover's shapes, front to rear.
        hinges: (2,) Pinocchio's ids of the hinges.
        carriers: (2 n + 4,) ids of the bodies that wheels' centres and, twice, hinges are points of.
        rockers: (2,) columns of the rockers.

    Raises:
        InputError: a layout that is not the rover's, hinges in one place, or a front wheel that is not ahead.
    """

    def __init__(self, rover: Rover, layout: Layout) -> None:
        self.rover = rover
        self.layout = layout.checked(rover)
        self.parts = tuple(side.name for side in layout.sides)
        names = [shape.name for shape in rover.shapes]
        self.wheels = np.array([index_of(names, side.wheels) for side in layout.sides])
        self.hinges = np.array([rover.model.getJointId(side.hinge) for side in layout.sides])
        carried = [shape.joint for shape in rover.shapes]
        joints = [*(carried[i] for i in self.wheels.ravel()), *self.hinges, *self.hinges]
        self.carriers = np.array(joints, dtype=np.int64)
        self.rockers = np.array([rover.column[side.rocker] for side in layout.sides])
        self.span = hinge_span(rover, layout)
        if not self.span > 0.0:
            raise InputError(
                "both hinges are in one place", element="sides", cure="name one hinge on each side"
            )
        self.home, self.home_ahead = self._at_home()
        self._latest: Placed | None = None

    def at(self, at: Instant) -> Placed:
        """The sides at an instant; the latest is kept."""
        if self._latest is None or self._latest.instant is not at:
            self._latest = Placed(self, at)
        return self._latest

    @cached_property
    def reshaping(self) -> Reshaping:
        """What rockers do to the distances of the wheels."""
        return Reshaping(self)

    def _at_home(self) -> tuple[Array, Array]:
        rover = self.rover
        data = rover.model.createData()
        pin.forwardKinematics(rover.model, data, np.array(rover.neutral))
        x = np.array([data.oMi[wheel.joint].act(np.array(wheel.center))[0] for wheel in rover.wheels])
        ahead: Array = x[self.wheels[:, 0]] - x[self.wheels[:, 1]]
        for side, distance in zip(self.layout.sides, ahead.tolist(), strict=True):
            if not distance > 0.0:
                raise InputError(
                    f"stands behind {side.wheels[1]} at home",
                    element=side.wheels[0],
                    value=distance,
                    cure=f"list the wheels of the {side.name} side front to rear",
                )
        hinges = np.array([data.oMi[joint].translation[0] for joint in self.hinges.tolist()])
        return frozen(ahead), frozen(hinges - x[self.wheels[:, 1]])


class Placed:
    """The sides at an instant; lengths along the heading, which turns with the base's yaw."""

    def __init__(self, stations: Stations, instant: Instant) -> None:
        self.stations = stations
        self.instant = instant
        cos, sin = float(np.cos(instant.heading)), float(np.sin(instant.heading))
        self.heading = np.array([cos, sin, 0.0])
        self.leftward = np.array([-sin, cos, 0.0])

    @cached_property
    def hinges(self) -> Array:
        """(2, 3) m, world: where the sides hang on the body."""
        placed = self.instant.placed
        return np.array([placed[joint].translation for joint in self.stations.hinges.tolist()])

    @cached_property
    def centers(self) -> Array:
        """(2, n, 3) m, world: wheels' centres."""
        centers: Array = self.instant.centers[self.stations.wheels]
        return centers

    @cached_property
    def _rows(self) -> tuple[Array, Array, Array]:
        stations, n = self.stations, self.stations.wheels.size
        points = np.concatenate([self.centers.reshape(-1, 3), self.hinges, self.hinges])
        directions = np.empty_like(points)
        directions[:-2], directions[-2:] = self.heading, UP
        rows = self.instant.rows(stations.carriers, points, directions)
        return rows[:n].reshape(2, n // 2, -1), rows[n:-2], rows[-2:]

    @property
    def center_rows(self) -> Array:
        """(2, n, nv) velocities [m/s] of wheels' centres along the heading."""
        return self._rows[0]

    @property
    def hinge_rows(self) -> Array:
        """(2, nv) velocities [m/s] of hinges along the heading."""
        return self._rows[1]

    @property
    def rise_rows(self) -> Array:
        """(2, nv) velocities [m/s] of hinges upwards."""
        return self._rows[2]

    @cached_property
    def apart(self) -> Array:
        """(2,) m, d_fm: front wheel's centre ahead of the second one's, left and right."""
        distance: Array = (self.centers[:, 0] - self.centers[:, 1]) @ self.heading
        return distance

    @cached_property
    def apart_rows(self) -> Array:
        """(2, nv) d(apart)/dq; the heading turns too."""
        rows = self.center_rows[:, 0] - self.center_rows[:, 1]
        rows[:, YAW] += (self.centers[:, 0] - self.centers[:, 1]) @ self.leftward
        return rows

    @cached_property
    def ahead(self) -> Array:
        """(2,) m: hinge ahead of the side's second wheel's centre, left and right."""
        distance: Array = (self.hinges - self.centers[:, 1]) @ self.heading
        return distance

    @cached_property
    def ahead_rows(self) -> Array:
        """(2, nv) d(ahead)/dq."""
        rows = self.hinge_rows - self.center_rows[:, 1]
        rows[:, YAW] += (self.hinges - self.centers[:, 1]) @ self.leftward
        return rows
