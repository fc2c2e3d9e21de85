"""Lifts of HIT-MRII against moments on paper and the energy's multipliers."""

import math

import numpy as np
import pytest
from hit_mrii_closed_form import GRAVITY, Machine
from hit_mrii_lifts import WHEELS, Lift, front_by_hand, single
from lifting_cases import SIDES

import rover_pin as rp
from rover_pin.control.lifting import LiftPlan, Refusal, RefusalStatus, plan_lift

FLAT = rp.Terrain.flat()
WEIGHT = Machine().mass * GRAVITY


@pytest.fixture(scope="module")
def rover():
    return rp.load("hit_mrii")


def lift(rover, wheels, height, clearance, **more):
    return plan_lift(rover, SIDES, wheels, height, posture={"clearance": clearance}, **more)


def planned(*args, **more):
    found = lift(*args, **more)
    assert isinstance(found, LiftPlan), found
    return found


def test_right_front_180_mm_from_485_mm(rover):
    plan = planned(rover, ["RF"], 0.18, 0.485)
    noted = {"LF": 351, "LM": 376, "LB": 376, "RF": 0, "RM": 977, "RB": 126}
    assert plan.loads == pytest.approx(noted, abs=0.5)
    assert plan.load_difference == pytest.approx(851.0, abs=0.5)
    assert plan.heights["RF"] == pytest.approx(0.18, abs=1e-8)
    assert plan.clearance == pytest.approx(0.485, abs=1e-6)
    assert (plan.least_wheel, plan.least_load) == ("RB", pytest.approx(plan.loads["RB"]))
    angle, middle, rear = front_by_hand(0.485, 0.18)
    assert plan.rockers["R_act"] == pytest.approx(angle, abs=1e-5)
    assert plan.loads["RM"] == pytest.approx(middle, abs=0.01)
    assert plan.loads["RB"] == pytest.approx(rear, abs=0.01)


@pytest.mark.parametrize(
    ("clearance", "wheel", "height"),
    [(0.485, "RF", 0.18), (0.4, "LF", 0.1), (0.2, "RB", 0.18), (0.22, "LB", 0.05), (0.25, "RM", 0.18)],
)
def test_single_lifts_against_the_energys_multipliers(rover, clearance, wheel, height):
    plan = planned(rover, [wheel], height, clearance)
    angle, loads = single(clearance, wheel, height)
    assert plan.rockers[f"{wheel[0]}_act"] == pytest.approx(angle, abs=1e-5)
    assert plan.loads == pytest.approx({**loads, wheel: 0.0}, abs=0.02)


@pytest.mark.parametrize(
    ("clearance", "wheels"),
    [
        (0.485, ("LF", "RF")),
        (0.25, ("LM", "RM")),
        (0.2, ("LB", "RB")),
        (0.485, ("LM", "RF")),
        (0.2, ("LB", "RM")),
    ],
)
def test_pairs_against_the_energys_multipliers(rover, clearance, wheels):
    plan = planned(rover, wheels, 0.12, clearance)
    rockers = (plan.rockers["L_act"], plan.rockers["R_act"])
    clutches = (plan.clutches["L_bogie"], plan.clutches["R_bogie"])
    gaps, loads = Lift(rockers, clutches, wheels).solve()
    assert gaps == pytest.approx(dict.fromkeys(wheels, 0.12), abs=1e-8)
    assert plan.heights == pytest.approx(gaps, abs=1e-8)
    assert plan.loads == pytest.approx({**loads, **dict.fromkeys(wheels, 0.0)}, abs=0.02)


def test_front_and_rear_unfold_and_the_middle_folds(rover):
    ways = {}
    for clearance, wheel in ((0.485, "RF"), (0.2, "RB"), (0.25, "RM")):
        plan = planned(rover, [wheel], 0.1, clearance)
        ways[wheel] = (plan.directions["right"], math.copysign(1.0, plan.turns["R_act"]))
    assert ways == {"RF": ("unfolds", -1.0), "RB": ("unfolds", -1.0), "RM": ("folds", 1.0)}
    plan = planned(rover, ["LM", "RF"], 0.1, 0.485)
    assert plan.directions == {"left": "folds", "right": "unfolds"}


def test_the_other_way_the_rover_left_to_itself_lifts_another_wheel(rover):
    present = rp.settle(rover, FLAT, posture={"clearance": 0.485})
    held = {name: present.joints[name] for name in ("L_act", "R_act", "R_bogie")}
    for turn, up in ((-0.02, {"RF"}), (0.02, {"RM"})):
        stance = rp.settle(rover, FLAT, joints={**held, "R_act": held["R_act"] + turn})
        assert {wheel for wheel, gap in stance.gaps.items() if gap > 1e-6} == up


def test_every_stance_on_the_way_stands(rover):
    plan = planned(rover, ["RF"], 0.18, 0.485)
    assert len(plan.stances) == 10
    heights = [stance.gaps["RF"] for stance in plan.stances]
    assert np.all(np.diff(heights) > 0.0)
    assert heights[0] == pytest.approx(1e-4, abs=1e-6)
    for stance in plan.stances:
        assert stance.settled
        assert max(stance.residuals.values()) < 1e-6
        assert sum(stance.loads.values()) == pytest.approx(WEIGHT, rel=1e-9)
        assert stance.locked == ("R_bogie",)
        assert stance.joints["R_bogie"] == plan.clutches["R_bogie"] == plan.present.joints["R_bogie"]
        assert stance.joints["L_act"] == plan.start["L_act"]
    assert plan.top is plan.stances[-1]
    assert plan.approach == ()


def test_the_way_is_followed_where_a_fresh_settle_would_fall_to_the_rear(rover):
    """With a clutch engaged both "front up" and "rear up" stand from some height on."""
    plan = planned(rover, ["RF"], 0.32, 0.485)
    joints = {name: plan.top.joints[name] for name in ("L_act", "R_act", "R_bogie")}
    fresh = rp.settle(rover, FLAT, joints=joints)
    assert fresh.settled
    assert (fresh.gaps["RB"] > 0.1, plan.top.gaps["RF"] > 0.1) == (True, True)
    start = front_by_hand(0.485, 0.32)
    assert plan.loads["RB"] == pytest.approx(start[2], abs=0.01)


def test_front_lift_at_200_mm_is_refused_with_its_load(rover):
    found = lift(rover, ["RF"], 0.18, 0.2)
    assert isinstance(found, Refusal)
    assert found.status is RefusalStatus.NEGATIVE_LOAD
    assert found.reason == (
        "with RF just off the ground RB would have to carry -5.21 N; left to itself the rover lifts RB"
    )
    assert (found.limiting, found.height, found.stances) == ("RB", 0.0, ())
    assert found.load == pytest.approx(front_by_hand(0.2, 1e-4)[2], abs=1e-3)


def test_rear_lift_of_the_raised_chassis_is_refused_with_its_load(rover):
    found = lift(rover, ["LB"], 0.18, 0.485)
    assert (found.status, found.limiting) == (RefusalStatus.NEGATIVE_LOAD, "LF")
    assert found.load == pytest.approx(single(0.485, "LB", 1e-4)[1]["LF"], abs=0.01)
    assert found.load == pytest.approx(-213.4, abs=0.1)
    assert found.rockers["L_act"] < 0.7007


@pytest.mark.parametrize(("wheel", "opposite"), [("RF", "RB"), ("RB", "RF")])
def test_front_or_rear_lift_at_250_mm_is_marginal(rover, wheel, opposite):
    found = lift(rover, [wheel], 1e-3, 0.25)
    load = found.load if isinstance(found, Refusal) else found.stances[0].loads[opposite]
    assert abs(load) < 0.1


def test_middle_lift_is_shared_by_front_and_rear(rover):
    before = rp.settle(rover, FLAT, posture={"clearance": 0.25}).loads
    plan = planned(rover, ["RM"], 0.18, 0.25)
    gained = {wheel: plan.stances[0].loads[wheel] - before[wheel] for wheel in WHEELS}
    assert gained["RF"] == pytest.approx(before["RM"] / 2, abs=0.1)
    assert gained["RB"] == pytest.approx(before["RM"] / 2, abs=0.1)
    assert plan.loads["RF"] == pytest.approx(plan.loads["RB"], rel=0.03)


@pytest.mark.parametrize(
    ("wheels", "clearance"), [(("LF", "RF"), 0.3), (("LF", "RF"), 0.485), (("LB", "RB"), 0.2)]
)
def test_no_wheel_carries_more_than_half_the_weight_under_a_symmetric_lift(rover, wheels, clearance):
    plan = planned(rover, wheels, 0.18, clearance)
    most = max(max(stance.loads.values()) for stance in plan.stances)
    assert most < WEIGHT / 2
    assert most < 1103.7
    assert plan.rockers["L_act"] == pytest.approx(plan.rockers["R_act"], abs=1e-6)
