"""Raising or lowering the chassis before a lift."""

import numpy as np
import pytest
from hit_mrii_lifts import front_by_hand, single
from lifting_cases import SIDES, changed
from scipy.optimize import brentq

import rover_pin as rp
from rover_pin.control.lifting import LiftPlan, RefusalStatus, plan_lift, prepare_lift


@pytest.fixture(scope="module")
def rover():
    return rp.load("hit_mrii")


def test_a_front_lift_raises_the_chassis_first(rover):
    plan = prepare_lift(rover, SIDES, ["RF"], 0.18, reserve=50.0)
    assert isinstance(plan, LiftPlan)
    wanted = brentq(lambda c: front_by_hand(c, 0.18)[2] - 50.0, 0.3, 0.45)
    assert plan.clearance == pytest.approx(wanted, abs=1e-4)
    assert plan.clearance == pytest.approx(0.3968, abs=1e-3)
    assert (plan.least_wheel, plan.least_load) == ("RB", pytest.approx(50.0, abs=0.05))
    assert plan.least_load >= 50.0 - 1e-4
    assert plan.start["L_act"] == pytest.approx(plan.start["R_act"], abs=1e-12)
    assert all(stance.settled and stance.locked == () for stance in plan.approach)
    heights = [stance.position[2] for stance in plan.approach]
    assert np.all(np.diff(heights) > 0.0)
    assert plan.approach[-1].joints["R_act"] == plan.start["R_act"]


def test_a_rear_lift_lowers_the_chassis_first(rover):
    plan = prepare_lift(rover, SIDES, ["RB"], 0.15, reserve=2.0, posture={"clearance": 0.3})
    assert isinstance(plan, LiftPlan)
    wanted = brentq(lambda c: single(c, "RB", 1e-4)[1]["RF"] - 2.0, 0.2, 0.3)
    assert plan.clearance == pytest.approx(wanted, abs=1e-4)
    assert plan.clearance < 0.25
    assert plan.approach[0].position[2] > plan.approach[-1].position[2]
    assert (plan.least_wheel, plan.least_load) == ("RF", pytest.approx(2.0, abs=0.01))


def test_a_posture_that_serves_is_kept(rover):
    plan = prepare_lift(rover, SIDES, ["RF"], 0.18, reserve=100.0, posture={"clearance": 0.485})
    same = plan_lift(rover, SIDES, ["RF"], 0.18, posture={"clearance": 0.485})
    assert plan.approach == ()
    assert plan.loads == pytest.approx(same.loads, abs=1e-6)


def test_a_reserve_that_no_posture_keeps(rover):
    """The front wheel carries at most 5.3 N when the rear one leaves the ground, however low the chassis."""
    found = prepare_lift(rover, SIDES, ["RB"], 0.1, reserve=10.0)
    assert (found.status, found.limiting) == (RefusalStatus.RESERVE, "RF")
    assert found.reason.startswith("no posture of both rockers together serves; at clearance 1")
    assert found.reason.endswith(
        " mm, with RB just off the ground RF would carry 5.26 N, less than the 10 N wanted"
    )
    most = max(single(c, "RB", 1e-4)[1]["RF"] for c in np.linspace(0.15, 0.25, 21))
    assert found.load == pytest.approx(most, abs=0.02)


def test_rockers_that_turn_the_other_way_still_raise_the_chassis(tmp_path):
    plain = prepare_lift(rp.load("hit_mrii"), SIDES, ["RF"], 0.18, reserve=50.0)
    plan = prepare_lift(mirrored(tmp_path), SIDES, ["RF"], 0.18, reserve=50.0)
    assert plan.clearance == pytest.approx(plain.clearance, abs=1e-5)
    assert plan.start["R_act"] == pytest.approx(-plain.start["R_act"], abs=1e-5)


def mirrored(folder):
    """The motors turn the rear arms about +y."""
    return changed(
        folder,
        urdf=[
            (
                '<axis xyz="0 -1 0"/>\n      <limit lower="-0.8" upper="1.4"',
                '<axis xyz="0 1 0"/>\n      <limit lower="-1.4" upper="0.8"',
            ),
            ('multiplier="${gear_ratio}"', 'multiplier="${-gear_ratio}"'),
        ],
        sidecar=[
            ("raised: {L_act: 0.682511, R_act: 0.682511}", "raised: {L_act: -0.682511, R_act: -0.682511}"),
            ("lowered: {L_act: -0.263283, R_act: -0.263283}", "lowered: {L_act: 0.263283, R_act: 0.263283}"),
        ],
    )


def test_a_motor_that_turns_the_other_way_lifts_with_the_other_sign(tmp_path):
    plan = plan_lift(mirrored(tmp_path), SIDES, ["RF"], 0.18, posture={"clearance": 0.485})
    angle, middle, rear = front_by_hand(0.485, 0.18)
    assert plan.rockers["R_act"] == pytest.approx(-angle, abs=1e-5)
    assert plan.turns["R_act"] > 0.0
    assert plan.directions == {"right": "unfolds"}
    assert (plan.loads["RM"], plan.loads["RB"]) == (
        pytest.approx(middle, abs=0.01),
        pytest.approx(rear, abs=0.01),
    )
