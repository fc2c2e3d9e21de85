"""Pilot trials."""

import math

import pytest
from hit_mrii_closed_form import Machine

from rover_pin.control.pilot import pilot
from rover_pin.errors import InputError

MACHINE = Machine()


def overshooting(**by):
    """Peaks that pass their margins by so much."""
    return lambda margins: {name: margins[name] + by[name] for name in margins}


def test_nothing_to_lower():
    report = pilot(overshooting(height=0.0), {"height": 1.0})
    assert report.feasible
    assert len(report.trials) == 1
    assert str(report) == "no limit is passed after 1 trial, with margins height 1"


def test_lowers_what_is_violated_only():
    report = pilot(overshooting(height=0.12, wheelbase=0.0), {"height": 1.0, "wheelbase": 1.0}, step=0.05)
    assert report.feasible
    assert report.margins == pytest.approx({"height": 0.85, "wheelbase": 1.0})
    assert [trial.violated for trial in report.trials] == [("height",)] * 3 + [()]
    assert report.trials[1].margins == pytest.approx({"height": 0.95, "wheelbase": 1.0})


def test_raising_that_stops_late():
    """A chassis that rises at 3.6 mm/s goes on for 3 s after its margin of 0.25 is reached: closed form."""

    def trial(margins):
        clearance = 0.25
        while MACHINE.shortening(MACHINE.motor_angle(clearance)) / 0.25 <= margins["wheelbase"]:
            clearance += 0.001
        late = clearance + 3 * 0.0036
        return {"wheelbase": MACHINE.shortening(MACHINE.motor_angle(late)) / 0.25}

    report = pilot(trial, {"wheelbase": 1.0}, step=0.02)
    assert report.feasible
    assert 0.98 - 0.05 < report.trials[-1].peaks["wheelbase"] <= 1.0
    assert report.trials[-2].peaks["wheelbase"] > 1.0
    assert report.margins["wheelbase"] == pytest.approx(1.0 - 0.02 * (len(report.trials) - 1))
    assert 0.85 < report.margins["wheelbase"] < 0.95


def test_no_feasible_margin():
    """A load that does not depend on where the control stops."""

    def trial(margins):
        return {"load_difference": 1.07, "height": margins["height"]}

    report = pilot(trial, {"load_difference": 0.9, "height": 0.8}, step=0.3, least=0.2)
    assert not report.feasible
    assert report.exhausted == ("load_difference",)
    margins = [trial.margins["load_difference"] for trial in report.trials]
    assert margins == pytest.approx([0.9, 0.6, 0.3, 0.2])
    assert str(report) == (
        "no feasible margin after 4 trials: load_difference still comes to 1.07 of its limit "
        "at the least margin, 0.2"
    )


def test_a_failed_motion_ends():
    report = pilot(lambda _: {"height": math.inf}, {"height": 1.0}, step=0.5, least=0.5)
    assert (len(report.trials), report.feasible) == (2, False)


def test_ends_after_as_many_trials_as_steps():
    calls = []

    def trial(margins):
        calls.append(margins)
        worst = max(margins, key=margins.get)
        return {name: 2.0 if name == worst else 0.0 for name in margins}

    report = pilot(trial, dict.fromkeys("abc", 1.0), step=0.1, least=0.1)
    assert not report.feasible
    assert len(calls) <= 3 * 9 + 1


def test_a_trial_cannot_change_margins():
    def trial(margins):
        margins["height"] = 0.0
        return {"height": 0.5}

    assert pilot(trial, {"height": 1.0}).margins == {"height": 1.0}


@pytest.mark.parametrize(
    ("start", "more", "message"),
    [
        ({}, {}, "start: there is no margin to lower; give one a motion constraint"),
        ({"height": 1.2}, {}, "height: a margin starts between the least, 0.1, and 1 (got 1.2)"),
        ({"height": math.nan}, {}, "height: a margin starts between the least, 0.1, and 1 (got nan)"),
        ({"height": 1.0}, {"step": 0.0}, "step: must be a finite number above 0 (got 0.0)"),
        ({"height": 1.0}, {"least": -1.0}, "least: must be a finite number above 0 (got -1.0)"),
    ],
)
def test_bad_margins(start, more, message):
    with pytest.raises(InputError) as caught:
        pilot(overshooting(height=0.0), start, **more)
    assert str(caught.value) == message


@pytest.mark.parametrize(
    ("peaks", "message"),
    [
        ({}, "height: the trial gives no index of it; let it tell the largest one"),
        ({"height": math.nan}, "height: the trial gives NaN for its index; give inf if it failed"),
        ({"heigth": 1.0}, "heigth: the trial gives an index of a constraint without a margin; "
         "did you mean 'height'?"),
    ],
)  # fmt: skip
def test_bad_trials(peaks, message):
    with pytest.raises(InputError) as caught:
        pilot(lambda _: peaks, {"height": 1.0})
    assert str(caught.value) == message
