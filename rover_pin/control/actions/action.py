"""What an action is: a part of a mode that commands one thing until it is reached, and can be undone."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING

from rover_pin.kinematics.limits import Held
from rover_pin.kinematics.rows import Box, Limit, Task
from rover_pin.numerics import Array

if TYPE_CHECKING:
    from rover_pin.control.layout import Layout
    from rover_pin.kinematics.instant import Instant
    from rover_pin.rover import Rover


CLOSE = 1e-6
"""m or rad: an action is finished this near to its end."""


def _free() -> Mapping[str, float]:
    return MappingProxyType({})


@dataclass(frozen=True)
class Grip:
    """What holds and what hangs: the part of a rover's state that is no position.

    Attributes:
        clutches: engaged ones, with the values at which they hold [rad or m].
        lifted: wheels held off the ground.
    """

    clutches: Mapping[str, float] = field(default_factory=_free)
    lifted: tuple[str, ...] = ()


@dataclass(frozen=True)
class Start:
    """Where an action began.

    Attributes:
        at: the instant.
        grip: clutches and lifted wheels.
        velocity: (nv,) the rates before it; zeros at a standstill.
    """

    at: Instant
    grip: Grip
    velocity: Array


@dataclass(frozen=True)
class Command:
    """What an action wants of one cycle.

    Attributes:
        tasks: wanted.
        nominal: rates of the base without reshaping: `forward`, `left` [m/s], `yaw` [rad/s].
    """

    tasks: tuple[Task, ...]
    nominal: Mapping[str, float] = field(default_factory=_free)


class Action(ABC):
    """One part of a mode."""

    @property
    @abstractmethod
    def name(self) -> str:
        """What people read, a few words."""

    def begun(self, start: Start) -> Action:
        """The action with what follows from where it begins."""
        return self

    def check(self, at: Instant, start: Start) -> None:  # noqa: B027
        """Refuse where it cannot begin.

        Raises:
            InputError: names what stands against it.
        """

    def grip(self, start: Start) -> Grip:
        """Clutches and lifted wheels while it goes on."""
        return start.grip

    def grip_after(self, start: Start) -> Grip:
        """Clutches and lifted wheels when it is finished."""
        return self.grip(start)

    def limits(self, start: Start) -> tuple[Limit | Box, ...]:
        """What it obeys besides what always holds, from beginning to end."""
        return ()

    @abstractmethod
    def command(self, at: Instant, start: Start, dt: float) -> Command:
        """What it wants of a cycle of dt [s]."""

    @abstractmethod
    def left(self, at: Instant, start: Start) -> float:
        """What is left to do [m or rad]; finished at CLOSE."""

    @abstractmethod
    def undone(self, start: Start, now: Start) -> Action:
        """The action that goes back from `now` to where this one began."""


def drives_of(rover: Rover, wheels: tuple[str, ...]) -> tuple[str, ...]:
    """Drive joints of wheels that have one."""
    by_name = {wheel.name: wheel.drive for wheel in rover.wheels}
    return tuple(drive for name in wheels if (drive := by_name[name]) is not None)


def still(start: Start, layout: Layout, moving: tuple[str, ...] = ()) -> tuple[Limit, ...]:
    """Steering and rockers that hold, but for those that move."""
    from rover_pin.kinematics.steering import steering_joints

    steering = tuple(joint for joint in steering_joints(start.at).values() if joint not in moving)
    rockers = tuple(side.rocker for side in layout.sides if side.rocker not in moving)
    return tuple(
        Held(joints, word) for joints, word in ((steering, "steering"), (rockers, "rocker")) if joints
    )
