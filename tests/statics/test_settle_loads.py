"""Loads: they carry the weight, scale with gravity, follow a payload, and are shared by least squares."""

import math

import numpy as np
import pytest
from little_rover import fixture, four_wheels

import rover_pin as rp

FLAT = rp.Terrain.flat()
NAMES = ("rocker_bogie", "hit_mrii", "thirds", "rigid4", "sprung4", "trailing4", "four_bar", "turnbuckle")


def named(name):
    return rp.load(name) if name in ("rocker_bogie", "hit_mrii") else fixture(name)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("seed", [1, 2])
def test_loads_carry_the_weight_on_any_terrain(name, seed):
    rover = named(name)
    ground = rp.Terrain.rough(seed, 0.03, 0.8)
    settled = 0
    generator = np.random.default_rng(seed)
    for _ in range(6):
        x, y = generator.uniform(-6, 6, 2)
        stance = rp.settle(rover, ground, x=x, y=y, yaw=generator.uniform(-3, 3))
        assert stance.status in (rp.Status.SETTLED, rp.Status.TIPS, rp.Status.GROUNDED), stance
        if not stance.settled:
            continue
        settled += 1
        assert sum(stance.loads.values()) == pytest.approx(stance.weight, rel=1e-9)
        assert min(stance.loads.values()) >= 0.0
        assert stance.residuals["equilibrium"] < 1e-9
        assert stance.residuals["gap_m"] < 1e-6
        assert stance.residuals["loop_m"] < 1e-9
        assert stance.residuals["complementarity"] < 1e-8
        moment = sum(c.load * (c.point - stance.com) for c in stance.contacts)
        np.testing.assert_allclose(moment[:2], 0.0, atol=1e-8 * stance.weight)
        for contact in stance.contacts:
            assert abs(contact.gap) <= 1e-6
            assert np.linalg.norm(contact.normal) == pytest.approx(1.0, abs=1e-12)
            assert ground.height(*contact.point[:2]) == pytest.approx(contact.point[2], abs=1e-9)
    assert settled >= 4


@pytest.mark.parametrize("name", ["rocker_bogie", "rigid4", "turnbuckle"])
def test_loads_scale_with_gravity(name):
    rover, ground = named(name), rp.Terrain.rough(1, 0.03, 0.8)
    earth = rp.settle(rover, ground, x=0.4, y=0.2)
    moon = rp.settle(rover, ground, x=0.4, y=0.2, gravity=1.62)
    assert earth.settled
    np.testing.assert_allclose(moon.configuration, earth.configuration, atol=1e-10)
    for wheel, load in earth.loads.items():
        assert moon.loads[wheel] == pytest.approx(load * 1.62 / 9.81, abs=1e-7)
    assert moon.weight == pytest.approx(rover.mass * 1.62)


def test_springs_give_less_on_the_moon():
    earth, moon = (rp.settle(fixture("sprung4"), FLAT, gravity=g) for g in (9.81, 1.62))
    assert earth.joints["slide_fl"] == pytest.approx(40 * 9.81 / 16000, abs=1e-9)
    assert moon.joints["slide_fl"] == pytest.approx(40 * 1.62 / 16000, abs=1e-9)


@pytest.mark.parametrize("place", [(0.3, 0.0, 0.0), (0.0, 0.25, 0.4), (-0.2, -0.1, 1.0)])
def test_a_payload_shifts_loads_as_the_lever_rule_says(tmp_path, place):
    """Half lengths 0.5 and 0.4: a load's share is 1/4 (1 + x X/0.25 + y Y/0.16)."""
    rover = four_wheels(mass=40).load(tmp_path)
    bare, laden = rp.settle(rover, FLAT), rp.settle(rover.with_payload([(10.0, place)]), FLAT)
    assert laden.weight - bare.weight == pytest.approx(98.1)
    for wheel, load in laden.loads.items():
        x, y = (0.5 if wheel[0] == "f" else -0.5), (0.4 if wheel[1] == "l" else -0.4)
        more = 98.1 / 4 * (1 + place[0] * x / 0.25 + place[1] * y / 0.16)
        assert load - bare.loads[wheel] == pytest.approx(more, abs=1e-8)


def test_a_payload_high_up_tips_earlier(tmp_path):
    rover = four_wheels(mass=40).load(tmp_path)
    laden = rover.with_payload([(20.0, (0, 0, 1.5))])
    ground = rp.Terrain.slope(30)
    assert rp.settle(rover, ground, yaw=math.pi / 2).settled
    tipping = math.degrees(math.atan(0.4 / (0.3 + 1.5 * 20 / laden.mass)))
    assert tipping < 30
    assert rp.settle(laden, rp.Terrain.slope(tipping - 0.05), yaw=math.pi / 2).settled
    assert rp.settle(laden, ground, yaw=math.pi / 2).status is rp.Status.TIPS


def test_a_payload_outside_the_wheels_tips_on_level_ground(tmp_path):
    rover = four_wheels(mass=40).load(tmp_path).with_payload([(60.0, (1.5, 0.0, 0.1))])
    stance = rp.settle(rover, FLAT)
    assert stance.status is rp.Status.TIPS, stance
    assert stance.limiting in ("bl", "br")


def least_squares(points, weight, com):
    """Loads of least sum of squares, none negative, that balance weight and moments."""
    from scipy.optimize import minimize

    rows = np.vstack([np.ones(len(points)), points[:, 0], points[:, 1]])
    right = np.array([1.0, com[0], com[1]])
    best = minimize(
        lambda n: n @ n,
        np.full(len(points), 1 / len(points)),
        jac=lambda n: 2 * n,
        bounds=[(0, None)] * len(points),
        constraints={"type": "eq", "fun": lambda n: rows @ n - right, "jac": lambda n: rows},
        method="SLSQP",
        options={"ftol": 1e-15, "maxiter": 300},
    )
    assert best.success
    return best.x * weight


@pytest.mark.parametrize("com", [(0.0, 0.0, 0.0), (0.2, 0.1, 0.0), (0.35, 0.2, 0.1), (-0.3, -0.05, -0.1)])
@pytest.mark.parametrize("slope", [0.0, 15.0])
def test_redundant_loads_are_the_least_squares(tmp_path, com, slope):
    rover = four_wheels(com=com).load(tmp_path)
    stance = rp.settle(rover, rp.Terrain.slope(slope), yaw=0.7)
    assert stance.settled, stance.reason
    assert stance.redundant == 1
    points = np.array([contact.point for contact in stance.contacts])
    expected = least_squares(points, stance.weight, stance.com)
    np.testing.assert_allclose([c.load for c in stance.contacts], expected, atol=1e-4 * stance.weight)
    total = sum(c.load**2 for c in stance.contacts)
    assert total <= float(expected @ expected) * (1 + 1e-9)


def test_a_legged_robot_shares_by_least_squares(tmp_path):
    """Six feet of a rigid plate: three more than equilibrium determines."""
    from little_rover import Builder

    made = Builder("plate").link("base_link", 30, (0.1, -0.05, 0))
    places = {f"foot{i}": (0.5 * math.cos(i), 0.5 * math.sin(i), -0.2) for i in range(6)}
    for name, place in places.items():
        made.link(name, 1e-6).joint(f"hip_{name}", "base_link", name, place, limits=(-1, 1))
    made.say(actuated=[f"hip_{name}" for name in places])
    made.say(contacts=[{"name": n, "frame": n, "radius": 0.02, "friction": 0.7} for n in places])
    stance = rp.settle(made.load(tmp_path), FLAT)
    assert stance.settled, stance.reason
    assert stance.redundant == 3
    assert stance.position[2] == pytest.approx(0.22, abs=1e-10)
    points = np.array([contact.point for contact in stance.contacts])
    expected = least_squares(points, stance.weight, stance.com)
    np.testing.assert_allclose([c.load for c in stance.contacts], expected, atol=1e-4 * stance.weight)


def test_loads_of_a_wheel_are_the_sum_of_its_contacts():
    ground = rp.Terrain.rough(7, 0.05, 0.5)
    stance = rp.settle(rp.load("rocker_bogie"), ground, x=1.0, y=1.0)
    assert stance.settled, stance.reason
    for wheel, load in stance.loads.items():
        assert load == sum(c.load for c in stance.contacts if c.wheel == wheel)


def test_only_settled_has_loads():
    stance = rp.settle(fixture("rigid4"), rp.Terrain.slope(75), yaw=math.pi / 2)
    assert not stance.settled
    assert dict(stance.loads) == {}
    assert stance.contacts == ()
    assert dict(stance.residuals) == {}
    assert stance.reason
