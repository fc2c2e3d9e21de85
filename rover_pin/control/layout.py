"""A rover's two sides: which wheels stand on each, front to rear, and which joints reshape it."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rover_pin.errors import InputError, nearest

if TYPE_CHECKING:
    from rover_pin.rover import Rover


@dataclass(frozen=True)
class Side:
    """One side of a rover with driven rockers.

    Attributes:
        name: `left` or `right`, or what else it is called.
        wheels: their names, front to rear.
        hinge: joint at which the side hangs on the body; its origin is the hinge point.
        rocker: the driven joint that reshapes the side.
        clutch: passive joint that can be locked, or None.
    """

    name: str
    wheels: tuple[str, ...]
    hinge: str
    rocker: str
    clutch: str | None = None


@dataclass(frozen=True)
class Layout:
    """Left and right side of a rover.

    Attributes:
        left: side at positive y.
        right: side at negative y, with as many wheels.
    """

    left: Side
    right: Side

    @property
    def sides(self) -> tuple[Side, Side]:
        """Left, right."""
        return self.left, self.right

    @property
    def wheels(self) -> tuple[str, ...]:
        """All wheels, the left side's first."""
        return (*self.left.wheels, *self.right.wheels)

    def side_of(self, wheel: str) -> Side:
        """The side a wheel stands on.

        Raises:
            InputError: no wheel of that name.
        """
        for side in self.sides:
            if wheel in side.wheels:
                return side
        raise InputError("no wheel of that name", element=wheel, cure=nearest(wheel, self.wheels))

    def row_of(self, wheel: str) -> int:
        """Place of a wheel on its side: 0 is the front.

        Raises:
            InputError: no wheel of that name.
        """
        return self.side_of(wheel).wheels.index(wheel)

    def checked(self, rover: Rover) -> Layout:
        """This layout, where every name in it is the rover's.

        Raises:
            InputError: a wheel, hinge, rocker or clutch that the rover does not have, a rocker that is not
                driven, a clutch that cannot be locked, a wheel named twice, sides of different length.
        """
        _check(self.wheels, [wheel.name for wheel in rover.wheels], "wheel", "no wheel of that name")
        for side in self.sides:
            _check([side.hinge], rover.joints, f"{side.name}: hinge", "no joint of that name")
            _check([side.rocker], rover.actuated, f"{side.name}: rocker", "no driven joint of that name")
            if side.clutch is not None:
                _check([side.clutch], rover.lockable, f"{side.name}: clutch", "no joint that can be locked")
        if len(set(self.wheels)) < len(self.wheels):
            twice = next(wheel for wheel in self.wheels if self.wheels.count(wheel) > 1)
            raise InputError("stands on the sides twice", element=twice, cure="name each wheel once")
        if len(self.left.wheels) != len(self.right.wheels) or len(self.left.wheels) < 2:
            counts = f"{len(self.left.wheels)} and {len(self.right.wheels)}"
            raise InputError("sides need as many wheels as each other, at least two", element="sides",
                             value=counts, cure="list the wheels of each side front to rear")  # fmt: skip
        return self


def hinge_span(rover: Rover, layout: Layout) -> float:
    """Distance between the two hinges at home [m]."""
    import numpy as np
    import pinocchio as pin

    data = rover.model.createData()
    pin.forwardKinematics(rover.model, data, np.array(rover.neutral))
    left, right = (data.oMi[rover.model.getJointId(side.hinge)].translation for side in layout.sides)
    return math.dist(left, right)


def _check(names: Iterable[str], known: Iterable[str], element: str, what: str) -> None:
    known = list(known)
    for name in names:
        if name not in known:
            raise InputError(what, element=element, value=name, cure=nearest(name, known))
