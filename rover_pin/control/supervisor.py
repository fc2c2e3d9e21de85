"""Who decides when a motion constraint is reached: halt, remind the operator, go on, or roll back.

Rules of the HIT-MRII paper, section 7: a threshold reached, or a projection that is infeasible, halts the
motion and reminds the operator. An answer ends the action under way and runs the next. No answer in time
rolls the mode's actions back, the last first, to where it began; so does a second reminder within one mode,
at once. The count of reminders starts anew with every mode.

Beyond the paper:
- A fault (a sensor, a refusal, a clock that runs back) holds the rover where it is, whatever it was doing.
- An action that was interrupted is undone too, first of all; how far it had come is its executor's business.
- "Where it began" is where the current mode began: modes that are done stay done.
- The rollback is the last word: what is reached on the way back is noted and reminds nobody. A projection
  that is infeasible on the way back holds, as there is nowhere left to go.
- An answer counts if it is given before the deadline, not at it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import Enum

from rover_pin.errors import InputError

MOST_REMINDERS = 2
"""The reminder at which a mode is rolled back without waiting."""


class State(str, Enum):
    """What the supervisor does."""

    RUNNING = "running"
    HALTED = "halted"
    ROLLING_BACK = "rolling back"
    DONE = "done"
    RETURNED = "returned"
    HELD = "held"

    def __str__(self) -> str:
        """The word used in traces."""
        return self.value


AT_REST = (State.DONE, State.RETURNED, State.HELD)
"""States that a mode ends in."""


@dataclass(frozen=True)
class Order:
    """What to do until the next report.

    Attributes:
        state: of the supervisor.
        action: place of the action to run (`running`) or to undo (`rolling back`), None where nothing moves.
        reason: in words, where it is not plain running.
    """

    state: State
    action: int | None = None
    reason: str = ""


@dataclass(frozen=True)
class Reminder:
    """What the operator is told.

    Attributes:
        mode: name of the mode.
        action: name of the action under way.
        reason: what was reached, or which rows fight.
        count: of reminders in this mode, 1 first.
        deadline: on the supervisor's clock [s].
    """

    mode: str
    action: str
    reason: str
    count: int
    deadline: float


@dataclass(frozen=True)
class Event:
    """A line of the trace.

    Attributes:
        time: on the supervisor's clock [s]; NaN where it has told none yet.
        mode: name of the mode.
        state: entered or kept.
        action: name of the action concerned, empty where there is none.
        reason: in words.
    """

    time: float
    mode: str
    state: State
    action: str
    reason: str


class Supervisor:
    """A state machine over the actions of a mode; it moves nothing itself.

    Args:
        clock: tells the time [s]; it does not run back.
        operator: is told a reminder when it is made and at every report until the deadline, and says whether
            there is an answer. The rover halts for one report at least. Of a second reminder in a mode the
            operator is told once, and not asked: the rollback is ordered already.
        patience: s that an answer may take.

    Attributes:
        trace: what happened, in order.

    Raises:
        InputError: a patience that is not a finite number above 0.
    """

    def __init__(
        self, clock: Callable[[], float], operator: Callable[[Reminder], bool], patience: float
    ) -> None:
        if not (math.isfinite(patience) and patience > 0.0):
            raise InputError("must be a finite number of seconds above 0", element="patience", value=patience)
        self._clock = clock
        self._operator = operator
        self._patience = patience
        self._time = math.nan
        self.trace: list[Event] = []
        self._mode = ""
        self._actions: tuple[str, ...] = ()
        self._done: list[int] = []
        self._reminders = 0
        self._reminder: Reminder | None = None
        self._answered = False
        self._noted = ""
        self._order = Order(State.DONE)

    @property
    def order(self) -> Order:
        """What was ordered last."""
        return self._order

    def begin(self, mode: str, actions: Sequence[str]) -> Order:
        """Start a mode: its first action, no reminders yet.

        It may be begun from `held` as well: whoever begins it says that the rover may move again.

        Args:
            mode: its name.
            actions: names of its actions, in order.

        Raises:
            InputError: no actions, one word in place of a list, or another mode still under way.
        """
        _refuse_word(mode, actions)
        if not actions:
            raise InputError("has no actions", element=mode)
        if self._order.state not in AT_REST:
            raise InputError("cannot begin", element=mode, cure=f"{self._mode} is still {self._order.state}")
        self._mode, self._actions = mode, tuple(actions)
        self._done, self._reminders, self._reminder, self._answered = [], 0, None, False
        fault = self._look_at_clock()
        if fault:
            return self._enter(State.HELD, None, fault)
        return self._run(0, "begins")

    def report(
        self,
        *,
        crossed: Sequence[str] = (),
        infeasible: str = "",
        finished: bool = False,
        fault: str = "",
    ) -> Order:
        """Tell what a cycle came to, and hear what to do next.

        Args:
            crossed: motion constraints that have reached their thresholds.
            infeasible: which rows of the projection fight, empty where it was solved.
            finished: whether the action to run or undo has reached its end.
            fault: what is wrong with the rover or its sensors, empty where nothing is. It goes before all
                else, and holds a rover whose mode has ended too.

        Raises:
            InputError: one word in place of a list.
        """
        _refuse_word("crossed", crossed)
        if self._order.state is State.HELD or (self._order.state in AT_REST and not fault):
            return self._order
        time_fault = self._look_at_clock()
        if fault or time_fault:
            return self._enter(State.HELD, None, fault or time_fault)
        if self._order.state is State.HALTED:
            return self._while_halted()
        reason = infeasible or ", ".join(crossed)
        if self._order.state is State.ROLLING_BACK:
            return self._while_rolling_back(infeasible, reason, finished)
        return self._while_running(reason, finished)

    def _while_running(self, reason: str, finished: bool) -> Order:
        if reason:
            return self._remind(reason)
        if not finished:
            return self._order
        return self._next("finished")

    def _while_halted(self) -> Order:
        if not self._answered:
            if self._reminder is None or self._time >= self._reminder.deadline:
                return self._undo_last("no answer in time")
            self._ask(self._reminder)
        return self._next("answered") if self._answered else self._order

    def _ask(self, reminder: Reminder) -> None:
        """Tell the operator and hear the answer; the operator may take time, so the clock is read again."""
        answer = self._operator(reminder)
        fault = self._look_at_clock()
        if fault:
            self._enter(State.HELD, None, fault)
        elif answer and self._time >= reminder.deadline:
            self._undo_last("the answer came too late")
        else:
            self._answered = bool(answer)

    def _while_rolling_back(self, infeasible: str, reason: str, finished: bool) -> Order:
        if infeasible:
            return self._enter(State.HELD, None, f"cannot roll back: {infeasible}")
        if reason and reason != self._noted:
            self._note(self._order.action, f"reached while rolling back: {reason}")
        self._noted = reason
        if not finished:
            return self._order
        return self._undo_last("undone")

    def _remind(self, reason: str) -> Order:
        self._reminders += 1
        last = self._reminders >= MOST_REMINDERS
        place = self._order.action
        action = "" if place is None else self._actions[place]
        deadline = self._time if last else self._time + self._patience
        self._reminder = Reminder(self._mode, action, reason, self._reminders, deadline)
        if last:
            order = self._undo_last(f"reminder {self._reminders} within one mode: {reason}")
            self._operator(self._reminder)
            return order
        self._answered = False
        self._order = Order(State.HALTED, None, reason)
        self._note(place, reason)
        self._ask(self._reminder)
        return self._order

    def _next(self, reason: str) -> Order:
        following = self._done[-1] + 1
        if following < len(self._actions):
            return self._run(following, reason)
        return self._enter(State.DONE, None, reason)

    def _run(self, place: int, reason: str) -> Order:
        self._done.append(place)
        return self._enter(State.RUNNING, place, reason)

    def _undo_last(self, reason: str) -> Order:
        """The last action that was begun, finished or not; then the one before."""
        if not self._done:
            return self._enter(State.RETURNED, None, reason)
        return self._enter(State.ROLLING_BACK, self._done.pop(), reason)

    def _enter(self, state: State, place: int | None, reason: str) -> Order:
        self._order = Order(state, place, reason)
        self._noted = ""
        self._note(place, reason)
        return self._order

    def _note(self, place: int | None, reason: str) -> None:
        action = "" if place is None else self._actions[place]
        self.trace.append(Event(self._time, self._mode, self._order.state, action, reason))

    def _look_at_clock(self) -> str:
        """Read the clock; what is wrong with it, where something is."""
        now = self._clock()
        if not math.isfinite(now):
            return f"the clock tells {now}"
        if now < self._time:
            return f"the clock ran back from {self._time:g} to {now:g} s"
        self._time = now
        return ""


def _refuse_word(element: str, names: Sequence[str]) -> None:
    if isinstance(names, str):
        raise InputError("must be a list of names", element=element, value=names, cure=f"give [{names!r}]")
