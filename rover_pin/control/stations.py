"""Where the wheels and hinges of a rover's sides are along its heading, and how fast they move."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import pinocchio as pin

from rover_pin.control.kernels import place_sides
from rover_pin.control.layout import Layout, hinge_span
from rover_pin.control.reshaping import Reshaping
from rover_pin.errors import InputError
from rover_pin.kinematics.instant import Instant, index_of
from rover_pin.numerics import Array, frozen

if TYPE_CHECKING:
    from rover_pin.rover import Rover

YAW = 3
"""Column of the heading's rate."""


class Stations:
    """A rover's sides as motion constraints see them; shared, so that an instant is worked out once.

    Attributes:
        rover, layout: whose.
        span: distance between the hinges [m].
        home: (2,) m, front wheel's centre ahead of the second one's at home, left and right.
        home_ahead: (2,) m, hinge ahead of the second wheel's centre at home.
        wheels: (2, n) places of wheels in the order of the rover's shapes, front to rear.
        hinges: (2,) Pinocchio's ids of the hinges.
        order: (2 n,) the same in one row.
        pairs: (4,) places of both front wheels, then of both second ones.
        carriers: (2 n + 2,) ids of the bodies that wheels' centres and hinges are points of.
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
        self.order = self.wheels.ravel()
        self.pairs = self.wheels[:, :2].T.ravel()
        joints = [*(carried[i] for i in self.order), *self.hinges]
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
    """The sides at an instant; lengths along the heading, which turns with the base's yaw.

    Attributes:
        stations, instant: whose, when.
        heading: (3,) unit, world.
        hinges: (2, 3) m, world: where the sides hang on the body.
        apart: (2,) m, d_fm: front wheel's centre ahead of the second one's, left and right.
        apart_rows: (2, nv) d(apart)/dq.
        ahead: (2,) m: hinge ahead of the side's second wheel's centre, left and right.
        ahead_rows: (2, nv) d(ahead)/dq.
        rise_rows: (2, nv) velocities [m/s] of hinges upwards.
    """

    def __init__(self, stations: Stations, instant: Instant) -> None:
        self.stations = stations
        self.instant = instant
        heading = instant.heading
        cos, sin = math.cos(heading), math.sin(heading)
        self.heading = np.array([cos, sin, 0.0])
        placed, count = instant.placed, stations.wheels.size
        points = np.empty((count + 2, 3))
        points[:count] = instant.centers[stations.order]
        for side, joint in enumerate(stations.hinges.tolist()):
            points[count + side] = placed[joint].translation
        self.hinges: Array = points[count:]
        self._rows = np.empty((count + 2, instant.jacobian.shape[1]))
        self.rise_rows = np.empty((2, instant.jacobian.shape[1]))
        self.apart, self.apart_rows, self.ahead, self.ahead_rows = place_sides(
            instant.jacobian, instant.bodies.chains, stations.carriers, points, cos, sin, self._rows,
            self.rise_rows,
        )  # fmt: skip

    @property
    def center_rows(self) -> Array:
        """(2, n, nv) velocities [m/s] of wheels' centres along the heading."""
        return self._rows[:-2].reshape(2, -1, self._rows.shape[1])
