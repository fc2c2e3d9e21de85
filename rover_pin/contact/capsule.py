"""A capsule: a segment swept by a ball."""

from __future__ import annotations

from dataclasses import dataclass

from rover_pin.contact.checks import coefficient, direction, length, point
from rover_pin.contact.place import SEGMENT
from rover_pin.numerics import Array


@dataclass(frozen=True, eq=False)
class Capsule:
    """A rod with round ends, in the frame of the joint that carries it.

    Attributes:
        name: of the capsule.
        link: URDF link it belongs to.
        joint: Pinocchio's id of the joint whose body carries it.
        center: (3,) m, middle of the segment, in that joint's frame.
        axis: (3,) unit, along the segment.
        half_length: m, of the segment between the ends' centres.
        radius: m, of the ball; zero is a bare segment.
        friction: Coulomb's coefficient.
    """

    name: str
    link: str
    joint: int
    center: Array
    axis: Array
    half_length: float
    radius: float
    friction: float = 0.6

    def __post_init__(self) -> None:
        """Check and freeze.

        Raises:
            InputError: a value that is no capsule, named with the cure.
        """
        fill = object.__setattr__
        fill(self, "center", point(self.name, "center", self.center))
        fill(self, "axis", direction(self.name, "axis", self.axis))
        fill(self, "half_length", length(self.name, "half_length", self.half_length, zero=True))
        fill(self, "radius", length(self.name, "radius", self.radius, zero=True))
        fill(self, "friction", coefficient(self.name, "friction", self.friction))

    @property
    def form(self) -> int:
        """SEGMENT."""
        return SEGMENT

    @property
    def ring(self) -> float:
        """Half length of the segment, m."""
        return self.half_length

    @property
    def tread(self) -> float:
        """The ball's radius, m."""
        return self.radius
