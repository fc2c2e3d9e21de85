"""Each cheap measure: closed forms, invariance, signs, what fails closed."""

import math

import numpy as np
import pytest
from hand_made import HEXAGON, SIX, UP, contacts_at, rigid_rows, stance_of, turn, vertical_loads
from hypothesis import given, settings
from hypothesis import strategies as st

from rover_pin.stability.measure import Standing
from rover_pin.stability.registry import MEASURES
from rover_pin.stability.report import inapplicable, stability

CORNERS = np.array([[1.0, 0.5, 0.0], [1.0, -0.5, 0.0], [-1.0, 0.5, 0.0], [-1.0, -0.5, 0.0]])
FOUR = ("fl", "fr", "rl", "rr")
EDGES = ("polygon", "tip", "force_angle", "energy", "zmp")
CHEAP = (*EDGES, "loads")


def four(com, points=CORNERS, weight=500.0):
    loads = vertical_loads(rigid_rows(points, com, weight))
    return stance_of(contacts_at(points, wheels=FOUR, loads=loads), com, weight)


def named(margin):
    return {frozenset(edge.split("-")): value for edge, value in margin.edges.items()}


def test_a_rectangle_by_hand():
    t, b, h, x, y = 0.5, 1.0, 0.4, 0.3, -0.1
    got = stability(four((x, y, h)), EDGES)
    distance = {("fl", "fr"): b - x, ("rl", "rr"): b + x, ("fl", "rl"): t - y, ("fr", "rr"): t + y}
    for pair, d in distance.items():
        edge = frozenset(pair)
        assert named(got["polygon"])[edge] == pytest.approx(d)
        assert named(got["zmp"])[edge] == pytest.approx(d)
        assert named(got["tip"])[edge] == pytest.approx(math.atan2(d, h))
        assert named(got["force_angle"])[edge] == pytest.approx(math.atan2(d, h) * d * 500.0)
        assert named(got["energy"])[edge] == pytest.approx(math.hypot(d, h) - h)
    for margin in got.values():
        assert set(margin.limiting.split("-")) == {"fr", "rr"}
        assert margin.value == min(margin.edges.values())
        assert len(margin.edges) == 4
    assert got["energy"].details["energy_j"] == pytest.approx(500.0 * (math.hypot(0.4, 0.4) - 0.4))


@pytest.mark.parametrize("alpha", [0.1, 0.5, 0.85])
def test_on_a_slope_the_tip_angle_falls_by_the_slope(alpha):
    R = turn(0, alpha)  # y goes up
    stance = four(R @ (0, 0, 0.4), CORNERS @ R.T)
    tip = named(stability(stance, "tip")["tip"])
    assert tip[frozenset(("fr", "rr"))] == pytest.approx(math.atan(0.5 / 0.4) - alpha)
    assert tip[frozenset(("fl", "rl"))] == pytest.approx(math.atan(0.5 / 0.4) + alpha)


def test_edges_that_climb_lower_the_energy():
    # climbing along x by alpha: rising about the side edge is less high by cos(alpha), R turns with the slope
    alpha, t, h = 0.3, 0.5, 0.4
    R = turn(1, -alpha)
    energy = named(stability(four(R @ (0, 0, h), CORNERS @ R.T), "energy")["energy"])
    expected = (math.hypot(t, h) - h) * math.cos(alpha)
    assert energy[frozenset(("fl", "rl"))] == pytest.approx(expected)
    force = named(stability(four(R @ (0, 0, h), CORNERS @ R.T), "force_angle")["force_angle"])
    assert force[frozenset(("fl", "rl"))] == pytest.approx(math.atan2(t, h) * t * 500.0 * math.cos(alpha))


@pytest.mark.parametrize("past", [1e-6, 0.1, 1.0])
def test_past_the_edge_every_sign_is_negative(past):
    got = stability(four((0.0, 0.5 + past, 0.3)), EDGES)
    for margin in got.values():
        assert margin.value < 0.0
        assert set(margin.limiting.split("-")) == {"fl", "rl"}
    assert got["polygon"].value == pytest.approx(-past)


def test_over_the_edge_all_are_zero():
    for margin in stability(four((0.0, 0.5, 0.3)), EDGES).values():
        assert margin.value == pytest.approx(0.0, abs=1e-12)


def test_a_centre_of_mass_below_the_ground_hangs():
    got = stability(four((0.0, 0.0, -0.4)), EDGES)
    assert named(got["tip"])[frozenset(("fl", "rl"))] == pytest.approx(math.pi - math.atan(0.5 / 0.4))
    assert got["energy"].value == pytest.approx(math.hypot(0.5, 0.4) + 0.4)


def test_edges_go_counterclockwise_from_above_and_are_named_by_their_wheels():
    edges = list(stability(four((0, 0, 0.3)), "polygon")["polygon"].edges)
    assert sorted(edges) == ["fl-rl", "fr-fl", "rl-rr", "rr-fr"]


def test_wheels_inside_the_hull_have_no_edge():
    points = HEXAGON * np.where(HEXAGON[:, :1] == 0, (1, 0.8, 1), (1, 1, 1))
    edges = stability(stance_of(contacts_at(points), (0, 0, 0.3)), "polygon")["polygon"].edges
    assert not any("m" in edge for edge in edges)
    wide = HEXAGON * np.where(HEXAGON[:, :1] == 0, (1, 1.2, 1), (1, 1, 1))
    edges = stability(stance_of(contacts_at(wide), (0, 0, 0.3)), "polygon")["polygon"].edges
    assert sorted(edges) == ["fl-ml", "fr-fl", "ml-rl", "mr-fr", "rl-rr", "rr-mr"]


def test_two_contacts_of_a_wheel_have_an_edge_and_the_same_place_none():
    twice = np.vstack([CORNERS, CORNERS[:1] + np.array([-0.05, 0.1, 0.0])])
    edges = stability(stance_of(contacts_at(twice, wheels=(*FOUR, "fl")), (0, 0, 0.3)), "polygon")[
        "polygon"
    ].edges
    assert "fl-fl" in edges
    same = np.vstack([CORNERS, CORNERS[:1] + 1e-9])
    edges = stability(stance_of(contacts_at(same, wheels=(*FOUR, "fl")), (0, 0, 0.3)), "polygon")[
        "polygon"
    ].edges
    assert len(edges) == 4


def test_zmp_follows_the_loads_and_not_the_centre_of_mass():
    loads = [100.0, 100.0, 200.0, 100.0]
    stance = stance_of(contacts_at(CORNERS, wheels=FOUR, loads=loads), (0.0, 0.0, 0.3))
    got = stability(stance, ["zmp", "polygon"])
    assert named(got["zmp"])[frozenset(("rl", "rr"))] == pytest.approx(1.0 - 0.2)
    assert named(got["polygon"])[frozenset(("rl", "rr"))] == pytest.approx(1.0)


def test_loads_by_hand():
    loads = [100.0, 200.0, 300.0, 0.0]
    margin = stability(stance_of(contacts_at(CORNERS, wheels=FOUR, loads=loads), (0, 0, 0.3)), "loads")[
        "loads"
    ]
    assert margin.limiting == "rr"
    assert margin.value == 0.0
    assert margin.edges == pytest.approx({"fl": 2 / 3, "fr": 4 / 3, "rl": 2.0, "rr": 0.0})
    assert margin.details == pytest.approx(
        {"range_n": 300.0, "max_over_mean": 2.0, "std_over_mean": np.std(loads) / 150.0, "mean_n": 150.0}
    )


def test_loads_count_no_auxiliary_wheel():
    contacts = contacts_at(CORNERS, wheels=FOUR, loads=[100.0, 200.0, 300.0, 0.0])
    margin = stability(stance_of(contacts, (0, 0, 0.3), auxiliary=["rr"]), "loads")["loads"]
    assert margin.limiting == "fl"
    assert margin.edges == pytest.approx({"fl": 0.5, "fr": 1.0, "rl": 1.5})
    assert margin.details["mean_n"] == pytest.approx(200.0)
    assert margin.details["std_over_mean"] == pytest.approx(np.std([1.0, 2.0, 3.0]) / 2.0)


def test_where_every_wheel_is_auxiliary_there_is_no_such_measure():
    stance = stance_of(contacts_at(CORNERS, wheels=FOUR, loads=np.ones(4)), (0, 0, 0.3), auxiliary=FOUR)
    assert inapplicable(stance.rover, ["loads"]) == {
        "loads": "every wheel of hand_made is auxiliary: none should carry"
    }


FEW = {
    "0 contacts span no polygon": np.zeros((0, 3)),
    "1 contact spans no polygon": CORNERS[:1],
    "2 contacts span no polygon": CORNERS[:2],
    "the contacts lie in a line": np.array([[0.0, 0, 0], [1, 2, 0], [2, 4, 1.0]]),
}


@pytest.mark.parametrize("why", FEW)
def test_without_a_polygon_measures_fail_closed(why):
    points = FEW[why]
    stance = stance_of(contacts_at(points, wheels=FOUR[: len(points)]), (0.3, 0.1, 0.3))
    for margin in stability(stance, EDGES).values():
        assert margin.value == -math.inf
        assert margin.limiting is None
        assert margin.edges == {}
        assert not margin.answered
        assert margin.note == why


def test_nearly_in_a_line_fails_closed_too():
    points = [[0.0, 0, 0], [1, 1e-7, 0], [2, 0, 0]]
    margin = stability(stance_of(contacts_at(points, wheels=FOUR[:3]), (1, 0, 0.3)), "tip")["tip"]
    assert margin.value == -math.inf
    assert margin.note == "the contacts lie in a line"


def test_no_load_fails_closed():
    stance = stance_of(contacts_at(CORNERS, wheels=FOUR, loads=np.zeros(4)), (0, 0, 0.3))
    for margin in stability(stance, ["loads", "zmp"]).values():
        assert margin.value == -math.inf
        assert margin.note


@settings(max_examples=40, deadline=None, derandomize=True)
@given(
    seed=st.integers(0, 10**6),
    yaw=st.floats(-3, 3),
    shift=st.tuples(*[st.floats(-100, 100)] * 3),
    scale=st.floats(0.1, 10),
)
def test_place_heading_order_and_units_do_not_matter(seed, yaw, shift, scale):
    rng = np.random.default_rng(seed)
    points = HEXAGON + rng.normal(size=(6, 3)) * 0.1
    com = rng.normal(size=3) * (0.2, 0.1, 0.1) + (0, 0, 0.4)
    loads = vertical_loads(rigid_rows(points, com, 500.0))
    before = stability(stance_of(contacts_at(points, loads=loads), com), CHEAP)
    R, order = turn(2, yaw), rng.permutation(6)
    moved = (points @ R.T + np.array(shift)) * scale
    contacts = contacts_at(moved[order], wheels=[SIX[i] for i in order], loads=loads[order])
    after = stability(stance_of(contacts, (R @ com + shift) * scale), CHEAP)
    power = {"polygon": 1, "zmp": 1, "force_angle": 1, "energy": 1, "tip": 0, "loads": 0}
    for name, margin in before.items():
        factor = scale ** power[name]
        assert after[name].edges == pytest.approx(
            {e: v * factor for e, v in margin.edges.items()}, rel=1e-6, abs=1e-8
        )


def test_the_polygon_is_computed_once():
    standing = Standing(four((0, 0, 0.3)))
    assert standing.polygon is standing.polygon
    assert np.all(standing.polygon.ends == np.roll(standing.polygon.points, -1, axis=0))


def test_brute_force_energy():
    # turn the body about each edge in small steps until the centre of mass is highest
    rng = np.random.default_rng(5)
    points = HEXAGON + rng.normal(size=(6, 3)) * 0.15
    com = np.array([0.1, -0.05, 0.5])
    standing = Standing(stance_of(contacts_at(points), com))
    margin = MEASURES["energy"].evaluate(standing)
    for a, b, name in zip(
        standing.polygon.points, standing.polygon.ends, standing.polygon.edges, strict=True
    ):
        e = (b - a) / np.linalg.norm(b - a)
        r = com - a
        angles = np.linspace(-np.pi, np.pi, 20001)
        heights = (
            r[2] * np.cos(angles) + np.cross(e, r)[2] * np.sin(angles) + e[2] * (e @ r) * (1 - np.cos(angles))
        )
        assert margin.edges[name] == pytest.approx(heights.max() - r[2], abs=1e-6)
    assert UP @ com > 0
