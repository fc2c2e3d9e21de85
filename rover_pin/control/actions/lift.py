"""Lifting wheels and letting them down, clutches engaged: the rockers of their sides fold or unfold."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rover_pin.control.actions.action import Action, Command, Grip, Start, drives_of, still
from rover_pin.control.layout import Layout, Side
from rover_pin.control.lifting.plan import plan_lift
from rover_pin.control.lifting.result import Refusal
from rover_pin.control.standing import held_joints, place_of
from rover_pin.errors import InputError
from rover_pin.kinematics.instant import Instant
from rover_pin.kinematics.limits import Held
from rover_pin.kinematics.rows import Box, Limit, Task, number
from rover_pin.kinematics.tasks import Rates, WheelLift
from rover_pin.kinematics.tasks.wheel_lift import height


@dataclass(frozen=True)
class LiftWheels(Action):
    """Bring wheels to a height over the ground below; at 0 they are let down and stand when it ends.

    Attributes:
        layout: the rover's sides.
        wheels: their names, at most one a side.
        height: m over the ground below the wheel.
        speed: m/s of the wheel.
        label: what people read.

    Raises:
        InputError: a height below 0, a speed that is not above 0, two wheels of a side.
    """

    layout: Layout
    wheels: tuple[str, ...]
    height: float
    speed: float = 0.0036
    label: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "wheels", tuple(self.wheels))
        if number("height", self.height) < 0.0:
            raise InputError("must be at least 0 m", element="height", value=self.height)
        if not number("speed", self.speed) > 0.0:
            raise InputError("must be above 0 m/s", element="speed", value=self.speed)
        if len({side.name for side in self._sides}) < len(self.wheels) or not self.wheels:
            raise InputError("one wheel a side is lifted", element="wheels", value=", ".join(self.wheels))

    @property
    def name(self) -> str:
        """What people read."""
        verb = "let down" if self.height == 0.0 else "lift"
        return self.label or f"{verb} {' and '.join(self.wheels)}"

    @property
    def _sides(self) -> tuple[Side, ...]:
        return tuple(self.layout.side_of(wheel) for wheel in self.wheels)

    def check(self, at: Instant, start: Start) -> None:
        """The clutches of the sides are engaged, and the statics carry the lift.

        Raises:
            InputError: a clutch that is not engaged or not there; a lift whose statics would need a negative
                load, or that is out of reach, in the words of the refusal.
        """
        for side in self._sides:
            if side.clutch is None or side.clutch not in start.grip.clutches:
                raise InputError(
                    f"a wheel of the {side.name} side is lifted with its clutch engaged",
                    element=side.clutch or f"{side.name}: clutch",
                    cure="engage it first",
                )
        if self.height > 0.0 and not start.grip.lifted:
            joints = held_joints(at, start.grip)
            (x, y, yaw), ground = place_of(at), at.bodies.terrain
            planned = plan_lift(
                at.rover, self.layout, self.wheels, self.height, joints, ground, x=x, y=y, yaw=yaw
            )
            if isinstance(planned, Refusal):
                raise InputError(f"is not lifted: {planned.reason}", element=" and ".join(self.wheels))

    def grip(self, start: Start) -> Grip:
        """The wheels hang."""
        return Grip(start.grip.clutches, tuple(dict.fromkeys((*start.grip.lifted, *self.wheels))))

    def grip_after(self, start: Start) -> Grip:
        """Let down they stand."""
        if self.height > 0.0:
            return self.grip(start)
        return Grip(start.grip.clutches, tuple(w for w in start.grip.lifted if w not in self.wheels))

    def limits(self, start: Start) -> tuple[Limit | Box, ...]:
        """The other rockers and the steering hold, and one standing wheel is braked."""
        moving = tuple(side.rocker for side in self._sides)
        brake = Held(drives_of(start.at.rover, (self.braked(self.grip(start).lifted),)))
        return (*still(start, self.layout, moving), brake)

    def command(self, at: Instant, start: Start, dt: float) -> Command:
        """Gaps to the height; the drives follow."""
        gain = 1.0 if self.height > 0.0 else LANDING
        tasks: list[Task] = [
            WheelLift(wheel, height=self.height, speed=self.speed, gain=gain, weight=10.0)
            for wheel in self.wheels
        ]
        hanging = self.grip(start).lifted
        tasks.append(Rates(dict.fromkeys(drives_of(at.rover, hanging), 0.0), name="hanging wheels"))
        return Command(tuple(tasks))

    def braked(self, hanging: tuple[str, ...]) -> str:
        """The wheel that stays in place: of a side that keeps its shape where there is one, in the middle."""
        still_sides = [side for side in self.layout.sides if side not in self._sides] or list(self._sides)
        order = sorted(still_sides[0].wheels, key=lambda w: abs(self.layout.row_of(w) - 1))
        return next(wheel for wheel in order if wheel not in hanging)

    def left(self, at: Instant, start: Start) -> float:
        """m of the wheel that has the most to go."""
        which = at.index(self.wheels)
        if self.height == 0.0:
            return float(np.max(np.abs(at.contacts[which, 0])))
        return max(abs(height(at, place) - self.height) for place in which.tolist())

    def undone(self, start: Start, now: Start) -> Action:
        """Back to the gaps they had."""
        stood = not set(self.wheels) <= set(start.grip.lifted)
        was = 0.0 if stood else max(height(start.at, i) for i in start.at.index(self.wheels).tolist())
        return LiftWheels(self.layout, self.wheels, was, self.speed, f"undo {self.name}")


LANDING = 0.5
"""Share of what is left that a landing wheel goes in a cycle: it meets the ground without force."""
