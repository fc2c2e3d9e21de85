"""What must hold whatever is reported, in whatever order: hypothesis tells the stories."""

import math
import re

from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule
from supervised import ACTIONS, begun

from rover_pin.control.supervisor import AT_REST, State

LETTERS = {"running": "R", "halted": "H", "rolling back": "B", "done": "D", "returned": "T", "held": "X"}

STORY = re.compile(r"R{1,3}(DX?|X|HR{0,2}(DX?|X|Bb*(Bb*){0,2}(TX?|X)?)?)?")
"""One mode: it runs; done, held, or halted once, and goes on to any end; a rollback, once begun, never stops
but at its end or held. A second reminder is B without a second H."""

WAITS = st.sampled_from([0.0, 0.5, 1.0, 4.0, 5.0, 6.0])


class AnyStory(RuleBasedStateMachine):
    """A mode of three actions, and everything that can be told of it."""

    def __init__(self):
        super().__init__()
        self.bench = begun(patience=5.0)
        self.began = 0
        self.reminded = 0

    @property
    def events(self):
        return self.bench.supervisor.trace[self.began :]

    def tell(self, wait, **told):
        before = self.bench.supervisor.order
        asked = len(self.bench.told)
        halted_at = self.events[-1].time if before.state is State.HALTED else math.nan
        order = self.bench.report(after=wait, **told)
        if before.state is State.RUNNING and (told.get("crossed") or told.get("infeasible")):
            self.reminded += 1
            assert len(self.bench.told) == asked + 1
            assert order.action != before.action or order.state is not State.RUNNING
        if before.state is State.HALTED and order.state is State.RUNNING:
            assert self.bench.told[-1][2] == 1
            assert order.reason == "answered"
        if before.state is State.HALTED and self.bench.now < halted_at + 5.0:
            assert order.state is not State.ROLLING_BACK
        if before.state in AT_REST:
            assert order == before

    @rule(wait=WAITS)
    def goes_on(self, wait):
        self.tell(wait)

    @rule(wait=WAITS)
    def finishes(self, wait):
        self.tell(wait, finished=True)

    @rule(wait=WAITS, finished=st.booleans())
    def crosses(self, wait, finished):
        self.tell(wait, crossed=["height"], finished=finished)

    @rule(wait=WAITS)
    def fights(self, wait):
        self.tell(wait, infeasible="a; b")

    @rule(answers=st.booleans(), thinks=st.sampled_from([0.0, 0.0, 3.0, 7.0]))
    def operator(self, answers, thinks):
        self.bench.answers, self.bench.thinks = answers, thinks

    @rule(pick=st.integers(0, 19))
    def fails(self, pick):
        if pick == 0:
            assert self.bench.report(fault="no power").state is State.HELD
        if pick == 1:
            now, self.bench.now = self.bench.now, self.bench.read - 1.0
            if self.bench.supervisor.order.state not in AT_REST:
                assert self.bench.report(after=0.0).state is State.HELD
            self.bench.now = now

    @rule()
    def begins_anew(self):
        if self.bench.supervisor.order.state in AT_REST:
            self.began, self.reminded = len(self.bench.supervisor.trace), 0
            self.bench.told.clear()
            self.bench.supervisor.begin("again", ACTIONS)

    @invariant()
    def two_reminders_at_most(self):
        assert self.reminded <= 2
        assert [count for *_, count, _ in self.bench.told if count == 2] == [2] * (self.reminded == 2)

    @invariant()
    def something_moves_only_where_it_may(self):
        order = self.bench.supervisor.order
        assert (order.action is not None) == (order.state in (State.RUNNING, State.ROLLING_BACK))

    @invariant()
    def the_story_is_one_of_the_papers(self):
        told = "".join(
            "b" if e.reason.startswith("reached while") else LETTERS[str(e.state)] for e in self.events
        )
        assert STORY.fullmatch(told), told

    @invariant()
    def forth_in_order_and_back_the_way_it_came(self):
        went = [e.action for e in self.events if e.state is State.RUNNING]
        back = [
            e.action
            for e in self.events
            if e.state is State.ROLLING_BACK and not e.reason.startswith("reached")
        ]
        assert went == list(ACTIONS[: len(went)])
        assert back == went[::-1][: len(back)]
        if State.RETURNED in [e.state for e in self.events]:
            assert len(back) == len(went)

    @invariant()
    def time_goes_on(self):
        times = [e.time for e in self.bench.supervisor.trace]
        assert times == sorted(times)

    def teardown(self):
        """However it stands, it comes to an end: actions finish, nobody answers, time passes."""
        self.bench.answers, self.bench.thinks = False, 0.0
        for _ in range(2 * len(ACTIONS) + 2):
            self.bench.report(after=6.0, finished=True)
        assert self.bench.supervisor.order.state in AT_REST


AnyStory.TestCase.settings = settings(max_examples=200, stateful_step_count=25, deadline=None)
TestAnyStory = AnyStory.TestCase
