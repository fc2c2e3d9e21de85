"""Steering about instant centres on and off the middle, against geometry."""

import math

import numpy as np
import pytest
from places import ground, resting, rover

import rover_pin as rp
from rover_pin.errors import InputError
from rover_pin.kinematics.advance import Sliding, advance
from rover_pin.kinematics.instant import Bodies
from rover_pin.kinematics.model import complete
from rover_pin.kinematics.steering import Twist, steering_for, steering_joints, turning_centre

CENTRES = [(0.0, 2.0), (0.3, 1.5), (-0.4, -1.8), (0.0, 0.0), (1.2, 3.0)]


def steered(angles, clearance=None):
    """The rover with its steering at angles, the base where it was."""
    posture = None if clearance is None else {"clearance": clearance}
    start = rp.settle(rover("hit_mrii"), ground("flat"), posture=posture)
    joints = {name: start.joints[name] for name in ("L_act", "R_act")} | angles
    stance = rp.settle(rover("hit_mrii"), ground("flat"), joints=joints)
    return Bodies(rover("hit_mrii"), ground("flat")).at(np.array(stance.configuration))


def test_every_wheel_has_its_joint():
    found = steering_joints(resting("hit_mrii", "flat"))
    assert found == {wheel: f"{wheel}_st" for wheel in ("LF", "LM", "LB", "RF", "RM", "RB")}
    assert set(steering_joints(resting("rigid4", "flat"))) <= {w.name for w in rover("rigid4").wheels}


@pytest.mark.parametrize("centre", CENTRES)
def test_axes_meet_in_the_centre(centre):
    at = Bodies(rover("hit_mrii"), ground("flat")).at(
        np.array(rp.settle(rover("hit_mrii"), ground("flat")).configuration)
    )
    x, y = centre
    angles = steering_for(at, Twist.about(x, y, 0.1))
    for i, wheel in enumerate(at.rover.wheels):
        dx, dy = at.centers[i, 0] - x, at.centers[i, 1] - y
        expected = math.atan2(dx, -dy)  # a wheel rolls across the line to the centre
        assert math.remainder(angles[f"{wheel.name}_st"] - expected, math.pi) == pytest.approx(0.0, abs=1e-9)
    assert turning_centre(steered(angles)) == pytest.approx(centre, abs=1e-9)


def test_leaning_axes_are_refined():
    """At 480 mm the front steering axes lean by 18 deg; the axes of all wheels still meet."""
    start = steered({}, 0.48)
    angles = steering_for(start, Twist.about(0.1, 2.0, 0.1))
    q = start.q.copy()
    q[[start.rover.column[joint] for joint in angles]] = list(angles.values())
    turned = start.bodies.at(q)
    twist = Twist.about(0.1, 2.0, 0.1)
    from rover_pin.kinematics.rolling import contact_rows

    rows = contact_rows(turned, np.arange(6), ("slip",))
    assert rows @ twist.velocity(turned) == pytest.approx(0.0, abs=1e-9)


def test_a_quarter_circle_without_sliding():
    angles = steering_for(steered({}), Twist.about(0.2, 1.5, 0.05))
    at = steered(angles)
    sliding, dt = Sliding(at), 0.05
    still = dict.fromkeys([*angles, "L_act", "R_act"], 0.0)
    twist = Twist.about(0.2, 1.5, 0.05)
    for _ in range(round(math.pi / 2 / 0.05 / dt)):
        motion = complete(at, {**still, "forward": twist.forward, "left": twist.left, "yaw": twist.yaw})
        assert motion.sliding < 1e-9
        at = advance(at, motion.velocity, dt)
        slid = sliding.step(at)
    assert np.max(slid) < 1e-5
    assert float(at.q[3]) == pytest.approx(math.pi / 2, abs=0.05 * dt)
    turned = np.array([[0.0, -1.0], [1.0, 0.0]])
    assert at.q[:2] == pytest.approx(np.array([0.2, 1.5]) - turned @ (0.2, 1.5), abs=0.02)


def test_crabbing():
    at = steered({})
    assert steering_for(at, Twist(left=0.1)) == pytest.approx(
        {f"{w}_st": math.pi / 2 for w in ("LF", "LM", "LB", "RF", "RM", "RB")}
    )
    assert all(abs(v) < 1e-12 for v in steering_for(at, Twist(forward=-0.1)).values())  # it rolls back


def test_the_suspension_may_move_meanwhile():
    """With rockers in motion a wheel is carried along too: no wheel slips at the angles found."""
    at = steered({}, 0.4)
    rates = {"L_act": -0.01, "R_act": -0.01}
    twist = Twist.about(0.0, 1.5, 0.02)
    angles = steering_for(at, twist, rates=rates)
    q = at.q.copy()
    q[[at.rover.column[joint] for joint in angles]] = list(angles.values())
    turned = at.bodies.at(q)
    known = {
        **dict.fromkeys(angles, 0.0),
        **rates,
        "forward": twist.forward,
        "left": twist.left,
        "yaw": twist.yaw,
    }
    assert complete(turned, known).sliding < 1e-5
    assert complete(turned, {**known, "L_act": 0.0, "R_act": 0.0}).sliding > 1e-4


def test_words():
    at = steered({})
    assert Twist.about(0.2, 1.5, 0.1).centre == pytest.approx((0.2, 1.5))
    assert Twist(forward=1.0).centre is None
    assert np.isnan(turning_centre(at)).all()
    with pytest.raises(InputError, match=r"instant centre: x: must be a finite number \(got nan\)"):
        Twist.about(np.nan, 1.0, 0.1)


def test_a_wheel_that_cannot_be_steered_there(make):
    parts = [make.link("base", 10.0)]
    wheels = []
    for name, x, y in (("a", 1, 1), ("b", 1, -1), ("c", -1, 1), ("d", -1, -1)):
        parts += [
            make.link(f"{name}_s", 0.1),
            make.link(f"{name}_w", 1.0),
            make.joint(f"{name}_st", "base", f"{name}_s", axis="0 0 1", xyz=f"{x} {y} 0", limits="-0.2 0.2"),
            make.joint(f"{name}_dr", f"{name}_s", f"{name}_w", "continuous"),
        ]
        wheels.append(f"  - {{name: {name}, frame: {name}_w, radius: 0.3, width: 0.1}}")
    sidecar = "actuated: [a_st, b_st, c_st, d_st, a_dr, b_dr, c_dr, d_dr]\nwheels:\n" + "\n".join(wheels)
    small = make.load(*parts, sidecar=sidecar)
    at = Bodies(small, ground("flat")).at(np.array(rp.settle(small, ground("flat")).configuration))
    with pytest.raises(InputError) as caught:
        steering_for(at, Twist.about(0.0, 2.0, 0.1))
    assert str(caught.value) == (
        "a_st: a cannot be steered to where it has to go (got '45 deg');"
        " the joint reaches from -11.46 to 11.46 deg"
    )
