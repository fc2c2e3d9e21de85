"""What settle refuses, and what it says: element, value and cure on one line."""

import math

import pytest
from little_rover import Builder, fixture, four_wheels

import rover_pin as rp
from rover_pin.errors import InputError, MechanismError, OffMapError, PostureError

FLAT = rp.Terrain.flat()


def refused(kind, rover, terrain=FLAT, **asked):
    with pytest.raises(kind) as caught:
        rp.settle(rover, terrain, **asked)
    assert isinstance(caught.value, InputError)
    text = str(caught.value)
    assert "\n" not in text
    return text


def test_a_robot_without_wheels(tmp_path):
    rover = Builder("bare").link("base_link", 5).load(tmp_path)
    text = refused(InputError, rover)
    assert "rover.yaml: wheels: nothing of this robot touches the ground" in text
    assert text.endswith("declare `wheels` (frame, radius, width) or `contacts` in it")


@pytest.mark.parametrize("name", ["x", "y", "yaw", "gravity"])
@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_numbers_that_are_not_finite(name, value):
    text = refused(InputError, fixture("rigid4"), **{name: value})
    assert text == f"{name}: must be a finite number (got {value})"


@pytest.mark.parametrize("value", [0.0, -9.81])
def test_gravity_that_does_not_pull(value):
    assert refused(InputError, fixture("rigid4"), gravity=value) == (
        f"gravity: must be above 0 m/s2 (got {value})"
    )


def test_an_unknown_posture():
    text = refused(PostureError, rp.load("hit_mrii"), posture="raise")
    assert "posture: no posture of that name (got 'raise'); did you mean 'raised'?" in text
    text = refused(PostureError, fixture("rigid4"), posture="raised")
    assert "no posture of that name (got 'raised')" in text
    assert "home" in text


def test_home_is_always_there():
    assert rp.settle(fixture("rigid4"), FLAT, posture="home").settled


def test_an_unknown_joint():
    for asked in ({"joints": {"L_akt": 0.1}}, {"posture": {"L_akt": 0.1}}):
        text = refused(PostureError, rp.load("hit_mrii"), **asked)
        assert text.startswith("joint L_akt: no moving joint of that name (got 0.1); did you mean")
        assert "'L_act'" in text


def test_an_unknown_lock():
    text = refused(PostureError, rp.load("hit_mrii"), locks=["bogie_L"])
    assert "lock: not a joint that can be locked (got 'bogie_L')" in text
    assert "L_bogie" in text


def test_a_lock_on_a_driven_joint():
    text = refused(PostureError, rp.load("hit_mrii"), locks=["L_act"])
    assert "lock: not a joint that can be locked (got 'L_act')" in text


@pytest.mark.parametrize("value", [math.nan, math.inf, "far", None])
def test_a_joint_value_that_is_no_number(value):
    text = refused(PostureError, rp.load("hit_mrii"), joints={"L_act": value})
    assert text.startswith("joint L_act: not a finite number")
    assert text.endswith("give rad or m")


def test_a_posture_outside_limits():
    text = refused(PostureError, fixture("thirds"), joints={"bogie_l": 0.9})
    assert "bogie_l" in text
    assert "0.9" in text
    assert "-0.8" in text
    assert "0.8" in text


def test_a_word_for_locks_is_not_taken_letter_by_letter():
    assert "lock: not a joint that can be locked (got " in refused(
        PostureError, rp.load("hit_mrii"), locks="x"
    )


def test_clearance_without_belly():
    text = refused(PostureError, fixture("rigid4"), posture={"clearance": 0.3})
    assert "belly: a clearance goal needs belly points; declare `belly` in the sidecar" in text


def test_clearance_without_a_joint_that_moves_it(tmp_path):
    made = four_wheels().say(belly=[{"frame": "base_link", "point": [0, 0, -0.1]}])
    text = refused(PostureError, made.load(tmp_path), posture={"clearance": 0.3})
    assert text.startswith("clearance: no posture of the actuated joints gives this belly clearance")
    assert "(got 0.3)" in text
    assert "the nearest is 0.2000 m" in text


def test_clearance_out_of_reach():
    text = refused(PostureError, rp.load("hit_mrii"), posture={"clearance": 2.0})
    assert text.startswith("clearance: no posture of the actuated joints gives this belly clearance")
    assert "(got 2.0)" in text
    assert "ask for a clearance within the joints' reach" in text


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_clearance_that_is_no_number(value):
    text = refused(PostureError, rp.load("hit_mrii"), posture={"clearance": value})
    assert text == f"clearance: not a finite number (got {value}); give metres"


def test_clearance_that_is_a_word():
    text = refused(PostureError, rp.load("hit_mrii"), posture={"clearance": "high"})
    assert text.startswith("clearance: not a finite number (got 'high')")


def test_clearance_with_other_joints():
    text = refused(PostureError, rp.load("hit_mrii"), posture={"clearance": 0.4, "L_act": 0.1})
    assert text.startswith("posture: a clearance goal stands alone")
    assert "give other joints by `joints`" in text


def test_clearance_with_a_joint_given():
    """What the user holds does not move: one motor at 0.5, the other reaches the goal."""
    stance = rp.settle(rp.load("hit_mrii"), FLAT, posture={"clearance": 0.4}, joints={"L_act": 0.5})
    assert stance.settled, stance.reason
    assert stance.joints["L_act"] == 0.5
    lowest = min(stance_point(stance, p)[2] for p in stance.rover.belly)
    assert lowest == pytest.approx(0.4, abs=1e-6)


def stance_point(stance, point):
    import numpy as np
    import pinocchio as pin

    data = stance.rover.model.createData()
    pin.forwardKinematics(stance.rover.model, data, np.array(stance.configuration))
    return data.oMi[point.joint].act(np.array(point.point))


def test_contradictions_are_mechanism_errors():
    refused(MechanismError, fixture("thirds"), joints={"rocker_l": 0.1, "rocker_r": 0.1})


def test_a_place_off_the_map():
    import numpy as np

    ground = rp.Terrain.from_grid(np.zeros((30, 30)), 0.1)
    text = refused(OffMapError, fixture("rigid4"), ground, x=-0.1, y=1.0)
    assert "grid: the place is not on the map (got '-0.1, 1'); the map spans x 0 to 2.9 m" in text
