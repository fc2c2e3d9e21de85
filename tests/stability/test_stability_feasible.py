"""The feasible region: closed forms of drives and legs, linear programs as oracle."""

import dataclasses
import math

import numpy as np
import pytest
from com_planes import reach
from hand_made import rigid
from little_rover import fixture
from standing import FLAT, FOUR, SQUARE

import rover_pin as rp
from rover_pin.stability.measure import Standing
from rover_pin.stability.measures.feasible import limited_motors
from rover_pin.stability.registry import MEASURES
from rover_pin.stability.report import inapplicable
from rover_pin.statics.balance import balance
from rover_pin.statics.com_reach import ComReach, Motors
from rover_pin.statics.friction_problem import friction_problem


def crest(beta, mu=5.0):
    """Front wheels on ground that falls ahead, rear ones on ground that falls behind, normals outwards."""
    normals = [(math.copysign(math.sin(beta), x), 0.0, math.cos(beta)) for x, _, _ in SQUARE]
    return rigid(SQUARE, normals, (0.0, 0.0, 0.3), mu=mu, wheels=FOUR)


@pytest.mark.parametrize(("torque", "beta"), [(2.0, 0.4), (0.5, 0.8)])
def test_on_a_crest_the_drives_limit_how_far_forward(torque, beta):
    # sum of horizontal forces: (P_f - P_r) tan(beta) + F / cos(beta) = 0 with P vertical, F rolling in all
    levers = 0.1 * np.eye(4)
    motors = Motors((), np.zeros(0), [f"drive_{w}" for w in FOUR], levers, np.full(4, torque))
    expected = 4.0 * torque / 0.1 / (500.0 * math.sin(beta))
    for sign in (1.0, -1.0):
        reach_of = ComReach(crest(beta), motors)
        found = reach_of.toward(np.array([sign, 0.0]))
        assert found.value == pytest.approx(expected, abs=1e-7)
        assert "drive_fl, drive_fr, drive_rl, drive_rr give all they can" in reach_of.limits(found)
    spent = ComReach(crest(beta), dataclasses.replace(motors, drive_effort=np.zeros(4)))
    assert spent.toward(np.array([1.0, 0.0])).value == pytest.approx(0.0, abs=1e-7)


def with_effort(rover, effort):
    """The rover with one effort at every driven joint."""
    limits = np.array(rover.effort)
    limits[[rover.column[name] for name in rover.actuated]] = effort
    return dataclasses.replace(rover, effort=limits)


def feasible_of(stance, effort):
    changed = dataclasses.replace(stance, rover=with_effort(stance.rover, effort))
    return MEASURES["feasible"].evaluate(Standing(changed))


def test_a_rocker_bogie_without_drives_stands_on_a_kite():
    # The body's moment W x about the hinges (x = 0) is shared by the rockers, a side at y = +-0.6 carries
    # L = W (1 +- y / 0.6) / 2: its front wheel (at 1) (L / 2 + W x / 2) / 1.5, its bogie (pivot at -1/2)
    # (L - W x / 2) / 1.5. None is negative where |y| <= 1.2 (x + 1/2) and |y| <= 0.6 (1 - x).
    rover = fixture("thirds")
    stance = rp.settle(rover, FLAT)
    margin = feasible_of(stance, 0.0)
    kite = [(-0.5, 0.0), (0.0, -0.6), (1.0, 0.0), (0.0, 0.6)]
    np.testing.assert_allclose(sorted(np.round(margin.outline, 5).tolist()), sorted(kite), atol=1e-5)
    assert margin.details["area_m2"] == pytest.approx(0.9, abs=1e-5)
    assert margin.value == pytest.approx(0.5 * 0.6 / math.hypot(0.5, 0.6), abs=1e-5)
    whole = MEASURES["region"].evaluate(Standing(stance))
    assert whole.details["area_m2"] > 1.1 * margin.details["area_m2"]
    some = [feasible_of(stance, effort).details["area_m2"] for effort in (0.5, 1.5, 4.0)]
    assert 0.9 < some[0] < some[1] < some[2] <= whole.details["area_m2"] + 1e-3


@pytest.mark.parametrize("name", ["thirds", "rigid4", "four_bar", "turnbuckle"])
@pytest.mark.parametrize("effort", [1e6, 1e30])
def test_with_huge_efforts_the_feasible_region_is_the_region(name, effort):
    stance = rp.settle(fixture(name), rp.Terrain.slope(10), yaw=0.5)
    assert stance.settled
    whole, feasible = MEASURES["region"].evaluate(Standing(stance)), feasible_of(stance, effort)
    assert whole.answered
    assert feasible.value == pytest.approx(whole.value, abs=1e-6)
    assert feasible.edges == pytest.approx(whole.edges, abs=1e-6)
    assert feasible.details["area_m2"] == pytest.approx(whole.details["area_m2"], rel=2e-3)


LEG, BODY = 0.5, 20.0


@pytest.fixture
def walker(make):
    """A body on four vertical legs that push; `walker(effort)` loads it."""

    def load(effort, feet=SQUARE):
        parts = [make.link("base", BODY)]
        contacts = []
        for name, (x, y, _) in zip(FOUR, feet, strict=True):
            limit = f'<limit lower="-1" upper="1" effort="{effort!r}" velocity="1"/>'
            parts += [
                make.link(f"leg_{name}", LEG),
                make.joint(
                    f"lift_{name}", "base", f"leg_{name}", "prismatic", axis="0 0 1", xyz=f"{x} {y} -0.5",
                    limits="", extra=limit,
                ),
            ]  # fmt: skip
            contacts.append(f"{{name: {name}, frame: leg_{name}, friction: 0.5}}")
        actuated = ", ".join(f"lift_{name}" for name in FOUR)
        return make.load(*parts, sidecar=f"actuated: [{actuated}]\ncontacts: [{', '.join(contacts)}]\n")

    return load


@pytest.mark.parametrize("share", [0.27, 0.3, 1 / 3])
def test_legs_that_push_with_little_more_than_their_share(walker, share):
    # a foot's load is its motor's force and the leg's own weight, at most `share` of the weight W: the two
    # front feet carry 2 share W at most, so x <= 4 share - 1; to share = 1/3 the corners are reached
    weight = (BODY + 4 * LEG) * 9.81
    stance = rp.settle(walker(share * weight - LEG * 9.81), FLAT)
    margin = rp.stability(stance, ["feasible", "region"])
    assert margin["region"].details["area_m2"] == pytest.approx(4.0, abs=1e-6)
    half = 4.0 * share - 1.0
    assert margin["feasible"].value == pytest.approx(half, abs=1e-6)
    assert margin["feasible"].details["area_m2"] == pytest.approx(4.0 * half**2, abs=1e-5)
    assert "give all they can" in margin["feasible"].note


def test_legs_too_weak_to_stand_have_no_region(walker):
    weight = (BODY + 4 * LEG) * 9.81
    margin = rp.stability(rp.settle(walker(0.2 * weight), FLAT), "feasible")["feasible"]
    assert margin.value == -math.inf
    assert margin.note == "friction and the motors' efforts hold no place of the centre of mass"


def test_joint_and_wheel_limits_against_linear_programs(walker):
    stance = rp.settle(walker(80.0), rp.Terrain.slope(12), yaw=0.7)
    for found in (stance, rp.settle(with_effort(fixture("thirds"), 0.5), rp.Terrain.rough(1, 0.03, 0.8))):
        motors = limited_motors(found)
        assert motors.joints or motors.drives
        plain = friction_problem(found, None)
        problem = dataclasses.replace(plain, rows=balance(found, motors.joints))
        lost = []
        for angle in (0.2, 1.9, 4.4):
            a = np.array([math.cos(angle), math.sin(angle)])
            oracle = reach(problem, a, motors.effort, motors.levers, motors.drive_effort)
            assert ComReach(problem, motors).toward(a).value == pytest.approx(oracle, abs=1e-6)
            lost.append(reach(dataclasses.replace(plain, rows=balance(found)), a) - oracle)
        assert min(lost) > -1e-6
        assert max(lost) > 1e-3


def test_a_rover_whose_motors_have_no_effort_has_no_feasible_region():
    stance = rp.settle(with_effort(fixture("rigid4"), np.inf), FLAT)
    assert "feasible" not in rp.stability(stance)
    said = inapplicable(stance.rover, ["feasible"])
    assert said == {"feasible": "no driven joint of rigid4 has an effort in the URDF"}
    assert MEASURES["feasible"].evaluate(Standing(stance)).value == -math.inf
