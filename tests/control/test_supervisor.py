"""The paper's rules as traces, word for word, and what must hold whatever is reported."""

import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule

from rover_pin.control.supervisor import AT_REST, State, Supervisor
from rover_pin.errors import InputError

ACTIONS = ("raise", "roll", "lower")


class Bench:
    """A supervisor on a clock of its own, and an operator who answers when told to."""

    def __init__(self, patience=10.0):
        self.now = 0.0
        self.answers = False
        self.told = []
        self.supervisor = Supervisor(lambda: self.now, self._operator, patience)

    def _operator(self, reminder):
        self.told.append((reminder.action, reminder.reason, reminder.count, reminder.deadline))
        return self.answers

    def report(self, after=1.0, **told):
        self.now += after
        return self.supervisor.report(**told)

    @property
    def trace(self):
        return [(e.time, str(e.state), e.action, e.reason) for e in self.supervisor.trace]


def begun(**options):
    bench = Bench(**options)
    bench.supervisor.begin("chassis_lifting", ACTIONS)
    return bench


def test_a_mode_that_goes_through():
    bench = begun()
    for _ in range(3):
        assert bench.report().state is State.RUNNING
        bench.report(finished=True)
    assert bench.trace == [
        (0.0, "running", "raise", "begins"),
        (2.0, "running", "roll", "finished"),
        (4.0, "running", "lower", "finished"),
        (6.0, "done", "", "finished"),
    ]
    assert bench.told == []


def test_an_answer_ends_the_action_and_runs_the_next():
    bench = begun()
    assert bench.report(crossed=["wheelbase"]).state is State.HALTED
    assert bench.report().action is None
    bench.answers = True
    assert bench.report().action == 1
    assert bench.trace == [
        (0.0, "running", "raise", "begins"),
        (1.0, "halted", "raise", "wheelbase"),
        (3.0, "running", "roll", "answered"),
    ]
    assert bench.told == [("raise", "wheelbase", 1, 11.0)] * 2


def test_no_answer_in_time_rolls_back():
    bench = begun()
    bench.report(finished=True)
    bench.report(crossed=["height", "length"])
    bench.report(after=9.0)
    bench.report(after=1.0)
    bench.report()
    bench.report(finished=True)
    bench.report(finished=True)
    assert bench.trace == [
        (0.0, "running", "raise", "begins"),
        (1.0, "running", "roll", "finished"),
        (2.0, "halted", "roll", "height, length"),
        (12.0, "rolling back", "roll", "no answer in time"),
        (14.0, "rolling back", "raise", "undone"),
        (15.0, "returned", "", "undone"),
    ]


def test_an_answer_after_the_deadline_does_not_count():
    bench = begun()
    bench.report(crossed=["height"])
    bench.answers = True
    assert bench.report(after=10.0).state is State.ROLLING_BACK
    assert bench.trace[-1] == (11.0, "rolling back", "raise", "no answer in time")


def test_an_operator_who_is_slow_to_answer():
    bench = begun()
    bench.report(crossed=["height"])

    def slow(reminder):
        bench.now += 20.0
        return True

    bench.supervisor._operator = slow
    assert bench.report().state is State.ROLLING_BACK
    assert bench.trace[-1] == (22.0, "rolling back", "raise", "the answer came too late")


def test_a_second_reminder_within_one_mode_forces_the_rollback():
    bench = begun()
    bench.report(crossed=["wheelbase"])
    bench.answers = True
    bench.report()
    bench.report(infeasible="these cannot hold together: a; b")
    assert bench.trace[2:] == [
        (2.0, "running", "roll", "answered"),
        (3.0, "rolling back", "roll", "reminder 2 within one mode: these cannot hold together: a; b"),
    ]
    assert len(bench.told) == 1


def test_the_count_starts_anew_with_every_mode():
    bench = begun()
    bench.report(crossed=["wheelbase"])
    bench.answers = True
    bench.report()
    bench.report(finished=True)
    assert bench.report(finished=True).state is State.DONE
    bench.supervisor.begin("rolling", ["roll"])
    assert bench.report(crossed=["wheelbase"]).state is State.HALTED
    assert [event.mode for event in bench.supervisor.trace][-2:] == ["rolling", "rolling"]


def test_the_last_action_answered_is_done():
    bench = Bench()
    bench.supervisor.begin("rolling", ["roll"])
    bench.report(crossed=["height"])
    bench.answers = True
    assert bench.report().state is State.DONE


def test_crossings_while_rolling_back_are_told_only():
    bench = begun()
    bench.report(crossed=["height"])
    bench.report(after=10.0)
    assert bench.report(crossed=["height"]).state is State.ROLLING_BACK
    assert bench.trace[-1] == (12.0, "rolling back", "raise", "reached while rolling back: height")
    assert bench.report(infeasible="a; b").state is State.HELD
    assert bench.trace[-1] == (13.0, "held", "", "cannot roll back: a; b")


@pytest.mark.parametrize("before", [{}, {"crossed": ["height"]}])
def test_a_fault_holds(before):
    bench = begun()
    bench.report(**before)
    assert bench.report(fault="the sensor of L_act tells nan for its place").state is State.HELD
    assert bench.trace[-1][1:] == ("held", "", "the sensor of L_act tells nan for its place")
    assert bench.report(finished=True).state is State.HELD


@pytest.mark.parametrize(("time", "words"), [(float("nan"), "the clock tells nan"),
                                             (-1.0, "the clock ran back from 1 to -1 s")])  # fmt: skip
def test_a_clock_that_cannot_be(time, words):
    bench = begun()
    bench.report()
    bench.now = time
    assert bench.report(after=0.0).state is State.HELD
    assert bench.trace[-1][3] == words


def test_refusals():
    bench = begun()
    with pytest.raises(InputError, match="rolling: cannot begin; chassis_lifting is still running"):
        bench.supervisor.begin("rolling", ["roll"])
    with pytest.raises(InputError, match="rolling: has no actions"):
        Bench().supervisor.begin("rolling", [])
    with pytest.raises(InputError, match="patience: must be a finite number of seconds above 0"):
        Supervisor(lambda: 0.0, lambda _: False, 0.0)


class AnyStory(RuleBasedStateMachine):
    """Whatever happens: no motion while halted, two reminders at most, back in reverse order, an end."""

    def __init__(self):
        super().__init__()
        self.bench = begun(patience=5.0)
        self.reminders = 0

    def _tell(self, **told):
        before = self.bench.supervisor.order.state
        self.bench.report(after=self.wait, **told)
        if before is State.RUNNING and (told.get("crossed") or told.get("infeasible")):
            self.reminders += 1

    wait = 1.0

    @rule(wait=st.floats(0.0, 6.0))
    def goes_on(self, wait):
        self.wait = wait
        self._tell()

    @rule()
    def finishes(self):
        self._tell(finished=True)

    @rule()
    def crosses(self):
        self._tell(crossed=["height"])

    @rule(answers=st.booleans())
    def operator(self, answers):
        self.bench.answers = answers

    @invariant()
    def two_reminders_at_most(self):
        assert self.reminders <= 2
        assert {told[2] for told in self.bench.told} <= {1}

    @invariant()
    def nothing_moves_at_rest(self):
        order = self.bench.supervisor.order
        moves = order.state in (State.RUNNING, State.ROLLING_BACK)
        assert (order.action is not None) == moves

    @invariant()
    def back_the_way_it_came(self):
        events = self.bench.supervisor.trace
        went = [e.action for e in events if e.state is State.RUNNING]
        back = [e.action for e in events if e.state is State.ROLLING_BACK and "reached" not in e.reason]
        assert back == went[::-1][: len(back)]
        if self.bench.supervisor.order.state is State.RETURNED:
            assert len(back) == len(went)

    @invariant()
    def an_end_is_an_end(self):
        states = [event.state for event in self.bench.supervisor.trace]
        assert not any(state in AT_REST for state in states[:-1])


AnyStory.TestCase.settings = settings(max_examples=60, stateful_step_count=25, deadline=None)
TestAnyStory = AnyStory.TestCase
