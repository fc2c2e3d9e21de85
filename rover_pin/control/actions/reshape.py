"""Raising and lowering the chassis: both rockers together, some wheels braked, the others following."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rover_pin.control.actions.action import Action, Command, Start, drives_of, still
from rover_pin.control.layout import Layout
from rover_pin.errors import InputError
from rover_pin.kinematics.instant import Instant
from rover_pin.kinematics.limits import Held
from rover_pin.kinematics.rolling import ground_rows
from rover_pin.kinematics.rows import Aim, Box, Limit, Rows, Task, equations, number
from rover_pin.kinematics.tasks import BaseTwist, Clearance, Posture, Rates
from rover_pin.kinematics.tasks.clearance import clearance

BRAKED = 1e3
"""Weight of a rate squared of brakes beside the first, which already holds the rover: on uneven ground all of
them together would hold what the rockers have to move."""


@dataclass(frozen=True)
class Together:
    """Both sides' rockers at the same rate, and at angles as far apart as they were.

    Attributes:
        layout: the rover's sides.
    """

    layout: Layout

    def rows(self, at: Instant, dt: float) -> Rows:
        """One row."""
        row = np.zeros((1, at.rover.model.nv))
        left, right = (at.rover.column[side.rocker] for side in self.layout.sides)
        row[0, left], row[0, right] = 1.0, -1.0
        return equations(("rockers together",), row, np.zeros(1))


@dataclass(frozen=True)
class Standing:
    """Wheels whose centres do not move over the ground: they do not roll even where their carriers turn.

    Attributes:
        wheels: their names.
    """

    wheels: tuple[str, ...]

    def rows(self, at: Instant, dt: float) -> Rows:
        """A row a wheel."""
        which = at.index(self.wheels)
        names = tuple(f"standing of {name}" for name in self.wheels)
        return equations(names, ground_rows(at, which), np.zeros(len(which)))


@dataclass(frozen=True)
class StandStill:
    """The same as a task.

    Attributes:
        wheels: their names.
        weight: of a (m/s) squared.
        name: what people read.
    """

    wheels: tuple[str, ...]
    weight: float
    name: str = "standing wheels"

    def aim(self, at: Instant, dt: float) -> Aim:
        """A row a wheel."""
        which = at.index(self.wheels)
        return Aim(ground_rows(at, which), np.zeros(len(which)), np.full(len(which), self.weight))


@dataclass(frozen=True)
class Reshape(Action):
    """Bring the belly to a clearance.

    Attributes:
        layout: the rover's sides.
        clearance: m, the belly's mean height over the ground to go to; None where `angle` is the goal.
        speed: m/s of the belly.
        braked: wheels that are held: their drives where `hold` is `drive`, so that they roll with the arms
            that carry them; over the ground where it is `wheel`.
        hold: `drive` or `wheel`.
        forward: m/s of the root link meanwhile, or None where it goes where the braked wheels let it.
        angle: rad, both rockers' to go to, on ground where a clearance means nothing; None where
            `clearance` is the goal.
        label: what people read.

    Raises:
        InputError: a clearance or speed that is not above 0, both goals or none, an unknown hold, wheels
            braked while it drives, or neither.
    """

    layout: Layout
    clearance: float | None
    speed: float = 0.0036
    braked: tuple[str, ...] = ()
    hold: str = "drive"
    forward: float | None = None
    angle: float | None = None
    label: str = "raise or lower"

    def __post_init__(self) -> None:
        for word in ("clearance", "speed"):
            value = getattr(self, word)
            if value is not None and not number(word, value) > 0.0:
                raise InputError("must be above 0", element=word, value=value)
        if (self.clearance is None) == (self.angle is None):
            raise InputError("needs a clearance or an angle to go to, one of them", element=self.label)
        if self.hold not in ("drive", "wheel"):
            raise InputError("no way to hold", element="hold", value=self.hold, cure="drive or wheel")
        if bool(self.braked) == (self.forward is not None):
            raise InputError("needs wheels that are braked, or a speed to drive at, one of them",
                             element=self.label)  # fmt: skip

    @property
    def name(self) -> str:
        """What people read."""
        return self.label

    def limits(self, start: Start) -> tuple[Limit | Box, ...]:
        """Rockers together; the first braked wheel is held hard."""
        moving = tuple(side.rocker for side in self.layout.sides)
        kept: tuple[Limit | Box, ...] = (Together(self.layout), *still(start, self.layout, moving))
        if not self.braked:
            return kept
        first = self.braked[:1]
        held = Standing(first) if self.hold == "wheel" else Held(drives_of(start.at.rover, first))
        return (*kept, held)

    def command(self, at: Instant, start: Start, dt: float) -> Command:
        """The clearance; other braked wheels turn no more than the ground makes them."""
        tasks: list[Task] = [self._goal(at)]
        if self.forward is not None:
            tasks.append(BaseTwist(forward=self.forward, yaw=0.0))
            return Command(tuple(tasks), nominal={"forward": self.forward})
        others = self.braked[1:]
        if others and self.hold == "drive":
            tasks.append(Rates(dict.fromkeys(drives_of(at.rover, others), 0.0), BRAKED, "brakes"))
        elif others:
            tasks.append(StandStill(others, BRAKED))
        return Command(tuple(tasks))

    def _goal(self, at: Instant) -> Task:
        if self.clearance is not None:
            return Clearance(goal=self.clearance, speed=self.speed, gain=1.0, weight=10.0)
        rockers = dict.fromkeys((side.rocker for side in self.layout.sides), float(self.angle or 0.0))
        pace = self.speed / (0.5 * at.rover.wheel_span)  # a rocker is about as long as half the wheels' span
        return Posture(rockers, speed=pace, gain=1.0, weight=10.0, name="rockers")

    def left(self, at: Instant, start: Start) -> float:
        """m of clearance, or rad of the rockers."""
        if self.clearance is not None:
            return abs(self.clearance - clearance(at))
        return max(abs(float(self.angle or 0.0) - angle) for angle in self._angles(at))

    def undone(self, start: Start, now: Start) -> Action:
        """Back to the clearance it had."""
        forward = None if self.forward is None else -self.forward
        before = clearance(start.at) if self.clearance is not None else None
        angle = None if self.angle is None else sum(self._angles(start.at)) / 2.0
        label = f"undo {self.label}"
        return Reshape(self.layout, before, self.speed, self.braked, self.hold, forward, angle, label)

    def _angles(self, at: Instant) -> list[float]:
        return [float(at.q[at.rover.column[side.rocker]]) for side in self.layout.sides]
