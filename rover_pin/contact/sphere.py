"""A foot: a ball, or a bare point where its radius is zero."""

from __future__ import annotations

from dataclasses import dataclass

from rover_pin.contact.checks import coefficient, length, point
from rover_pin.contact.place import RING
from rover_pin.numerics import Array, frozen


@dataclass(frozen=True, eq=False)
class Foot:
    """A spherical or point foot, in the frame of the joint that carries it.

    Attributes:
        name: of the foot.
        link: URDF link it belongs to.
        joint: Pinocchio's id of the joint whose body carries it.
        center: (3,) m, in that joint's frame.
        radius: m; zero is a point.
        friction: Coulomb's coefficient.
    """

    name: str
    link: str
    joint: int
    center: Array
    radius: float = 0.0
    friction: float = 0.6

    def __post_init__(self) -> None:
        """Check and freeze.

        Raises:
            InputError: a value that is no foot, named with the cure.
        """
        fill = object.__setattr__
        fill(self, "center", point(self.name, "center", self.center))
        fill(self, "radius", length(self.name, "radius", self.radius, zero=True))
        fill(self, "friction", coefficient(self.name, "friction", self.friction))

    @property
    def form(self) -> int:
        """RING, of no radius."""
        return RING

    @property
    def axis(self) -> Array:
        """Any direction: a ball has none of its own."""
        return frozen([0.0, 1.0, 0.0])

    @property
    def ring(self) -> float:
        """Zero: the ball sweeps nothing."""
        return 0.0

    @property
    def tread(self) -> float:
        """The ball's radius, m."""
        return self.radius
