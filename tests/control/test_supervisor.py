"""The paper's rules as traces, word for word."""

import dataclasses
import math

import pytest
from supervised import Bench, begun

from rover_pin.control.supervisor import State, Supervisor
from rover_pin.errors import InputError


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
    assert bench.told == [("raise", "wheelbase", 1, 11.0)] * 3


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


def test_the_operator_is_told_when_the_rover_halts():
    """Even where the next report comes after the deadline; an answer given by then counts."""
    bench = begun()
    bench.report(crossed=["height"])
    assert bench.told == [("raise", "height", 1, 11.0)]
    assert bench.report(after=60.0).reason == "no answer in time"
    prompt = begun()
    prompt.answers = True
    assert prompt.report(crossed=["height"]).state is State.HALTED
    prompt.answers = False
    assert prompt.report(after=60.0).action == 1
    assert prompt.trace[1:] == [(1.0, "halted", "raise", "height"), (61.0, "running", "roll", "answered")]


@pytest.mark.parametrize("asked_before", [False, True])
def test_an_operator_who_is_slow_to_answer(asked_before):
    bench = begun()
    if asked_before:
        bench.report(crossed=["height"])
    bench.answers, bench.thinks = True, 20.0
    told = {} if asked_before else {"crossed": ["height"]}
    assert bench.report(**told).state is State.ROLLING_BACK
    assert bench.trace[-1] == (bench.now, "rolling back", "raise", "the answer came too late")


@pytest.mark.parametrize("asked_before", [False, True])
@pytest.mark.parametrize("answers", [False, True])
@pytest.mark.parametrize(
    ("thinks", "words"), [(-0.5, "the clock ran back from "), (math.nan, "the clock tells nan")]
)
def test_a_clock_that_fails_while_the_operator_is_asked(asked_before, answers, thinks, words):
    """Nothing may be undone by a clock that cannot be: the rover is held."""
    bench = begun()
    if asked_before:
        bench.report(crossed=["height"])
    bench.answers, bench.thinks = answers, thinks
    order = bench.report(**({} if asked_before else {"crossed": ["height"]}))
    assert (order.state, order.action) == (State.HELD, None)
    assert bench.trace[-1][1:3] == ("held", "")
    assert bench.trace[-1][3].startswith(words)


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
    assert bench.told == [("raise", "wheelbase", 1, 11.0)] * 2 + [
        ("roll", "these cannot hold together: a; b", 2, 3.0)
    ]
    assert bench.report(finished=True).action == 0


def test_a_rollback_ends_where_the_mode_began():
    bench = begun()
    for _ in range(3):
        bench.report(finished=True)
    bench.supervisor.begin("rolling", ["out", "back"])
    bench.report(crossed=["height"])
    bench.report(after=10.0)
    assert bench.report(finished=True).state is State.RETURNED
    assert bench.trace[3:] == [
        (3.0, "done", "", "finished"),
        (3.0, "running", "out", "begins"),
        (4.0, "halted", "out", "height"),
        (14.0, "rolling back", "out", "no answer in time"),
        (15.0, "returned", "", "undone"),
    ]
    assert [event.mode for event in bench.supervisor.trace] == ["chassis_lifting"] * 4 + ["rolling"] * 4


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
    assert len(bench.told) == 1
    assert bench.report(infeasible="a; b").state is State.HELD
    assert bench.trace[-1] == (13.0, "held", "", "cannot roll back: a; b")


def test_what_lasts_while_rolling_back_is_told_once():
    bench = begun()
    bench.report(finished=True)
    bench.report(crossed=["height"])
    bench.report(after=10.0)
    for crossed in (["height"], ["height"], ["height", "length"], ["height", "length"], [], ["height"]):
        bench.report(crossed=crossed)
    bench.report(finished=True)
    bench.report(crossed=["height"])
    assert bench.trace[3:] == [
        (12.0, "rolling back", "roll", "no answer in time"),
        (13.0, "rolling back", "roll", "reached while rolling back: height"),
        (15.0, "rolling back", "roll", "reached while rolling back: height, length"),
        (18.0, "rolling back", "roll", "reached while rolling back: height"),
        (19.0, "rolling back", "raise", "undone"),
        (20.0, "rolling back", "raise", "reached while rolling back: height"),
    ]


@pytest.mark.parametrize("before", [{}, {"crossed": ["height"]}])
def test_a_fault_holds(before):
    bench = begun()
    bench.report(**before)
    assert bench.report(fault="the sensor of L_act tells nan for its place").state is State.HELD
    assert bench.trace[-1][1:] == ("held", "", "the sensor of L_act tells nan for its place")
    assert bench.report(finished=True).state is State.HELD
    assert bench.report(fault="another").reason == "the sensor of L_act tells nan for its place"


def test_a_fault_goes_before_all_else():
    bench = begun()
    order = bench.report(crossed=["height"], infeasible="a; b", finished=True, fault="no power")
    assert (order.state, order.reason) == (State.HELD, "no power")
    assert bench.told == []


def test_a_fault_while_rolling_back():
    bench = begun()
    bench.report(crossed=["height"])
    bench.report(after=10.0)
    assert bench.report(fault="no power", finished=True).state is State.HELD
    assert bench.trace[-1] == (12.0, "held", "", "no power")


def test_a_fault_at_the_end_holds_too():
    """A mode that is done or returned has not put an end to faults."""
    done = begun()
    for _ in range(3):
        done.report(finished=True)
    assert done.report(fault="no power").state is State.HELD
    returned = begun()
    returned.report(crossed=["height"])
    returned.report(after=10.0)
    assert returned.report(finished=True).state is State.RETURNED
    assert returned.report(fault="no power").state is State.HELD
    assert done.trace[-2:] == [(3.0, "done", "", "finished"), (4.0, "held", "", "no power")]
    assert returned.trace[-2:] == [(12.0, "returned", "", "undone"), (13.0, "held", "", "no power")]


def test_a_mode_may_begin_from_held():
    bench = begun()
    bench.report(fault="no power")
    assert bench.supervisor.begin("rolling", ["roll"]).state is State.RUNNING


def test_reached_and_finished_at_once_reminds():
    bench = begun()
    assert bench.report(crossed=["height"], infeasible="a; b", finished=True).state is State.HALTED
    assert bench.trace[-1] == (1.0, "halted", "raise", "a; b")


def test_the_trace_is_frozen():
    event = begun().supervisor.trace[0]
    with pytest.raises(dataclasses.FrozenInstanceError):
        event.reason = "another"


def test_a_clock_that_never_told_a_time():
    bench = Bench()
    bench.now = math.nan
    assert bench.supervisor.begin("rolling", ["roll"]).state is State.HELD
    (event,) = bench.supervisor.trace
    assert (str(event.state), event.reason) == ("held", "the clock tells nan")
    assert math.isnan(event.time)


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
    with pytest.raises(InputError, match=r"rolling: must be a list of names \(got 'roll'\); give \['roll'\]"):
        Bench().supervisor.begin("rolling", "roll")
    with pytest.raises(InputError, match=r"crossed: must be a list of names \(got 'height'\)"):
        bench.report(crossed="height")
    for patience in (0.0, -1.0, math.nan, math.inf):
        with pytest.raises(InputError, match="patience: must be a finite number of seconds above 0"):
            Supervisor(lambda: 0.0, lambda _: False, patience)
