"""A wheel: a circle of radius r - c about its axis, swept by a ball of radius c (its tread)."""

from __future__ import annotations

import math
from dataclasses import dataclass

from rover_pin.contact.checks import coefficient, direction, length, point
from rover_pin.contact.place import RING
from rover_pin.errors import InputError
from rover_pin.numerics import Array


@dataclass(frozen=True, eq=False)
class Wheel:
    """A wheel, in the frame of the body that carries it (the wheel braked turns with that body).

    Attributes:
        name: of the wheel.
        link: URDF link it belongs to.
        joint: Pinocchio's id of the joint whose body carries it: the parent of the wheel's own turning joint,
            or the wheel's body itself where it does not turn.
        center: (3,) m, in that joint's frame.
        axis: (3,) unit, in that joint's frame.
        radius: m, over all.
        width: m.
        tread: m; radius of the ball, default the lesser of half the width and the radius. Equal to the radius
            the wheel is a sphere.
        friction: Coulomb's coefficient.
        free: whether it turns freely and so carries no rolling force.
        drive: name of the wheel's own turning joint, or None.
        auxiliary: whether it is none of the wheels that should carry.
    """

    name: str
    link: str
    joint: int
    center: Array
    axis: Array
    radius: float
    width: float
    tread: float = math.nan
    friction: float = 0.6
    free: bool = False
    drive: str | None = None
    auxiliary: bool = False

    def __post_init__(self) -> None:
        """Check and freeze.

        Raises:
            InputError: a value that is no wheel, named with the cure.
        """
        fill = object.__setattr__
        fill(self, "center", point(self.name, "center", self.center))
        fill(self, "axis", direction(self.name, "axis", self.axis))
        fill(self, "radius", length(self.name, "radius", self.radius))
        fill(self, "width", length(self.name, "width", self.width, zero=True))
        fill(self, "friction", coefficient(self.name, "friction", self.friction))
        silent = isinstance(self.tread, float) and math.isnan(self.tread)
        tread = min(0.5 * self.width, self.radius) if silent else self.tread
        fill(self, "tread", length(self.name, "tread", tread, zero=True))
        if self.tread > self.radius:
            raise InputError(
                f"tread is more than the radius {self.radius:g} m",
                element=self.name,
                value=self.tread,
                cure="give at most the radius, which makes the wheel a sphere",
            )

    @property
    def form(self) -> int:
        """RING."""
        return RING

    @property
    def ring(self) -> float:
        """Radius of the circle that the ball sweeps, m."""
        return self.radius - self.tread
