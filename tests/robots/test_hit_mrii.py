"""HIT-MRII against its closed forms."""

import math

import numpy as np
import pinocchio as pin
import pytest
from hit_mrii_closed_form import Machine

import rover_pin as rp

MACHINE = Machine()
FLAT = rp.Terrain.flat()
WHEELS = ("LF", "LM", "LB", "RF", "RM", "RB")


@pytest.fixture(scope="module")
def rover():
    return rp.load("hit_mrii")


def places(stance):
    """Wheel centres, world, by name."""
    model = stance.rover.model
    data = model.createData()
    pin.forwardKinematics(model, data, np.array(stance.configuration))
    return {w.name: data.oMi[w.joint].act(np.array(w.center)) for w in stance.rover.wheels}


def driven(rover, left, right=None, **more):
    right = left if right is None else right
    return rp.settle(rover, FLAT, joints={"L_act": left, "R_act": right}, **more)


def test_names(rover):
    joints = {f"{s}_{j}" for s in "LR" for j in ("diff", "fr", "act", "bogie")}
    joints |= {f"{w}_{j}" for w in WHEELS for j in ("st", "dr")}
    assert set(rover.joints) == joints
    assert tuple(w.name for w in rover.wheels) == WHEELS
    assert set(rover.actuated) == {j for j in joints if j.endswith(("_act", "_st", "_dr"))}
    assert set(rover.lockable) == {"L_bogie", "R_bogie"}
    assert len(rover.couplings) == 3


def test_masses(rover):
    assert rover.mass == pytest.approx(225.0, abs=1e-9)
    by_joint = dict(zip(rover.model.names, (i.mass for i in rover.model.inertias), strict=True))
    for joint, mass in [("L_fr", 8), ("R_act", 6), ("L_bogie", 8), ("RM_st", 19 / 6), ("LB_dr", 7)]:
        assert by_joint[joint] == pytest.approx(mass)


def test_axes(rover):
    data = rover.model.createData()
    q = np.zeros(rover.model.nv)
    pin.computeJointJacobians(rover.model, data, q)
    for joint, sign in [("diff", 1), ("fr", 1), ("act", -1), ("bogie", 1)]:
        for side in "LR":
            index = rover.model.getJointId(f"{side}_{joint}")
            turn = pin.getJointJacobian(rover.model, data, index, pin.LOCAL_WORLD_ALIGNED)
            column = turn[3:, rover.column[f"{side}_{joint}"]]
            np.testing.assert_allclose(column, [0, sign, 0], atol=1e-12)


def test_home_stands_on_six_equal_loads(rover):
    stance = rp.settle(rover, FLAT, posture="home")
    assert stance.settled
    for wheel in WHEELS:
        assert stance.loads[wheel] == pytest.approx(367.875, abs=0.01)
    assert stance.position[2] == pytest.approx(0.45, abs=1e-9)
    np.testing.assert_allclose(stance.rpy, 0.0, atol=1e-9)


def test_home_geometry(rover):
    at = places(rp.settle(rover, FLAT, posture="home"))
    for side, y in (("L", 0.652), ("R", -0.652)):
        for wheel, x in (("F", 0.775), ("M", 0.0), ("B", -0.775)):
            np.testing.assert_allclose(at[side + wheel], [x, y, 0.15], atol=1e-9)
    assert at["LF"][0] - at["LB"][0] == pytest.approx(1.550, abs=1e-9)


def test_rear_arm_at_home():
    assert math.degrees(MACHINE.theta20) == pytest.approx(7.338, abs=5e-4)
    assert 1e3 * MACHINE.drop == pytest.approx(49.90, abs=5e-3)
    rover = rp.load("hit_mrii")
    pivot = rover.model.jointPlacements[rover.model.getJointId("L_bogie")].translation
    np.testing.assert_allclose(pivot, [-0.3875, 0.0, -MACHINE.drop], atol=1e-9)


def test_clearance_of_480_mm(rover):
    stance = rp.settle(rover, FLAT, posture={"clearance": 0.48})
    at = places(stance)
    for side in "LR":
        assert math.degrees(stance.joints[f"{side}_act"]) == pytest.approx(39.108, abs=0.02)
        assert 1e3 * (at[f"{side}F"][0] - at[f"{side}M"][0]) == pytest.approx(525.18, abs=0.1)


@pytest.mark.parametrize("clearance", np.linspace(0.15, 0.55, 9))
def test_clearance_goal_against_closed_form(rover, clearance):
    stance = rp.settle(rover, FLAT, posture={"clearance": float(clearance)})
    u = MACHINE.motor_angle(clearance)
    assert stance.joints["L_act"] == pytest.approx(u, abs=1e-5)
    assert stance.joints["R_act"] == pytest.approx(u, abs=1e-5)
    compare(stance, MACHINE, u, tolerance=2e-5)


@pytest.mark.parametrize("u", [-0.3, -0.1, 0.2, 0.5, 0.9])
def test_stance_at_a_motor_angle_against_closed_form(rover, u):
    compare(driven(rover, u), MACHINE, u)


@pytest.mark.parametrize(
    "numbers",
    [
        {"gear_ratio": 0.6},
        {"pillar": 0.35},
        {"front_arm": 0.85, "com_x": 0.05},
        {"rear_arm": 0.42, "bogie_half": 0.36},
        {"body_mass": 150.0},
    ],
)
def test_parameters_change_what_the_closed_form_says(numbers):
    names = {"gear_ratio": "gear", "com_x": "body_x"}
    machine = Machine(**{names.get(k, k): v for k, v in numbers.items()})
    rover = rp.load("hit_mrii", **numbers)
    assert rover.mass == pytest.approx(machine.mass)
    compare(driven(rover, 0.3), machine, 0.3)


def compare(stance, machine, u, tolerance=1e-7):
    assert stance.settled, stance.reason
    a, b, p = machine.angles(u)
    roll, pitch, _ = stance.rpy
    assert roll == pytest.approx(0.0, abs=tolerance)
    assert pitch == pytest.approx(p, abs=tolerance)
    assert stance.position[2] == pytest.approx(machine.hinge_height(u), abs=tolerance)
    at = places(stance)
    front, rear = machine.loads(u)
    for side in "LR":
        assert stance.joints[f"{side}_diff"] == pytest.approx(0.0, abs=tolerance)
        assert stance.joints[f"{side}_fr"] == pytest.approx(a - p, abs=tolerance)
        assert stance.joints[f"{side}_bogie"] == pytest.approx(b - machine.theta20, abs=tolerance)
        wheelbase = at[f"{side}F"][0] - at[f"{side}M"][0]
        assert wheelbase == pytest.approx(machine.wheelbase(u), abs=tolerance)
        assert stance.loads[f"{side}F"] == pytest.approx(front, abs=1e3 * tolerance)
        assert stance.loads[f"{side}M"] == pytest.approx(rear, abs=1e3 * tolerance)
        assert stance.loads[f"{side}B"] == pytest.approx(rear, abs=1e3 * tolerance)


def test_track_and_hinge_span_move_wheels_and_hinges():
    rover = rp.load("hit_mrii", track=1.5, hinge_span=0.7)
    at = places(rp.settle(rover, FLAT))
    assert at["LF"][1] - at["RF"][1] == pytest.approx(1.5)
    hinge = rover.model.jointPlacements[rover.model.getJointId("L_diff")].translation
    assert hinge[1] == pytest.approx(0.35)


def test_swapping_the_sides_mirrors_the_stance(rover):
    one, other = driven(rover, 0.5, 0.3), driven(rover, 0.3, 0.5)
    assert one.settled
    assert one.rpy[0] == pytest.approx(-other.rpy[0], abs=1e-9)
    assert abs(one.rpy[0]) > 0.02
    assert one.rpy[1] == pytest.approx(other.rpy[1], abs=1e-9)
    for wheel in WHEELS:
        twin = ("R" if wheel[0] == "L" else "L") + wheel[1]
        assert one.loads[wheel] == pytest.approx(other.loads[twin], abs=1e-6)


@pytest.mark.parametrize("yaw", [0.7, 2.0, -2.9])
def test_heading_and_place_do_not_matter_on_level_ground(rover, yaw):
    here, there = driven(rover, 0.6, 0.2), driven(rover, 0.6, 0.2, x=3.0, y=-2.0, yaw=yaw)
    np.testing.assert_allclose(here.rpy[:2], there.rpy[:2], atol=1e-9)
    for wheel in WHEELS:
        assert here.loads[wheel] == pytest.approx(there.loads[wheel], abs=1e-6)


def test_couplings_hold_on_rough_ground(rover):
    stance = rp.settle(rover, rp.Terrain.rough(3, 0.05, 0.8), x=0.4, y=-0.3, yaw=0.5)
    assert stance.settled, stance.reason
    assert stance.joints["L_diff"] + stance.joints["R_diff"] == pytest.approx(0.0, abs=1e-9)
    assert abs(stance.joints["L_diff"]) > 1e-4
    for side in "LR":
        assert stance.joints[f"{side}_fr"] == pytest.approx(stance.joints[f"{side}_act"] / 2.2, abs=1e-9)
    assert sum(stance.loads.values()) == pytest.approx(stance.weight, rel=1e-9)


@pytest.mark.parametrize("u", [-0.2, 0.0, 0.4, 0.68])
def test_rates_of_the_closed_form_are_its_derivatives(u):
    step = 1e-5
    lift = (MACHINE.hinge_height(u + step) - MACHINE.hinge_height(u - step)) / (2 * step)
    shorter = (MACHINE.wheelbase(u + step) - MACHINE.wheelbase(u - step)) / (2 * step)
    arm = (MACHINE.angles(u + step)[0] - MACHINE.angles(u - step)[0]) / (2 * step)
    assert MACHINE.lift_rate(u, 1.0) == pytest.approx(lift, rel=1e-7)
    assert MACHINE.wheelbase_rate(u, lift) == pytest.approx(shorter, rel=1e-7)
    assert MACHINE.rim_rate(u, lift) == pytest.approx(shorter - 0.15 * arm, rel=1e-7)


def test_figures_of_the_lifting_mode():
    """Shortening and front wheel's speed at 3.6 mm/s of lift, at home and at 480 mm."""
    assert MACHINE.wheelbase_rate(0.0, 3.6) == pytest.approx(-1.86, abs=5e-3)
    u = MACHINE.motor_angle(0.48)
    assert MACHINE.shortening(u) == pytest.approx(0.322, abs=5e-4)
    assert MACHINE.wheelbase_rate(u, 3.6) == pytest.approx(-6.677, abs=2e-3)
