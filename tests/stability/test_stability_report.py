"""The report, clearance, friction and torque on stances; messages."""

import math
import pickle
from types import SimpleNamespace

import numpy as np
import pytest
from hand_made import HEXAGON, contacts_at, on_slope, stance_of

import rover_pin as rp
from rover_pin.errors import InputError
from rover_pin.stability.measure import Standing
from rover_pin.stability.registry import MEASURES
from rover_pin.stability.report import inapplicable, stability
from rover_pin.statics.friction_problem import make_problem
from rover_pin.statics.stance import Status

CHEAP = {"loads", "polygon", "tip", "force_angle", "energy", "zmp", "clearance"}
NAMES = CHEAP | {"friction", "torque", "region", "slack", "feasible"}


@pytest.fixture(scope="module")
def stance():
    return rp.settle(rp.load("rocker_bogie"), rp.Terrain.slope(15), x=0.3, y=0.2, yaw=0.4)


def with_problem(problem):
    standing = Standing(stance_of(problem.contacts, (0, 0, 0.3)))
    standing.__dict__["problem"] = problem
    return standing


def test_the_module_is_the_function_too(stance):
    assert set(rp.stability(stance)) == NAMES
    assert rp.stability(stance, ["tip"]) == stability(stance, ["tip"])
    assert rp.stability.report.stability is stability


def test_every_measure_of_a_real_stance(stance):
    for name, margin in stability(stance).items():
        measure = MEASURES[name]
        assert (margin.measure, margin.unit, margin.better) == (name, measure.unit, measure.better)
        assert margin.answered
        assert margin.edges[margin.limiting] == margin.value
        worst = min if margin.better == "high" else max
        assert margin.value == worst(margin.edges.values())
        assert all(type(v) is float for v in margin.edges.values())
        assert pickle.loads(pickle.dumps(margin)) == margin


def test_real_stance_in_closed_form(stance):
    got = stability(stance, friction=0.7)
    assert got["friction"].value == pytest.approx(0.7 - math.tan(math.radians(15)), abs=1e-7)
    assert got["friction"].details["least"] == pytest.approx(math.tan(math.radians(15)), abs=1e-7)
    assert got["friction"].note == "needs friction 0.267949"
    assert got["zmp"].value == pytest.approx(got["polygon"].value, abs=1e-9)


def test_cheap_measures_come_first():
    flags = [m.cheap for m in MEASURES.values()]
    assert flags == sorted(flags, reverse=True)
    assert {n for n, m in MEASURES.items() if m.cheap} == CHEAP
    assert set(MEASURES) == NAMES


def test_friction_margin_is_signed():
    margin = MEASURES["friction"].evaluate(with_problem(on_slope(0.5, mu=0.4)))
    assert margin.value == pytest.approx(0.4 - math.tan(0.5), abs=1e-7)
    margin = MEASURES["friction"].evaluate(with_problem(on_slope(0.2, mu=0.4)))
    assert margin.value == pytest.approx(0.4 - math.tan(0.2), abs=1e-7)


def test_friction_and_torque_fail_closed_where_nothing_holds():
    slope = on_slope(0.5, mu=0.4)
    torque = MEASURES["torque"].evaluate(with_problem(slope))
    assert torque.value == math.inf
    assert torque.note == "no forces within the friction hold the rover"
    undriven = make_problem(slope.contacts, slope.rows, 500.0, 0.8, frozenset())
    assert MEASURES["torque"].evaluate(with_problem(undriven)).note == "no driven wheel touches the ground"
    hung = on_slope(0.1, com=(5.0, 0, 0))
    friction = MEASURES["friction"].evaluate(with_problem(hung))
    assert friction.value == -math.inf
    assert friction.note == "no friction holds the rover"


def test_torque_in_closed_form():
    margin = MEASURES["torque"].evaluate(with_problem(on_slope(0.3, mu=0.8)))
    assert margin.value == pytest.approx(0.1 * 500.0 * math.sin(0.3) / 6, abs=1e-7)
    assert margin.better == "low"


def test_clearance_on_flat_ground_and_its_point():
    rover = rp.load("rocker_bogie")
    stance = rp.settle(rover, rp.Terrain.flat())
    margin = stability(stance, "clearance")["clearance"]
    heights = [stance.position[2] + b.point[2] for b in rover.belly if b.link == rover.belly[0].link]
    assert margin.value == pytest.approx(min(heights), abs=1e-9)
    assert margin.limiting.startswith(rover.belly[0].link)
    assert len(margin.edges) == len(rover.belly)


def test_a_rover_without_belly_has_no_clearance():
    stance = stance_of(contacts_at(HEXAGON), (0, 0, 0.3))
    assert "clearance" not in stability(stance, ["clearance", "tip"])
    assert inapplicable(stance.rover, ["clearance"]) == {"clearance": "hand_made declares no belly points"}
    assert MEASURES["clearance"].evaluate(Standing(stance)).value == -math.inf


def test_belly_beyond_the_map_is_said(stance):
    outside = SimpleNamespace(
        label="small",
        height=lambda x, y: np.zeros(np.shape(x)),
        covers=lambda x, y: np.zeros(np.shape(x), dtype=bool),
    )
    moved = SimpleNamespace(**{**stance.__dict__, "terrain": outside})
    margin = MEASURES["clearance"].evaluate(Standing(moved))
    assert margin.note == "part of the belly is beyond the map, over its border's height"


def test_unknown_measure_names_the_nearest(stance):
    with pytest.raises(InputError, match=r"measures: no such measure \(got 'tipp'\); did you mean 'tip'"):
        rp.stability(stance, ["tipp"])


def test_a_stance_that_does_not_stand_has_none():
    fallen = stance_of(contacts_at(HEXAGON), (0, 0, 0.3), status=Status.TIPS, reason="fr has no load left")
    with pytest.raises(
        InputError, match="the rover does not stand, so nothing carries it: fr has no load left"
    ):
        rp.stability(fallen)
