"""Heights of lifted wheels over the rocker's angle, and lifts on uneven ground."""

import math

import numpy as np
import pytest
from hit_mrii_closed_form import Machine
from hit_mrii_lifts import Lift
from lifting_cases import SIDES

import rover_pin as rp
from rover_pin.control.lifting import LiftPlan, lift_height, plan_lift
from rover_pin.errors import InputError

MACHINE = Machine()


@pytest.fixture(scope="module")
def rover():
    return rp.load("hit_mrii")


def test_front_wheel_in_closed_form(rover):
    """F (sin a0 - sin a) + P (cos a0 - cos a), the arm turned by (1 + z) times the motor's turn."""
    u = MACHINE.motor_angle(0.485)
    a0 = MACHINE.angles(u)[0]
    turns = np.array([[-0.3, -0.1], [0.0, 0.05]])
    a = a0 + (1.0 + MACHINE.gear) * turns
    f, p = MACHINE.front_arm, MACHINE.pillar
    expected = f * (np.sin(a0) - np.sin(a)) + p * (np.cos(a0) - np.cos(a))
    heights = lift_height(rover, SIDES, "RF", u + turns, {"L_act": u, "R_act": u})
    assert heights.shape == (2, 2)
    np.testing.assert_allclose(heights, expected, atol=1e-8)


@pytest.mark.parametrize("wheel", ["RF", "RM", "RB"])
def test_every_wheel_against_gaps_closed_by_hand(rover, wheel):
    u = MACHINE.motor_angle(0.3)
    bogie = MACHINE.angles(u)[1] - MACHINE.theta20
    angles = u + np.linspace(-0.25, 0.25, 6)
    expected = [Lift((u, v), (None, bogie), (wheel,)).solve()[0][wheel] for v in angles]
    heights = lift_height(rover, SIDES, wheel, angles, {"L_act": u, "R_act": u})
    np.testing.assert_allclose(heights, expected, atol=1e-8)
    rising = 1.0 if wheel == "RM" else -1.0
    assert np.all(np.diff(rising * heights) > 0.0)


def test_the_plans_angle_gives_the_plans_height(rover):
    plan = plan_lift(rover, SIDES, ["LB"], 0.13, posture={"clearance": 0.2})
    height = lift_height(rover, SIDES, "LB", plan.rockers["L_act"], posture={"clearance": 0.2})
    assert float(height) == pytest.approx(0.13, abs=1e-7)


@pytest.mark.parametrize(
    ("angles", "message"),
    [
        ([0.1, math.nan], "R_act: angles must be finite numbers; give radians"),
        ([0.1, 1.5], "R_act: beyond the rocker's limits (got '1.5 rad'); stay within -0.8 to 1.4 rad"),
    ],
)
def test_angles_that_the_rocker_cannot_take(rover, angles, message):
    with pytest.raises(InputError) as caught:
        lift_height(rover, SIDES, "RF", angles)
    assert str(caught.value) == message


@pytest.mark.parametrize(
    ("terrain", "place"),
    [
        (rp.Terrain.slope(8.0), {}),
        (rp.Terrain.slope(8.0), {"yaw": 0.7}),
        (rp.Terrain.parse("rough:3,0.02,0.8"), {"x": 8.0, "y": 9.0, "yaw": 0.4}),
    ],
)
def test_lifts_on_uneven_ground_stand(rover, terrain, place):
    plan = plan_lift(rover, SIDES, ["RF"], 0.1, terrain=terrain, posture={"clearance": 0.485}, **place)
    assert isinstance(plan, LiftPlan), plan
    top = plan.top
    assert plan.heights["RF"] == pytest.approx(0.1, abs=1e-8)
    for stance in plan.stances:
        assert stance.settled
        assert max(stance.residuals.values()) < 1e-6
        assert stance.gaps["RF"] > 0.0
    x, y = wheel_centre(top, "RF")[:2]
    lowest = lowest_point(top, "RF")
    assert lowest - float(terrain.height(x, y)) == pytest.approx(0.1, abs=1e-7)
    assert sum(top.loads.values()) == pytest.approx(top.weight, rel=1e-9)


def wheel_centre(stance, name):
    import pinocchio as pin

    data = stance.rover.model.createData()
    pin.forwardKinematics(stance.rover.model, data, np.array(stance.configuration))
    wheel = next(w for w in stance.rover.wheels if w.name == name)
    return data.oMi[wheel.joint].act(np.array(wheel.center))


def lowest_point(stance, name):
    """The least height over a fine circle swept by the tread's ball, its axis read from Pinocchio's frame."""
    import pinocchio as pin

    model = stance.rover.model
    data = model.createData()
    pin.framesForwardKinematics(model, data, np.array(stance.configuration))
    rotation = data.oMf[model.getFrameId(f"{name}_wheel")].rotation
    angles = np.linspace(0.0, 2.0 * np.pi, 20001)
    ring = rotation @ np.array([0.12 * np.cos(angles), 0.0 * angles, 0.12 * np.sin(angles)])
    return float(wheel_centre(stance, name)[2] + ring[2].min() - 0.03)
