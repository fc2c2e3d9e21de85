"""Doing an action cycle by cycle: what holds always, what the action asks for, what watches add."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rover_pin.control.actions import CLOSE, Action, Command, Grip, Start
from rover_pin.errors import InputError
from rover_pin.kinematics.instant import Instant
from rover_pin.kinematics.inverse import InverseKinematics
from rover_pin.kinematics.limits import (
    Clutch,
    CouplingsKept,
    JointLimits,
    LoopsClosed,
    SpeedLimits,
    rolling_contacts,
)
from rover_pin.kinematics.rows import Box, Limit
from rover_pin.kinematics.solution import Solution
from rover_pin.numerics import Array
from rover_pin.rover import Rover

BEYOND = 1e-6
"""Share that a wanted rate may exceed a joint's speed by."""


class Execution:
    """An action under way.

    Args:
        inverse: the solver.
        action: what is done.
        start: where it begins.
        dt: s a cycle.
        going_back: whether it undoes another; it may then start at a joint's limit, where rates are what the
            limits leave, and is not refused for the speed that it would have without them.

    Raises:
        InputError: the action cannot begin there, or asks for more speed than a joint has; says which.
    """

    def __init__(
        self, inverse: InverseKinematics, action: Action, start: Start, dt: float, *, going_back: bool = False
    ) -> None:
        self.inverse = inverse
        self.action = action.begun(start)
        self.start = start
        self.dt = dt
        self.action.check(start.at, start)
        self.grip = self.action.grip(start)
        self._always = (*always(inverse.rover, self.grip), *self.action.limits(start))
        self._contacts = rolling_contacts(self.grip.lifted)
        if not going_back:
            self._check_speeds()

    def command(self, at: Instant) -> Command:
        """What the action wants now."""
        return self.action.command(at, self.start, self.dt)

    def solve(self, at: Instant, command: Command, watches: Sequence[Limit] = ()) -> Solution:
        """The rates of a cycle."""
        limits = (*self._always, *self._contacts, *watches)
        return self.inverse.solve(at, command.tasks, limits, dt=self.dt)

    def finished(self, at: Instant) -> bool:
        """Whether the action has reached its end."""
        return self.action.left(at, self.start) <= CLOSE

    @property
    def grip_after(self) -> Grip:
        """Clutches and lifted wheels once it is finished."""
        return self.action.grip_after(self.start)

    def undo(self, now: Start) -> Action:
        """The action that goes back."""
        return self.action.undone(self.start, now)

    def _check_speeds(self) -> None:
        """The first cycle without speed limits: what it asks of every joint must be within its speed."""
        rover = self.inverse.rover
        command = self.command(self.start.at)
        free = [limit for limit in self._always if not isinstance(limit, SpeedLimits)]
        limits = (*free, *self._contacts)
        found = self.inverse.solve(self.start.at, command.tasks, limits, dt=self.dt)
        if not found.solved:
            return  # the first cycle will say why
        speeds: Array = np.abs(found.velocity)
        over = np.flatnonzero(speeds > np.asarray(rover.velocity) * (1.0 + BEYOND))
        driven = [int(i) for i in over if rover.dof_names[int(i)] in rover.actuated]
        if driven:
            worst = max(driven, key=lambda i: float(speeds[i] / rover.velocity[i]))
            raise InputError(
                f"{self.action.name} asks for more speed than the joint has",
                element=rover.dof_names[worst],
                value=f"{speeds[worst]:.3g}",
                cure=f"its limit is {rover.velocity[worst]:.3g}; command a lower speed",
            )


def always(rover: Rover, grip: Grip) -> tuple[Limit | Box, ...]:
    """What holds whatever is done, but for contacts; what the rover does not have is left out."""
    limits: list[Limit | Box] = [JointLimits(), SpeedLimits()]
    if rover.couplings:
        limits.append(CouplingsKept())
    if rover.loops:
        limits.append(LoopsClosed())
    if grip.clutches:
        limits.append(Clutch(grip.clutches))
    return tuple(limits)
