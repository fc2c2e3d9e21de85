"""Rolling: along the heading, across it, or about an instant centre, the suspension still."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from rover_pin.control.actions.action import CLOSE, Action, Command, Start, still
from rover_pin.control.layout import Layout
from rover_pin.errors import InputError
from rover_pin.kinematics.instant import Instant
from rover_pin.kinematics.rows import Box, Limit, Task, number
from rover_pin.kinematics.steering import Twist, steering_for, steering_joints
from rover_pin.kinematics.tasks import BaseTwist, Posture, Rates
from rover_pin.numerics import Array

FAST = 10.0
"""rad/s: more than any steering; its own speed limit holds."""

FOLLOWING = 100.0
"""Weight of the steering's rates squared [(rad/s)^-2] against the base's: below that of side slip."""


@dataclass(frozen=True)
class Drive(Action):
    """Roll until a length of way is done.

    Attributes:
        layout: the rover's sides.
        twist: of the root link.
        way: m along the path, above 0.
        follows: whether the steering follows the instant centre while it drives; else it holds.
        rockers: rates of rockers that move meanwhile [rad/s].
        label: what people read.

    Raises:
        InputError: a way that is not above 0, or a twist that does not move the root link.
    """

    layout: Layout
    twist: Twist
    way: float
    follows: bool = False
    rockers: Mapping[str, float] | None = None
    label: str = "roll"

    def __post_init__(self) -> None:
        if not number("way", self.way) > 0.0:
            raise InputError("must be above 0 m", element="way", value=self.way)
        if not self.speed > 0.0:
            raise InputError("does not move the rover", element="twist", value=self.twist,
                             cure="give forward=, left= or a centre away from the root link")  # fmt: skip

    @property
    def name(self) -> str:
        """What people read."""
        return self.label

    @property
    def speed(self) -> float:
        """Of the root link, m/s."""
        return math.hypot(self.twist.forward, self.twist.left)

    def limits(self, start: Start) -> tuple[Limit | Box, ...]:
        """Steering and rockers hold but for those that move."""
        steering = tuple(steering_joints(start.at).values()) if self.follows else ()
        return still(start, self.layout, (*(self.rockers or {}), *steering))

    def command(self, at: Instant, start: Start, dt: float) -> Command:
        """The twist; the last step goes just as far as is left."""
        share = min(1.0, max(self.left(at, start), 0.0) / (self.speed * dt))
        twist = Twist(self.twist.forward * share, self.twist.left * share, self.twist.yaw * share)
        nominal = {"forward": twist.forward, "left": twist.left, "yaw": twist.yaw}
        wanted: list[Task] = [BaseTwist(forward=twist.forward, left=twist.left, yaw=twist.yaw)]
        if self.rockers:
            wanted.append(Rates(dict(self.rockers), name="rockers"))
        if not self.follows:
            return Command(tuple(wanted), nominal=nominal)
        angles = steering_for(at, self.twist, rates=self.rockers)
        wanted.append(Posture(angles, speed=FAST, gain=1.0, weight=FOLLOWING, name="steering"))
        return Command(tuple(wanted), nominal=nominal)

    def left(self, at: Instant, start: Start) -> float:
        """m of the way."""
        return self.way - self._done(start.at.q, at.q)

    def undone(self, start: Start, now: Start) -> Action:
        """Back along the same path."""
        back = Twist(-self.twist.forward, -self.twist.left, -self.twist.yaw)
        rockers = {name: -rate for name, rate in self.rockers.items()} if self.rockers else None
        way = max(self._done(start.at.q, now.at.q), CLOSE)
        return Drive(self.layout, back, way, self.follows, rockers, f"undo {self.label}")

    def _done(self, begun: Array, now: Array) -> float:
        """m of the way: of the arc where the rover turns, else of the line."""
        if self.twist.yaw != 0.0:
            return self.speed / abs(self.twist.yaw) * abs(float(now[3] - begun[3]))
        return math.hypot(float(now[0] - begun[0]), float(now[1] - begun[1]))
