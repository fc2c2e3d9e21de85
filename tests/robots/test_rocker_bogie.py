"""The generic rocker-bogie against moments worked out by hand."""

import math

import numpy as np
import pinocchio as pin
import pytest

import rover_pin as rp

FLAT = rp.Terrain.flat()
WHEELS = ("fl", "ml", "bl", "fr", "mr", "br")


@pytest.fixture(scope="module")
def rover():
    return rp.load("rocker_bogie")


def test_names(rover):
    assert tuple(w.name for w in rover.wheels) == WHEELS
    assert set(rover.passive) == {"rocker_l", "bogie_l", "rocker_r", "bogie_r"}
    steers = {"steer_fl", "steer_bl", "steer_fr", "steer_br"}
    assert set(rover.actuated) == steers | {f"drive_{w}" for w in WHEELS}
    assert {w.link for w in rover.wheels} == {f"wheel_{w}_link" for w in WHEELS}


def test_stands_on_six_equal_loads(rover):
    stance = rp.settle(rover, FLAT, posture="home")
    assert stance.settled
    assert rover.mass == pytest.approx(132.0)
    for wheel in WHEELS:
        assert stance.loads[wheel] == pytest.approx(132 * 9.81 / 6, abs=1e-6)
    assert stance.position[2] == pytest.approx(0.40, abs=1e-9)
    np.testing.assert_allclose(stance.rpy, 0.0, atol=1e-9)


@pytest.mark.parametrize(
    "numbers",
    [
        {"bogie_fraction": 0.4, "wheelbase": 1.5},
        {"hinge_height": 0.35, "bogie_height": 0.1},
        {"track": 1.6, "body_mass": 40.0, "com_height": 0.3},
    ],
)
def test_loads_stay_equal_whatever_the_sizes(numbers):
    stance = rp.settle(rp.load("rocker_bogie", **numbers), FLAT)
    np.testing.assert_allclose(list(stance.loads.values()), stance.weight / 6, rtol=1e-8)


@pytest.mark.parametrize(("com_x", "fraction"), [(0.1, 0.5), (-0.05, 0.4), (0.02, 0.6)])
def test_a_shifted_body_loads_front_and_bogie_by_the_lever(com_x, fraction):
    """About a hinge: (Nf - N) x_front = body's half weight times its shift, the pivot at -x_front / 2."""
    rover = rp.load("rocker_bogie", com_x=com_x, bogie_fraction=fraction)
    stance = rp.settle(rover, FLAT)
    front = 1.2 * (2 - fraction) / 3
    for side in "lr":
        loads = [stance.loads[end + side] for end in "fmb"]
        assert loads[1] == pytest.approx(loads[2], abs=1e-6)
        assert loads[0] - loads[1] == pytest.approx(84 * 9.81 * com_x / (2 * front), abs=1e-6)


def test_wheels_stand_where_the_parameters_say():
    rover = rp.load("rocker_bogie", track=1.1, wheelbase=1.3)
    data = rover.model.createData()
    pin.forwardKinematics(rover.model, data, np.zeros(rover.model.nv))
    at = {w.name: data.oMi[w.joint].act(np.array(w.center)) for w in rover.wheels}
    for side, y in (("l", 0.55), ("r", -0.55)):
        for end, x in (("f", 0.65), ("m", 0.0), ("b", -0.65)):
            np.testing.assert_allclose(at[end + side], [x, y, -0.27], atol=1e-12)


def test_steering_turns_about_the_wheel(rover):
    """The vertical through the wheel's centre: on level ground steering moves no load."""
    stance = rp.settle(rover, FLAT, joints={"steer_fl": 0.2, "steer_br": -0.9})
    assert stance.joints["steer_fl"] == pytest.approx(0.2)
    np.testing.assert_allclose(list(stance.loads.values()), stance.weight / 6, rtol=1e-6)


def test_body_rides_at_the_mean_of_its_rockers(rover):
    """A hump under the left front wheel: the rockers turn against each other about the body."""

    def hump(x, y):
        return 0.1 * np.exp(-((np.asarray(x) - 0.6) ** 2 + (np.asarray(y) - 0.6) ** 2) / 0.2**2)

    stance = rp.settle(rover, rp.Terrain.from_function(hump))
    assert stance.settled, stance.reason
    assert stance.joints["rocker_l"] == pytest.approx(-stance.joints["rocker_r"], abs=1e-9)
    assert stance.joints["rocker_l"] < -0.02
    assert stance.rpy[1] == pytest.approx(stance.joints["rocker_l"], rel=0.3)
    assert sum(stance.loads.values()) == pytest.approx(stance.weight, rel=1e-9)


@pytest.mark.parametrize("heading", [0.0, 1.1, math.pi / 2, 2.5])
def test_on_a_plane_no_passive_joint_turns(rover, heading):
    slope = math.radians(10)
    stance = rp.settle(rover, rp.Terrain.slope(10), yaw=heading)
    assert stance.settled, stance.reason
    for joint in rover.passive:
        assert stance.joints[joint] == pytest.approx(0.0, abs=1e-8)
    roll, pitch, _ = stance.rpy
    up = np.array([math.sin(pitch), -math.sin(roll) * math.cos(pitch), math.cos(roll) * math.cos(pitch)])
    assert up[2] == pytest.approx(math.cos(slope), abs=1e-9)


def test_mirrored_ground_mirrors_the_stance(rover):
    def ground(x, y):
        return 0.05 * np.sin(2.1 * np.asarray(x) + 0.4) * np.cos(1.7 * np.asarray(y) - 0.6)

    one = rp.settle(rover, rp.Terrain.from_function(ground))
    other = rp.settle(rover, rp.Terrain.from_function(lambda x, y: ground(x, -np.asarray(y))))
    assert one.settled
    assert one.rpy[0] == pytest.approx(-other.rpy[0], abs=1e-7)
    assert one.rpy[1] == pytest.approx(other.rpy[1], abs=1e-7)
    for wheel in WHEELS:
        twin = wheel[0] + ("r" if wheel[1] == "l" else "l")
        assert one.loads[wheel] == pytest.approx(other.loads[twin], abs=1e-3)
