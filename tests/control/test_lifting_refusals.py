"""Lifts that are refused, and questions that are none."""

import math
import re

import numpy as np
import pytest
from lifting_cases import SIDES, changed

import rover_pin as rp
from rover_pin.control.layout import Layout, Side
from rover_pin.control.lifting import (
    LiftPlan,
    Refusal,
    RefusalStatus,
    admissible,
    engage,
    lift_height,
    plan_lift,
    prepare_lift,
)
from rover_pin.errors import InputError


@pytest.fixture(scope="module")
def rover():
    return rp.load("hit_mrii")


def test_admissible_sets_in_words():
    assert admissible(SIDES, ["LM", "RF"]) is None
    assert admissible(SIDES, []) is None
    assert admissible(SIDES, ["LF", "RB"]) == "LF, RB may not be lifted together: a front with a rear wheel"
    with pytest.raises(InputError, match="XY: no wheel of that name"):
        admissible(SIDES, ["XY"])


@pytest.mark.parametrize(
    ("wheels", "reason"),
    [
        (["LF", "LM"], "LF, LM may not be lifted together: two wheels of one side"),
        (["RF", "LB"], "RF, LB may not be lifted together: a front with a rear wheel"),
        (
            ["LF", "RF", "LM"],
            "LF, RF, LM may not be lifted together: too many wheels, two wheels of one side",
        ),
    ],
)
@pytest.mark.parametrize("ask", [plan_lift, prepare_lift])
def test_sets_that_are_not_admissible(rover, ask, wheels, reason):
    more = {"reserve": 1.0} if ask is prepare_lift else {}
    found = ask(rover, SIDES, wheels, 0.1, **more)
    assert found == Refusal(tuple(wheels), RefusalStatus.NOT_ADMISSIBLE, reason)


def test_a_side_without_clutch(rover):
    left, right = SIDES.sides
    bare = Layout(left, Side("right", right.wheels, right.hinge, right.rocker))
    found = plan_lift(rover, bare, ["RM"], 0.1)
    assert (found.status, found.limiting) == (RefusalStatus.NO_CLUTCH, "right")
    assert found.reason == (
        "the right side has no clutch, without which turning its rocker moves the chassis and leaves RM on "
        "the ground"
    )
    assert lift_height(rover, bare, "RM", [0.1]) == found
    assert isinstance(plan_lift(rover, bare, ["LM"], 0.1), LiftPlan)


def test_no_stance_to_start_from(rover):
    hill = rp.Terrain.slope(60.0)
    found = plan_lift(rover, SIDES, ["RM"], 0.1, terrain=hill)
    assert found.status is RefusalStatus.NO_STANCE
    assert found.reason.startswith("the rover does not stand in this posture: tips, ")


def test_joints_that_are_no_stance(rover):
    found = plan_lift(rover, SIDES, ["RM"], 0.1, {"R_bogie": 0.3})
    assert (found.status, found.limiting) == (RefusalStatus.NO_STANCE, "R_bogie")
    assert found.reason.startswith("the joints given are no stance: R_bogie is at 0.3 and would settle at ")


def test_a_clutch_locks_at_the_value_that_is_given(rover):
    present = rp.settle(rover, rp.Terrain.flat(), posture={"clearance": 0.485})
    joints = {**present.joints, "R_bogie": present.joints["R_bogie"] + 0.004}
    plan = plan_lift(rover, SIDES, ["RF"], 0.1, joints)
    assert plan.clutches == {"R_bogie": joints["R_bogie"]}
    assert plan.heights["RF"] == pytest.approx(0.1, abs=1e-8)


def test_a_reserve_that_is_not_kept(rover):
    found = plan_lift(rover, SIDES, ["RF"], 0.18, posture={"clearance": 0.485}, reserve=130.0)
    assert found.status is RefusalStatus.RESERVE
    assert found.reason == "with RF 140 mm up RB would carry 129 N, less than the 130 N wanted"
    assert found.load == pytest.approx(128.9, abs=0.1)
    assert found.height == pytest.approx(0.12, abs=1e-3)
    assert len(found.stances) == 7


def test_a_rocker_beyond_its_limit(rover):
    found = plan_lift(rover, SIDES, ["RM"], 0.5, posture={"clearance": 0.485})
    assert (found.status, found.limiting) == (RefusalStatus.LIMIT, "R_act")
    assert found.reason == "with RM 380 mm up R_act would have to be at 1.444 rad, beyond its limit 1.4 rad"
    assert found.height == pytest.approx(0.36, abs=1e-3)
    assert len(found.stances) == 19


def test_a_belly_that_would_sit_on_a_stone(rover):
    """A rear lift pitches the body nose down, here onto a stone under its front."""
    stone = rp.Terrain.from_function(lambda x, y: 0.23 * np.exp(-(((x - 0.45) / 0.12) ** 2) - (y / 0.2) ** 2))
    found = plan_lift(rover, SIDES, ["RB"], 0.18, terrain=stone, posture={"clearance": 0.24})
    assert (found.status, found.limiting) == (RefusalStatus.GROUNDED, "base_link")
    assert found.reason == "with RB 120 mm up base_link is 0.00131 m in the ground"
    assert found.height == pytest.approx(0.1, abs=1e-3)
    assert isinstance(plan_lift(rover, SIDES, ["RB"], 0.18, posture={"clearance": 0.24}), LiftPlan)


@pytest.fixture(scope="module")
def rigid(tmp_path_factory):
    """Both sides hang rigidly on the body: six wheels give more supports than balance determines."""
    sidecar = [("{L_diff: 1, R_diff: 1}", "{L_diff: 1}"), ("  [L_act,", "  [R_diff, L_act,")]
    return changed(tmp_path_factory.mktemp("rigid"), sidecar=sidecar)


def test_a_wheel_that_would_come_up_too(rigid):
    found = plan_lift(rigid, SIDES, ["RF"], 0.1, posture={"L_act": 0.7, "R_act": 0.7})
    assert (found.status, found.height) == (RefusalStatus.OUT_OF_REACH, 0.0)
    said = r"with RF just off the ground the other wheels cannot all stand: (\w\w) would be 0\.\d+ mm "
    assert re.fullmatch(said + "(off the ground|in it)", found.reason)[1] == found.limiting


def test_a_pair_lifts_alike_where_supports_are_redundant(rover, rigid):
    posture = {"L_act": 0.7, "R_act": 0.7}
    plan = plan_lift(rigid, SIDES, ["LF", "RF"], 0.1, posture=posture)
    assert plan.top.redundant == 1
    assert plan.loads == pytest.approx(
        plan_lift(rover, SIDES, ["LF", "RF"], 0.1, posture=posture).loads, abs=1e-3
    )


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"wheels": []}, "wheels: no wheel to lift; name one, or one a side"),
        ({"wheels": ["RF", "RF"]}, "RF: is named twice; name each wheel once"),
        ({"wheels": ["RX"]}, "RX: no wheel of that name; did you mean"),
        ({"height": math.nan}, "height: must be above 0 (got nan)"),
        ({"height": 0.0}, "height: must be above 0 (got 0.0)"),
        ({"step": 0.0}, "step: must be above 0 (got 0.0)"),
        ({"reserve": -1.0}, "reserve: must be 0 or above (got -1.0)"),
        ({"joints": {"R_act": math.nan}}, "joint R_act: not a finite number (got nan)"),
        ({"joints": {"R_axt": 0.1}}, "joint R_axt: no moving joint of that name"),
    ],
)
def test_bad_input(rover, more, message):
    words = {"wheels": ["RF"], "height": 0.1, **more}
    with pytest.raises(InputError) as caught:
        plan_lift(rover, SIDES, **words)
    assert message in str(caught.value)


def test_clutches_engage_at_a_standstill():
    rates = {"L_bogie": 2e-4, "R_bogie": 0.02, "R_act": 0.1}
    assert engage(["L_bogie"], rates) == ("L_bogie",)
    assert engage(("L_bogie", "R_bogie"), rates, tolerance=0.05) == ("L_bogie", "R_bogie")


@pytest.mark.parametrize(
    ("rates", "tolerance", "message"),
    [
        (
            {"R_bogie": -0.0312},
            1e-3,
            "R_bogie: the clutch cannot be engaged on a joint that moves faster than 0.001 rad/s "
            "(got '-0.0312 rad/s'); stop the rockers and wheels first",
        ),
        (
            {"R_bogie": math.nan},
            1e-3,
            "R_bogie: the rate of the clutch's joint is no finite number (got nan); hold the robot and look "
            "at the sensor",
        ),
        (
            {"L_bogie": 0.0},
            1e-3,
            "R_bogie: the clutch's joint has no rate; give one; did you mean 'L_bogie'?",
        ),
        ({"R_bogie": 0.0}, 0.0, "tolerance: must be above 0 rad/s (got 0.0)"),
    ],
)
def test_clutches_that_are_not_engaged(rates, tolerance, message):
    with pytest.raises(InputError) as caught:
        engage(["R_bogie"], rates, tolerance)
    assert str(caught.value) == message


def test_a_rocker_that_lifts_nothing(rover):
    left, right = SIDES.sides
    steered = Layout(left, Side("right", right.wheels, right.hinge, "RF_st", right.clutch))
    found = plan_lift(rover, steered, ["RF"], 0.1, posture={"clearance": 0.485})
    assert (found.status, found.limiting) == (RefusalStatus.OUT_OF_REACH, "RF_st")
    assert found.reason == "turning RF_st lifts RF no further than 0 mm"
    with pytest.raises(InputError, match="RF_st: this rocker does not raise or lower the chassis"):
        prepare_lift(rover, steered, ["LF"], 0.1, reserve=50.0)
