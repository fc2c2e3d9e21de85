"""One control cycle after the other: the model, the action's command, the projection, the supervisor."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.control.actions import CLOSE, Grip, Start
from rover_pin.control.execution import Execution
from rover_pin.control.layout import Layout
from rover_pin.control.modes import Mode, refuse_start
from rover_pin.control.motion_constraints import MotionConstraint
from rover_pin.control.now import Now
from rover_pin.control.projection import Look, Projection, Watch
from rover_pin.control.supervisor import AT_REST, Order, State, Supervisor
from rover_pin.control.threshold import Reading, Threshold
from rover_pin.errors import InputError, nearest
from rover_pin.kinematics.finite import not_finite
from rover_pin.kinematics.instant import Instant
from rover_pin.kinematics.inverse import InverseKinematics
from rover_pin.kinematics.solution import Solution
from rover_pin.kinematics.steering import Twist
from rover_pin.numerics import Array, frozen

if TYPE_CHECKING:
    from rover_pin.rover import Rover
    from rover_pin.terrain import Terrain


STUCK = 5.0
"""s without way after which an action is stuck: a wheel stands before a step that no row forbids."""


@dataclass(frozen=True)
class Cycle:
    """What a cycle came to.

    Attributes:
        order: the supervisor's; it holds for the next cycle.
        action: name of what was done, empty at a standstill.
        velocity: (nv,) dq/dt commanded, columns named by `Rover.dof_names`; zeros at a standstill.
        grip: clutches and lifted wheels while it is done.
        look: motion constraints with this velocity, None at a standstill.
        solution: of the projection, where one was asked for.
    """

    order: Order
    action: str
    velocity: Array
    grip: Grip
    look: Look | None = None
    solution: Solution | None = None

    @property
    def readings(self) -> Mapping[str, Reading]:
        """Motion constraints by name."""
        return {} if self.look is None else self.look.readings


class Controller:
    """Runs modes, cycle by cycle, on measured configurations.

    Args:
        rover: what moves.
        terrain: on what.
        layout: its sides.
        constraints: motion constraints by name.
        thresholds: by mode, then by name of constraint.
        supervisor: decides when a constraint is reached.
        dt: s a cycle.
        gamma: see `Projection`.

    Raises:
        InputError: a layout that is not the rover's, or a dt that is not above 0.
    """

    def __init__(
        self,
        rover: Rover,
        terrain: Terrain,
        layout: Layout,
        constraints: Mapping[str, MotionConstraint],
        thresholds: Mapping[str, Mapping[str, Threshold]],
        supervisor: Supervisor,
        *,
        dt: float = 0.01,
        gamma: float = 5.0,
    ) -> None:
        if not (math.isfinite(dt) and dt > 0.0):
            raise InputError("must be above 0 s", element="dt", value=dt)
        self.rover = rover
        self.layout = layout.checked(rover)
        self.inverse = InverseKinematics(rover, terrain)
        self.constraints = dict(constraints)
        self.thresholds = thresholds
        self.supervisor = supervisor
        self.dt = dt
        self.gamma = gamma
        self.grip = Grip()
        self._still = frozen(np.zeros(rover.model.nv))
        self._mode: Mode | None = None
        self._projection = Projection({}, {}, gamma)
        self._execution: Execution | None = None
        self._doing: tuple[State, int] | None = None
        self._begun: dict[int, Execution] = {}
        self._least, self._waited = math.inf, 0

    def begin(self, mode: Mode, q: Array) -> Order:
        """Start a mode from a measured configuration (nv,).

        Raises:
            InputError: a posture that the mode cannot start in, no thresholds for it, another mode still
                under way, or a configuration with an entry that is not finite.
        """
        at = self.inverse.at(np.asarray(q, dtype=np.float64))
        if mode.name not in self.thresholds:
            raise InputError(
                "has no thresholds", element=f"mode {mode.name}", cure=nearest(mode.name, self.thresholds)
            )
        projection = Projection(self.constraints, self.thresholds[mode.name], self.gamma)
        refuse_start(mode, self.layout, at, Start(at, self.grip, self._still))
        order = self.supervisor.begin(mode.name, mode.words)
        self._mode, self._projection = mode, projection
        self._execution, self._doing, self._begun = None, None, {}
        return order

    def cycle(
        self, where: Array | Instant, *, rates: Array | None = None, loads: Mapping[str, float] | None = None
    ) -> Cycle:
        """What to do for the next dt.

        Args:
            where: (nv,) measured configuration, or the instant that was made of it.
            rates: (nv,) measured dq/dt, or None: a standstill between actions.
            loads: measured loads of wheels [N], or None.
        """
        fault = self._fault(where, rates, loads)
        if fault:
            return self._rest(self.supervisor.report(fault=fault))
        at = self.inverse.at(where)
        order = self.supervisor.order
        if order.action is None or order.state in AT_REST:
            return self._rest(self.supervisor.report())
        if self._doing != (order.state, order.action):
            refusal = self._take_up(order, at, self._still if rates is None else np.asarray(rates))
            if refusal:
                return self._rest(self.supervisor.report(fault=refusal))
        execution = self._execution
        if execution is None:
            return self._rest(order)
        if execution.finished(at):
            self.grip = execution.grip_after
            return self._rest(self.supervisor.report(finished=True), execution.action.name)
        try:
            return self._move(execution, at, loads)
        except InputError as error:  # the edge of the map, a wheel that can be steered no further
            return self._rest(self.supervisor.report(fault=str(error)))

    def _move(self, execution: Execution, at: Instant, loads: Mapping[str, float] | None) -> Cycle:
        before = self.supervisor.order.state
        command = execution.command(at)
        watch = self._watch(execution, at, command.nominal, loads)
        solution = execution.solve(at, command, (watch,))
        name = execution.action.name
        if not solution.solved:
            order = self.supervisor.report(infeasible=solution.reason)
            return Cycle(order, name, self._still, execution.grip, watch.look(self._still), solution)
        look = watch.look(solution.velocity)
        stuck = "" if look.crossed else self._stuck(execution, at)
        order = self.supervisor.report(crossed=look.crossed, infeasible=stuck)
        # Where a second reminder turns the way, what was solved still leads forward.
        velocity = solution.velocity if order.state is before else self._still
        return Cycle(order, name, velocity, execution.grip, look, solution)

    def _stuck(self, execution: Execution, at: Instant) -> str:
        """In words, where an action has made no way for a while though its programs are solved."""
        left = execution.action.left(at, execution.start)
        if left < self._least - 1e-2 * CLOSE:
            self._least, self._waited = left, 0
            return ""
        self._waited += 1
        if self._waited * self.dt < STUCK:
            return ""
        self._waited = 0
        return f"{execution.action.name} makes no way any more, {left:.4g} is left"

    def _watch(
        self,
        execution: Execution,
        at: Instant,
        nominal: Mapping[str, float],
        loads: Mapping[str, float] | None,
    ) -> Watch:
        wanted = Twist(**nominal).velocity(at) if nominal else self._still
        grip = execution.grip
        now = Now(at, self._still, wanted, grip.lifted, loads, tuple(grip.clutches))
        return self._projection.watch(now)

    def _take_up(self, order: Order, at: Instant, rates: Array) -> str:
        """Begin the action that is ordered, or its undoing; a refusal in words."""
        place = order.action
        if self._mode is None or place is None:
            return "no mode was begun"
        start = Start(at, self.grip, rates)
        undoing = order.state is State.ROLLING_BACK
        try:
            if undoing and place not in self._begun:
                self._execution = None
                self.supervisor.report(finished=True)
                return ""
            action = self._begun[place].undo(start) if undoing else self._mode.actions[place]
            self._execution = Execution(self.inverse, action, start, self.dt, going_back=undoing)
        except InputError as error:
            self._execution = None
            return str(error)
        if not undoing:
            self._begun[place] = self._execution
        self.grip = self._execution.grip
        self._least, self._waited = math.inf, 0
        self._doing = order.state, place
        return ""

    def _rest(self, order: Order, action: str = "") -> Cycle:
        return Cycle(order, action, self._still, self.grip)

    def _fault(self, where: Array | Instant, rates: Array | None, loads: Mapping[str, float] | None) -> str:
        """What a sensor tells that cannot be; an instant has been looked at when it was made."""
        for word, values in (("place", where), ("rate", rates)):
            if values is None or isinstance(values, Instant):
                continue
            numbers = np.asarray(values, dtype=np.float64)
            if numbers.shape != self._still.shape:
                return f"{numbers.size} numbers for the {word}s of {self._still.size} coordinates"
            bad = not_finite(numbers)
            if bad is not None:
                return f"the sensor of {self.rover.dof_names[bad]} tells {numbers[bad]} for its {word}"
        for wheel, load in (loads or {}).items():
            if not math.isfinite(load):
                return f"the load sensor of {wheel} tells {load}"
        return ""
