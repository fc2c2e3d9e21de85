"""Stances known by hand: thirds, least squares, the six-wheeler, and where rovers tip on a slope."""

import math

import numpy as np
import pinocchio as pin
import pytest
from little_rover import fixture, four_wheels
from scipy.optimize import brentq

import rover_pin as rp

FLAT = rp.Terrain.flat()
SMALLEST = 2e-3  # deg about the closed form


def at_zero(rover):
    """Centre of mass and the wheels' lowest points in the root frame, all joints at zero."""
    data = rover.model.createData()
    q = np.zeros(rover.model.nv)
    com = np.array(pin.centerOfMass(rover.model, data, q))
    pin.forwardKinematics(rover.model, data, q)
    feet = {}
    for wheel in rover.wheels:
        center = data.oMi[wheel.joint].act(np.array(wheel.center))
        feet[wheel.name] = center - [0, 0, wheel.radius]
    return com, feet


def tipping_slope(rover, yaw, edges):
    """Degrees at which the centre of mass, seen along gravity, crosses an edge; and the edge.

    On the plane every wheel's lowest point touches. In the root frame gravity leans downhill, away from
    u = (cos b, -sin b) with tan b = cos(slope) tan(yaw), since yaw is counted in the horizontal: the point
    c - h tan(slope) u in the wheels' plane leaves the polygon.
    """
    com, feet = at_zero(rover)
    height = com[2] - next(iter(feet.values()))[2]

    def room(edge, slope):
        a, b = edge
        along = feet[b][:2] - feet[a][:2]
        inward = np.array([-along[1], along[0]]) / np.linalg.norm(along)
        turned = math.atan2(math.cos(slope) * math.sin(yaw), math.cos(yaw))
        uphill = np.array([math.cos(turned), -math.sin(turned)])
        return inward @ (com[:2] - height * math.tan(slope) * uphill - feet[a][:2])

    found = {}
    for edge in edges:
        assert room(edge, 0.0) > 0, "edges run counterclockwise"
        if room(edge, 1.5) < 0:
            found[edge] = math.degrees(brentq(lambda slope, e=edge: room(e, slope), 0.0, 1.5, xtol=1e-12))
    edge = min(found, key=found.get)
    return found[edge], edge


BOX = (("bl", "br"), ("br", "fr"), ("fr", "fl"), ("fl", "bl"))


def test_thirds_share_the_weight():
    rover = fixture("thirds")
    stance = rp.settle(rover, FLAT)
    assert stance.settled
    for wheel, load in stance.loads.items():
        assert load == pytest.approx(stance.weight / 6, rel=1e-6), wheel
    assert stance.redundant == 0


def test_six_wheeler_shares_its_weight():
    stance = rp.settle(rp.load("hit_mrii"), FLAT, posture="home")
    assert stance.settled
    assert len(stance.loads) == 6
    for wheel, load in stance.loads.items():
        assert load == pytest.approx(367.875, abs=0.01), wheel


def test_six_wheeler_raised():
    stance = rp.settle(rp.load("hit_mrii"), FLAT, posture={"clearance": 0.48})
    at = {contact.wheel: contact.point for contact in stance.contacts}
    for side in "LR":
        assert math.degrees(stance.joints[f"{side}_act"]) == pytest.approx(39.108, abs=0.02)
        base = at[f"{side}F"] - at[f"{side}M"]
        assert 1e3 * math.hypot(*base[:2]) == pytest.approx(525.18, abs=0.1)
    model, data = stance.rover.model, stance.rover.model.createData()
    pin.forwardKinematics(model, data, np.array(stance.configuration))
    lowest = min(data.oMi[p.joint].act(np.array(p.point))[2] for p in stance.rover.belly)
    assert lowest == pytest.approx(0.48, abs=1e-6)


def test_a_square_shares_its_weight_in_quarters(tmp_path):
    rover = four_wheels(mass=40).load(tmp_path)
    stance = rp.settle(rover, FLAT)
    assert stance.settled
    assert stance.redundant == 1
    for load in stance.loads.values():
        assert load == pytest.approx(stance.weight / 4, rel=1e-9)


def test_three_of_a_rigid_four_carry_on_uneven_ground():
    """Three supports determine three loads: the ones that moments about the centre of mass ask for."""
    rover = fixture("rigid4")
    ground = rp.Terrain.rough(2, 0.05, 0.8)
    for x, y, yaw in [(0, 0, 0), (1, 0.5, 1), (2, 1, 2), (3, 1.5, 3), (-2, 3, -1)]:
        stance = rp.settle(rover, ground, x=x, y=y, yaw=yaw)
        assert stance.settled, stance.reason
        assert stance.redundant == 0
        carrying = [contact for contact in stance.contacts if contact.load > 0]
        assert len(carrying) == 3
        points = np.array([contact.point for contact in carrying])
        rows = np.vstack([np.ones(3), points[:, 0], points[:, 1]])
        right = stance.weight * np.array([1, stance.com[0], stance.com[1]])
        np.testing.assert_allclose([c.load for c in carrying], np.linalg.solve(rows, right), rtol=1e-9)
        (idle,) = [wheel for wheel, load in stance.loads.items() if load == 0]
        assert stance.gaps[idle] > 1e-6


@pytest.mark.parametrize("yaw", [0.0, 0.6, math.pi / 2, 2.2, math.pi, -2.0, -math.pi / 2])
def test_a_rigid_rover_tips_where_its_centre_of_mass_leaves_the_polygon(yaw):
    rover = fixture("rigid4")
    slope, edge = tipping_slope(rover, yaw, BOX)
    before = rp.settle(rover, rp.Terrain.slope(slope - SMALLEST), yaw=yaw)
    assert before.settled, before.reason
    beyond = rp.settle(rover, rp.Terrain.slope(slope + SMALLEST), yaw=yaw)
    assert beyond.status is rp.Status.TIPS, beyond
    assert beyond.limiting in set(rover_names(rover)) - set(edge)
    assert beyond.limiting in beyond.reason
    assert not beyond.loads


def rover_names(rover):
    return [wheel.name for wheel in rover.wheels]


@pytest.mark.parametrize("slope", [55.0, 65.0, 80.0])
def test_far_beyond_the_tipping_slope_it_still_tips(slope):
    for yaw in (math.pi / 2, -math.pi / 2):
        stance = rp.settle(fixture("rigid4"), rp.Terrain.slope(slope), yaw=yaw)
        assert stance.status is rp.Status.TIPS, stance


@pytest.mark.parametrize("name", ["thirds", "rocker_bogie"])
def test_a_rocker_bogie_tips_sideways_where_its_centre_of_mass_leaves_the_polygon(name):
    rover = rp.load(name) if name == "rocker_bogie" else fixture(name)
    slope, _ = tipping_slope(rover, math.pi / 2, BOX)
    before = rp.settle(rover, rp.Terrain.slope(slope - SMALLEST), yaw=math.pi / 2)
    assert before.settled, before.reason
    beyond = rp.settle(rover, rp.Terrain.slope(slope + SMALLEST), yaw=math.pi / 2)
    assert beyond.status is rp.Status.TIPS, beyond
    assert beyond.limiting in {"fr", "mr", "br", "fl", "ml", "bl", *rover.joints}


def test_a_bogie_goes_over_before_its_rover():
    """Straight up: its pivot is 0.3 m over the ground and 0.5 m from either wheel: atan(0.5 / 0.3)."""
    rover = fixture("thirds")
    slope = math.degrees(math.atan(0.5 / 0.3))
    before = rp.settle(rover, rp.Terrain.slope(slope - 0.01))
    assert before.settled, before.reason
    beyond = rp.settle(rover, rp.Terrain.slope(slope + 0.01))
    assert beyond.status is rp.Status.TIPS, beyond
    assert beyond.limiting in {"ml", "mr", "bogie_l", "bogie_r"}


def test_the_loads_of_thirds_on_a_slope():
    """Vertical forces, seen from the slope: each lever is shifted by its height times the slope."""
    rover = fixture("thirds")
    for slope in (-20, 10, 25, 40):
        t = math.tan(math.radians(slope))
        stance = rp.settle(rover, rp.Terrain.slope(slope))
        assert stance.settled
        for side in "lr":
            f, m, b = (stance.loads[end + side] for end in "fmb")
            assert m * (0.5 + 0.3 * t) == pytest.approx(b * (0.5 - 0.3 * t), rel=1e-5)
            # about the hinge: wheel in front, bogie's pivot behind and 0.1 m lower, body 0.1 m higher
            behind = (m + b) * (0.5 - 0.1 * t) - (f + m + b) * 0.1 * t
            assert f * (1 + 0.4 * t) == pytest.approx(behind, rel=1e-5)


def test_tilt_beyond_80_deg_tips(tmp_path):
    """Its centre of mass in the contact plane never leaves the polygon; 80 deg is the end."""
    rover = four_wheels(com=(0, 0, -0.3), drop=0.2, radius=0.1).load(tmp_path)
    assert rp.settle(rover, rp.Terrain.slope(79)).settled
    assert rp.settle(rover, rp.Terrain.slope(81)).status is rp.Status.TIPS


def test_what_is_held_stays():
    ground = rp.Terrain.rough(5, 0.04, 0.8)
    rover = rp.load("hit_mrii")
    stance = rp.settle(rover, ground, x=0.7, y=-1.3, yaw=4.0, joints={"L_act": 0.2, "LF_st": 0.3})
    assert stance.settled, stance.reason
    assert tuple(stance.position[:2]) == (0.7, -1.3)
    assert stance.rpy[2] == 4.0
    assert stance.joints["L_act"] == 0.2
    assert stance.joints["LF_st"] == 0.3
    assert stance.joints["R_act"] == 0.0
    for wheel in rover.wheels:
        assert stance.joints[wheel.drive] == 0.0


def test_height_of_the_ground_lifts_and_nothing_else():
    rover = fixture("four_bar")
    low, high = rp.settle(rover, FLAT), rp.settle(rover, rp.Terrain.flat(3.7))
    assert high.position[2] - low.position[2] == pytest.approx(3.7, abs=1e-12)
    for wheel, load in low.loads.items():
        assert high.loads[wheel] == pytest.approx(load, abs=1e-8)
