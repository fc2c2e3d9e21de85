"""Turning wheels in place."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from rover_pin.control.actions.action import Action, Command, Start, still
from rover_pin.control.layout import Layout
from rover_pin.errors import InputError
from rover_pin.kinematics.instant import Instant
from rover_pin.kinematics.limits import Held
from rover_pin.kinematics.rows import Box, Limit, columns, number
from rover_pin.kinematics.steering import Twist, steering_for, steering_joints
from rover_pin.kinematics.tasks import Posture

STAY = ("base_x", "base_y", "base_yaw")
"""What holds while wheels turn: every wheel has its drive to roll along by, where its steering axis leans."""


@dataclass(frozen=True)
class SteerToward(Action):
    """Turn all wheels to where a motion of the base carries them, or straight.

    Attributes:
        layout: the rover's sides.
        twist: of the root link; None turns all steering to 0.
        speed: rad/s, at most.
        label: what people read.
        rates: of rockers that will move meanwhile [rad/s].
    """

    layout: Layout
    twist: Twist | None
    speed: float = 0.1
    label: str = "turn the wheels"
    rates: Mapping[str, float] | None = None

    @property
    def name(self) -> str:
        """What people read."""
        return self.label

    def begun(self, start: Start) -> Action:
        """The angles from where it begins.

        Raises:
            InputError: a wheel that cannot be steered to where it has to go.
        """
        if self.twist is None:
            angles = dict.fromkeys(steering_joints(start.at).values(), 0.0)
        else:
            angles = steering_for(start.at, self.twist, rates=self.rates)
        return Steer(self.layout, angles, self.speed, self.label)

    def command(self, at: Instant, start: Start, dt: float) -> Command:
        """Of the action it begins as."""
        return self.begun(start).command(at, start, dt)

    def left(self, at: Instant, start: Start) -> float:
        """rad: of the joint that has the most to go."""
        return self.begun(start).left(at, start)

    def undone(self, start: Start, now: Start) -> Action:
        """Back to the angles they had."""
        return self.begun(start).undone(start, now)


@dataclass(frozen=True)
class Steer(Action):
    """Bring steering joints to angles, the base where it is.

    Attributes:
        layout: the rover's sides.
        angles: rad, by steering joint.
        speed: rad/s, at most.
        label: what people read.

    Raises:
        InputError: a speed that is not above 0.
    """

    layout: Layout
    angles: Mapping[str, float]
    speed: float = 0.1
    label: str = "steer"

    def __post_init__(self) -> None:
        if not number("steering speed", self.speed) > 0.0:
            raise InputError("must be above 0 rad/s", element="steering speed", value=self.speed)
        object.__setattr__(self, "angles", dict(self.angles))

    @property
    def name(self) -> str:
        """What people read."""
        return self.label

    def check(self, at: Instant, start: Start) -> None:
        """Angles must be within the joints' limits.

        Raises:
            PostureError: an angle beyond them, or an unknown joint.
        """
        at.rover.resolve_posture(self.angles)

    def limits(self, start: Start) -> tuple[Limit | Box, ...]:
        """The base stays, rockers hold."""
        return (Held(STAY, "standing"), *still(start, self.layout, tuple(self.angles)))

    def command(self, at: Instant, start: Start, dt: float) -> Command:
        """The angles."""
        return Command((Posture(self.angles, speed=self.speed, gain=1.0, name="steering"),))

    def left(self, at: Instant, start: Start) -> float:
        """rad: of the joint that has the most to go."""
        places = columns(at, self.label, tuple(self.angles))
        goals = list(self.angles.values())
        return max((abs(float(at.q[i]) - goal) for i, goal in zip(places, goals, strict=True)), default=0.0)

    def undone(self, start: Start, now: Start) -> Action:
        """Back to the angles they had."""
        column = start.at.rover.column
        before = {joint: float(start.at.q[column[joint]]) for joint in self.angles}
        return Steer(self.layout, before, self.speed, f"undo {self.label}")
