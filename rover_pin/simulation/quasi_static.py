"""A controller's modes on a rover that follows exactly, and at times the statics of where it stands.

Kinematic: commanded rates are what the rover does, its passive joints and base by the rows of its contacts.
Quasi-static: at every sample the rover is set down anew by `settle` at the same place with the same driven
joints and clutches, which knows nothing of the motion; where it comes to rest and what its wheels carry is
logged, and given back to the controller as what its load sensors tell.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.control.actions import Grip
from rover_pin.control.controller import Controller, Cycle
from rover_pin.control.layout import Layout
from rover_pin.control.modes import Mode
from rover_pin.control.motion_constraints import MotionConstraint, motion_constraints
from rover_pin.control.standing import held_joints, place_of
from rover_pin.control.supervisor import AT_REST, Reminder, State, Supervisor
from rover_pin.control.threshold import Threshold
from rover_pin.errors import InputError
from rover_pin.kinematics.advance import Sliding, advance
from rover_pin.kinematics.instant import Instant
from rover_pin.numerics import Array
from rover_pin.simulation.log import Log
from rover_pin.simulation.run import Run
from rover_pin.statics.settle import settle

if TYPE_CHECKING:
    from rover_pin.rover import Rover
    from rover_pin.statics.stance import Stance
    from rover_pin.terrain import Terrain


ELSEWHERE = 1e-3
"""m: a wheel that the statics have this far from where the motion has it."""

STEADY = 0.05
"""Share of its size by which a velocity changes from cycle to cycle where it goes on smoothly."""


def nobody(_: Reminder) -> bool:
    """An operator who never answers."""
    return False


@dataclass(frozen=True)
class Setting:
    """What a simulation needs besides the rover and the ground.

    Attributes:
        layout: the rover's sides.
        thresholds: by mode, then by name of motion constraint.
        constraints: motion constraints by name; all where silent.
        operator: answers reminders.
        patience: s that an answer may take.
        dt: s a cycle.
        every: s between samples.
        longest: s after which a run ends as `too long`.
    """

    layout: Layout
    thresholds: Mapping[str, Mapping[str, Threshold]]
    constraints: Mapping[str, MotionConstraint] | None = None
    operator: Callable[[Reminder], bool] = nobody
    patience: float = 10.0
    dt: float = 0.01
    every: float = 0.25
    longest: float = 3600.0


class Clock:
    """Simulated time [s]."""

    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        """The time now."""
        return self.now


def simulate(
    rover: Rover, terrain: Terrain, start: Stance, modes: Sequence[Mode], setting: Setting
) -> tuple[Run, Supervisor]:
    """Run modes one after the other from a stance.

    Args:
        rover: what moves.
        terrain: on what.
        start: where it stands.
        modes: in order; the next begins where the one before is done.
        setting: sides, thresholds, operator, steps.

    Returns:
        The log, and the supervisor with its trace. The run's status is the supervisor's last state: `done`,
        `returned`, `held`; `refused` where a mode could not begin; `too long`.

    Raises:
        InputError: a stance that is not settled, no modes, a mode without thresholds.
    """
    if not start.settled:
        raise InputError("must be settled", element="start", value=f"{start.status}: {start.reason}")
    if not modes:
        raise InputError("none are given", element="modes", cure="give at least one mode")
    simulation = _Simulation(rover, terrain, start, setting)
    for mode in modes:
        simulation.run(mode)
        if simulation.status != str(State.DONE):
            break
    return simulation.log.run(simulation.status, simulation.reason), simulation.supervisor


class _Simulation:
    """One simulation under way."""

    def __init__(self, rover: Rover, terrain: Terrain, start: Stance, setting: Setting) -> None:
        constraints = setting.constraints or motion_constraints(rover, setting.layout)
        self.clock = Clock()
        self.supervisor = Supervisor(self.clock, setting.operator, setting.patience)
        self.controller = Controller(
            rover, terrain, setting.layout, constraints, setting.thresholds, self.supervisor, dt=setting.dt
        )
        self.rover, self.terrain, self.setting = rover, terrain, setting
        self.at: Instant = self.controller.inverse.at(start)
        self.sliding = Sliding(self.at)
        self.log = Log(rover, terrain, constraints)
        self.loads: Mapping[str, float] | None = dict(start.loads)
        self.status, self.reason = str(State.DONE), ""
        self._steps = 0
        self._before: Array = np.zeros(rover.model.nv)
        self._between = max(1, round(setting.every / setting.dt))

    def run(self, mode: Mode) -> None:
        """One mode to its end."""
        try:
            self.controller.begin(mode, self.at.q)
        except InputError as error:
            self.status, self.reason = "refused", str(error)
            self._sample(mode.name, None)
            return
        last = ""
        while self.supervisor.order.state not in AT_REST:
            if self.clock.now > self.setting.longest:
                self.status, self.reason = "too long", f"longer than {self.setting.longest:g} s"
                return
            cycle = self.controller.cycle(self.at, loads=self.loads)
            changed = bool(cycle.action) and cycle.action != last
            if self._steps % self._between == 0 or changed:
                self._sample(cycle.action or last or mode.name, cycle)
            last = cycle.action or last
            self._advance(cycle)
        order = self.supervisor.order
        self.status, self.reason = str(order.state), order.reason
        self._sample(last or mode.name, None)

    def _advance(self, cycle: Cycle) -> None:
        velocity = cycle.velocity
        if np.any(velocity):
            self.at = advance(self.at, _onward(velocity, self._before, self.setting.dt), self.setting.dt)
            self.sliding.step(self.at, cycle.grip.lifted)
        self._before = velocity
        self._steps += 1
        self.clock.now = self._steps * self.setting.dt

    def _sample(self, action: str, cycle: Cycle | None) -> None:
        grip = self.controller.grip
        stance = set_down(self.at, grip)
        self.loads = dict(stance.loads) if stance.settled else None
        self.log.add(self.clock.now, self.at, action, grip, stance, cycle, self.sliding)
        fault = self._unlike(stance, grip)
        if fault:
            self.supervisor.report(fault=fault)

    def _unlike(self, stance: Stance, grip: Grip) -> str:
        """In words, where the statics do not have the rover stand as the motion has it."""
        if not stance.settled:
            return f"does not stand: {stance.status}, {stance.reason}"
        for name, gap in stance.gaps.items():
            if (gap > ELSEWHERE) and name not in grip.lifted:
                return f"{name} would leave the ground by {1e3 * gap:.2g} mm: it would have to be held down"
        for name in grip.lifted:
            if stance.loads[name] > 0.0 and float(self.at.contacts[self.at.index([name])[0], 0]) > ELSEWHERE:
                return f"{name} would not leave the ground and carries {stance.loads[name]:.3g} N"
        return ""


def _onward(velocity: Array, before: Array, dt: float) -> Array:
    """The mean rate of a step whose rates go on changing as they did (Adams and Bashforth, second order).

    The base's own turning is left to `advance`. Where a command sets in or ends the rates jump and stay what
    they are.
    """
    turned = float(before[3]) * dt
    c, s = math.cos(turned), math.sin(turned)
    change = velocity - before
    change[0] = velocity[0] - (c * before[0] - s * before[1])
    change[1] = velocity[1] - (s * before[0] + c * before[1])
    if float(np.max(np.abs(change))) > STEADY * float(np.max(np.abs(velocity))):
        return velocity
    onward: Array = velocity + 0.5 * change
    return onward


def set_down(at: Instant, grip: Grip) -> Stance:
    """The rover set down anew at the same place with the same driven joints and clutches.

    Args:
        at: where it is in its motion.
        grip: engaged clutches.
    """
    x, y, yaw = place_of(at)
    return settle(at.rover, at.bodies.terrain, x=x, y=y, yaw=yaw, joints=held_joints(at, grip))
