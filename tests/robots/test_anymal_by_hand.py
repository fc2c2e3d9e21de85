"""ANYmal B on flat ground at its reference posture: loads, polygon and margins from the URDF's XML by hand.

Nothing here comes from the package or from Pinocchio but the answers that are judged: positions are products
of 4 x 4 matrices along the XML's joints, margins are the papers' definitions, by rotation and search.
"""

import itertools
import math

import numpy as np
import pytest
from scipy.optimize import minimize_scalar
from urdf_by_hand import Shape, Standing

import rover_pin as rp

LEGS = ("LF", "LH", "RH", "RF")  # round the polygon as seen from above, against the clock
STANDING = {
    "LF": (-0.1, 0.7, -1.0), "RF": (0.1, 0.7, -1.0), "LH": (-0.1, -0.7, 1.0), "RH": (0.1, -0.7, 1.0)
}  # fmt: skip
"""HAA, HFE and KFE of `standing` in anymal.srdf, rad."""


@pytest.fixture(scope="module", params=[(0.0, 0.0), (12.0, 0.5)], ids=["flat", "slope"])
def pair(request):
    """The stance, and the same by hand."""
    degrees, yaw = request.param
    rover = rp.load("example:anymal_b")
    joints = ("HAA", "HFE", "KFE")
    posture = {f"{leg}_{j}": v for leg in LEGS for j, v in zip(joints, STANDING[leg], strict=True)}
    balls = [Shape(f"{leg}_FOOT", f"{leg}_FOOT", (0.0, 0.0, 0.02325), 0.031, 0.6) for leg in LEGS]
    hand = Standing(rover.source, posture, balls, math.radians(degrees), yaw)
    return rp.settle(rover, rp.Terrain.slope(degrees), yaw=yaw), hand


def edges(hand):
    """(name, start, end) round the polygon."""
    corners = [(shape.name, point) for shape, point in zip(hand.shapes, hand.points, strict=True)]
    return [(f"{a}-{b}", p, q) for (a, p), (b, q) in itertools.pairwise([*corners, corners[0]])]


def turned(vector, axis, angle):
    """A vector turned about a unit axis (Rodrigues)."""
    c, s = math.cos(angle), math.sin(angle)
    return c * vector + s * np.cross(axis, vector) + (1 - c) * (axis @ vector) * axis


def unit(vector):
    return vector / np.linalg.norm(vector)


def test_loads_add_up_to_the_weight_and_are_those_of_least_squares(pair):
    stance, hand = pair
    assert str(stance.status) == "settled"
    assert stance.weight == pytest.approx(hand.weight, rel=1e-12)
    assert sum(stance.loads.values()) == pytest.approx(hand.weight, rel=1e-12)
    by_hand = {shape.name: load for shape, load in zip(hand.shapes, hand.loads, strict=True)}
    assert stance.loads == pytest.approx(by_hand, abs=1e-9)
    assert min(hand.loads) > 0.0
    assert stance.redundant == 1  # four loads, three equations
    np.testing.assert_allclose(stance.com, hand.com, atol=1e-12)
    np.testing.assert_allclose(stance.rpy, hand.rpy, atol=1e-10)


def test_the_polygon_has_four_feet_and_its_margin_is_the_distance_to_the_nearest_edge(pair):
    stance, hand = pair
    for foot, point in zip([s.name for s in hand.shapes], hand.points, strict=True):
        contact = next(c for c in stance.contacts if c.wheel == foot)
        np.testing.assert_allclose(contact.point, point, atol=1e-9)
    margin = rp.stability(stance, ["polygon"])["polygon"]
    distances = {}
    for name, start, end in edges(hand):
        along = unit((end - start)[:2])
        away = (hand.com - start)[:2]
        foot_of = away - (away @ along) * along  # from the edge's line to the centre of mass, seen from above
        inward = np.array([-along[1], along[0]])
        distances[name] = math.copysign(np.linalg.norm(foot_of), foot_of @ inward)
    assert margin.edges == pytest.approx(distances, abs=1e-10)
    assert margin.limiting == min(distances, key=distances.get)
    assert min(distances.values()) > 0.15
    assert rp.stability(stance, ["zmp"])["zmp"].edges == pytest.approx(distances, abs=1e-10)


def test_tip_angles_turn_the_centre_of_mass_over_the_edge(pair):
    """About the edge as seen from above, by the tip angle, it stands vertically over the edge."""
    stance, hand = pair
    margin = rp.stability(stance, ["tip"])["tip"]
    for name, start, end in edges(hand):
        along = unit((end - start) * [1, 1, 0])
        beside = start + (end - start) * ((hand.com - start) @ along) / ((end - start) @ along)
        over = turned(hand.com - beside, along, margin.edges[name])
        assert 0.0 < margin.edges[name] < math.pi / 2
        np.testing.assert_allclose(over, [0.0, 0.0, np.linalg.norm(hand.com - beside)], atol=1e-10)


def test_force_angle_of_papadopoulos_and_rey(pair):
    stance, hand = pair
    force, expected = np.array([0.0, 0.0, -hand.weight]), {}
    for name, start, end in edges(hand):
        along = unit(end - start)
        across = np.eye(3) - np.outer(along, along)
        to_edge, pull = across @ (start - hand.com), across @ force
        angle = math.acos(unit(to_edge) @ unit(pull))
        sign = 1.0 if np.cross(unit(pull), unit(to_edge)) @ along < 0.0 else -1.0
        arm = -to_edge + (to_edge @ unit(pull)) * unit(pull)
        expected[name] = sign * angle * np.linalg.norm(arm) * np.linalg.norm(pull)
    margin = rp.stability(stance, ["force_angle"])["force_angle"]
    assert margin.edges == pytest.approx(expected, abs=1e-9)
    assert margin.value == pytest.approx(min(expected.values()), abs=1e-9)
    assert margin.value > 0.0


def test_energy_margin_is_the_height_the_centre_of_mass_must_climb(pair):
    """The most height on its way round each edge, by search over the angle (Messuri and Klein)."""
    stance, hand = pair
    margin = rp.stability(stance, ["energy"])["energy"]
    climbs = {}
    for name, start, end in edges(hand):
        along, arm = unit(end - start), hand.com - start

        def fallen(angle, along=along, arm=arm):
            return -turned(arm, along, angle)[2]

        best = minimize_scalar(fallen, bounds=(0.0, math.pi / 2), method="bounded", options={"xatol": 1e-9})
        climbs[name] = -best.fun - arm[2]
    assert margin.edges == pytest.approx(climbs, abs=1e-9)
    assert margin.details["energy_j"] == pytest.approx(hand.weight * min(climbs.values()), abs=1e-6)
