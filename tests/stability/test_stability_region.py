"""The support region: closed forms, linear programs as oracle, invariance, what fails closed."""

import dataclasses
import math

import numpy as np
import pinocchio as pin
import pytest
from com_planes import reach
from hand_made import HEXAGON, UP, on_slope, rigid, rigid_rows, rough, stance_of, turn
from hypothesis import given, settings
from hypothesis import strategies as st
from little_rover import fixture
from standing import FLAT, FOUR, SQUARE, area, measured, with_bogies

import rover_pin as rp
from rover_pin.stability.measure import Standing
from rover_pin.stability.outline import EIGHTHS
from rover_pin.stability.registry import MEASURES
from rover_pin.statics.balance import balance
from rover_pin.statics.com_reach import ComReach
from rover_pin.statics.friction_problem import make_problem


@pytest.mark.parametrize("com", [(0.0, 0.0, 0.4), (0.3, -0.6, 0.1)])
def test_on_flat_ground_the_region_of_a_rigid_rover_is_its_square(com):
    margin = measured("region", rigid(SQUARE, None, com, mu=0.5, wheels=FOUR), com)
    assert margin.value == pytest.approx(1.0 - max(abs(com[0]), abs(com[1])), abs=1e-6)
    assert margin.limiting in ({"right"} if com[1] else {"front", "left", "rear", "right"})
    assert tuple(margin.edges) == EIGHTHS
    assert margin.details["area_m2"] == pytest.approx(4.0, abs=1e-6)
    assert margin.details["area_at_most_m2"] == pytest.approx(4.0, abs=1e-6)
    assert area(margin.outline) == pytest.approx(4.0, abs=1e-6)
    assert sorted(np.round(margin.outline, 6).tolist()) == sorted(SQUARE[:, :2].tolist())
    if com[1]:
        assert margin.edges["front"] == pytest.approx(1.0 - com[0], abs=1e-6)
        assert margin.edges["left"] == pytest.approx(1.0 - com[1], abs=1e-6)
        assert margin.details["toward_rad"] == pytest.approx(-math.pi / 2, abs=1e-6)
        assert "fl, rl carry nothing" in margin.note


def test_past_the_edge_it_is_the_distance_and_negative():
    corner = measured("region", rigid(SQUARE, None, (1.3, 1.4, 0.3), wheels=FOUR), (1.3, 1.4, 0.3))
    assert corner.value == pytest.approx(-0.5, abs=1e-6)
    assert corner.limiting == "front_left"
    side = measured("region", rigid(SQUARE, None, (-1.2, 0.3, 0.3), wheels=FOUR), (-1.2, 0.3, 0.3))
    assert side.value == pytest.approx(-0.2, abs=1e-6)
    assert side.limiting == "rear"


@pytest.mark.parametrize("make", [rough, with_bogies])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_reach_against_linear_programs(make, seed):
    problem = make(seed)
    found = ComReach(problem)
    for angle in np.linspace(0.1, 2 * math.pi, 7):
        a = np.array([math.cos(angle), math.sin(angle)])
        assert found.toward(a).value == pytest.approx(reach(problem, a), abs=1e-6)


@pytest.mark.parametrize("seed", [1, 4])
def test_the_margin_is_the_least_reach_of_all_directions(seed):
    problem = with_bogies(seed)
    margin = measured("region", problem, yaw=0.4)
    found = ComReach(problem)

    def least(low, high):
        """By ever finer grids about the best direction."""
        for _ in range(6):
            angles = np.linspace(low, high, 25)
            values = [found.toward(np.array([math.cos(a), math.sin(a)])).value for a in angles]
            best, step = int(np.argmin(values)), angles[1] - angles[0]
            low, high = max(low, angles[best] - step), min(high, angles[best] + step)
        return values[best]

    for eighth, name in enumerate(EIGHTHS):
        middle = 0.4 + eighth * math.pi / 4
        assert margin.edges[name] == pytest.approx(
            least(middle - math.pi / 8, middle + math.pi / 8), abs=1e-6
        )
    assert margin.value == min(margin.edges.values())
    assert 0.0 <= margin.details["area_at_most_m2"] - margin.details["area_m2"] <= 1e-3 * area(margin.outline)
    assert area(margin.outline) == pytest.approx(margin.details["area_m2"], rel=1e-5)


def test_passive_joints_make_the_region_smaller():
    problem = rough(1)
    assert (
        measured("region", with_bogies(1)).details["area_at_most_m2"]
        < 0.9 * measured("region", problem).details["area_m2"]
    )


@settings(max_examples=12, deadline=None, derandomize=True)
@given(
    seed=st.integers(0, 10**6),
    yaw=st.floats(-3, 3),
    shift=st.tuples(*[st.floats(-20, 20)] * 3),
    scale=st.floats(0.1, 10),
    heavy=st.floats(0.05, 50),
)
def test_place_heading_and_units_do_not_matter(seed, yaw, shift, scale, heavy):
    rng = np.random.default_rng(seed)
    points = HEXAGON + rng.normal(size=(6, 3)) * 0.1
    normals = UP + rng.normal(size=(6, 3)) * 0.2
    com = rng.normal(size=3) * (0.2, 0.1, 0.1) + (0, 0, 0.4)
    R = turn(2, yaw)
    plain = rigid(points, normals, com, heading=(1, 0, 0))
    moved = rigid(
        (points @ R.T + shift) * scale, normals @ R.T, (R @ com + shift) * scale, 500.0 * heavy,
        heading=R @ (1, 0, 0), radius=0.1 * scale,
    )  # fmt: skip
    before, after = measured("region", plain), measured("region", moved, yaw=yaw)
    assert before.answered == after.answered
    if before.answered:
        assert after.edges == pytest.approx({e: v * scale for e, v in before.edges.items()}, abs=2e-6 * scale)
        assert after.details["area_m2"] == pytest.approx(before.details["area_m2"] * scale**2, rel=2e-3)
    assert measured("slack", moved).value == pytest.approx(
        measured("slack", plain).value * heavy, abs=1e-4 * heavy
    )


def test_they_fail_closed_with_a_reason():
    slope = on_slope(0.5, mu=0.4)
    margin = measured("region", slope)
    assert margin.value == -math.inf
    assert margin.note == "friction holds no place of the centre of mass"
    two = rigid(SQUARE[:2], None, (1.0, 0.0, 0.3), wheels=FOUR[:2])
    assert measured("region", two).note == "the region is a line"
    one = rigid(SQUARE[:1], None, (1.0, 1.0, 0.3), wheels=FOUR[:1])
    assert measured("region", one).note == "the region is a point"
    spread = make_problem(one.contacts, rigid_rows(SQUARE[:1], (0, 0, 0.3), 500.0), 500.0, 0.5, frozenset())
    assert measured("slack", spread).note == "no contact forces of any size balance the weight"
    none = Standing(stance_of([], (0, 0, 0.3)))
    for name in ("region", "feasible"):
        assert MEASURES[name].evaluate(none).note == "0 contacts span no region"
        assert MEASURES[name].evaluate(none).value == -math.inf


def test_walls_that_face_each_other_are_said_to_brace():
    normals = [(-math.copysign(1.0, x), 0.0, 0.2) for x, _, _ in SQUARE]
    margin = measured("region", rigid(SQUARE, normals, (0.0, 0.0, 0.3), mu=0.9, wheels=FOUR))
    assert margin.value > 100.0
    assert "contacts brace with 1000 weights" in margin.note
    assert "contacts brace" in measured("slack", rigid(SQUARE, normals, (0.0, 0.0, 0.3), wheels=FOUR)).note


def test_the_region_of_a_real_rover_turns_with_it():
    rover = fixture("thirds")
    straight, turned = (rp.settle(rover, FLAT, x=2.0, yaw=yaw) for yaw in (0.0, 1.1))
    one, other = (MEASURES["region"].evaluate(Standing(s)) for s in (straight, turned))
    assert other.edges == pytest.approx(one.edges, abs=1e-6)
    assert other.details["toward_rad"] == pytest.approx(one.details["toward_rad"], abs=1e-2) or one.edges[
        "left"
    ] == pytest.approx(one.edges["right"], abs=1e-6)


@pytest.mark.parametrize("name", ["thirds", "four_bar"])
def test_lean_is_the_change_of_gravity_by_a_payload_moved(name):
    rover = fixture(name)
    at = rp.Terrain.slope(8)
    stance = rp.settle(rover.with_payload([(1e-9, (0, 0, 0))]), at, yaw=0.3)
    step, kilos = 0.01, 5.0
    gravity = []
    for move in ((0, 0, 0), (step, 0, 0), (0, step, 0)):
        loaded = dataclasses.replace(stance, rover=rover.with_payload([(kilos, move)]))
        gravity.append(balance(loaded).gravity)
    data = rover.model.createData()
    pin.forwardKinematics(rover.model, data, np.array(stance.configuration))
    rotation = data.oMi[1].rotation
    for axis in (0, 1):
        moved = rotation[:2, axis] * step * kilos / (rover.mass + kilos)
        expected = balance(dataclasses.replace(stance, rover=rover.with_payload([(kilos, (0, 0, 0))]))).lean
        np.testing.assert_allclose(gravity[1 + axis] - gravity[0], expected @ moved, atol=1e-6)
