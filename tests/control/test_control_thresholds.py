"""Thresholds, readings, and what a motion constraint refuses to look at."""

import math

import numpy as np
import pytest
from sides import HIT

import rover_pin as rp
from rover_pin.control.layout import Layout
from rover_pin.control.motion_constraints import CONSTRAINTS, Options, motion_constraints
from rover_pin.control.now import Now
from rover_pin.control.threshold import Threshold, crossed, evaluate
from rover_pin.errors import InputError

LIMITS = {name: Threshold(1.0) for name in CONSTRAINTS}


@pytest.fixture
def now(level, raised, still):
    return Now(level.at(raised.configuration), still, still, loads=raised.loads)


def test_eleven_of_them():
    numbers = [kind.number for kind in CONSTRAINTS.values()]
    assert numbers == list(range(1, 12))
    assert {kind.kind for kind in CONSTRAINTS.values()} == {"set", "posture", "velocity", "load"}


def test_readings(constraints, now):
    """Wheels at 480 mm: 0.322 of 0.33 is 0.977."""
    limits = LIMITS | {"wheelbase": Threshold(0.33, 0.98), "load_difference": Threshold(1100.0, 0.9)}
    readings = evaluate(constraints, limits, now)
    assert tuple(readings) == tuple(constraints)
    reading = readings["wheelbase"]
    assert reading.parts == ("left", "right")
    np.testing.assert_allclose(reading.index, 0.32231 / 0.33, atol=1e-4)
    assert reading.worst == pytest.approx(0.9767, abs=1e-4)
    assert not reading.crossed
    assert readings["load_difference"].index == pytest.approx([22.406 / 1100], abs=1e-6)
    assert crossed(readings) == ("load_deviation",)  # 14.9 N of 1 N


@pytest.mark.parametrize(("margin", "beyond"), [(0.9768, False), (0.9766, True)])
def test_margins(constraints, now, margin, beyond):
    only = {"wheelbase": constraints["wheelbase"]}
    assert evaluate(only, {"wheelbase": Threshold(0.33, margin)}, now)["wheelbase"].crossed is beyond


def test_a_margin_reached_is_not_crossed(constraints, now):
    """A projection stops on the margin itself, up to rounding."""
    only = {"wheelbase": constraints["wheelbase"]}
    limit = float(constraints["wheelbase"].value(now).max())
    assert not evaluate(only, {"wheelbase": Threshold(limit * (1 - 1e-12))}, now)["wheelbase"].crossed
    assert evaluate(only, {"wheelbase": Threshold(limit * (1 - 1e-6))}, now)["wheelbase"].crossed


def test_sides_are_told_apart(hit, level, constraints, still):
    stance = rp.settle(hit, rp.Terrain.flat(), joints={"L_act": 0.6, "R_act": 0.2})
    now = Now(level.at(stance.configuration), still, still)
    only = {"wheelbase": constraints["wheelbase"]}
    reading = evaluate(only, {"wheelbase": Threshold(0.2)}, now)["wheelbase"]
    assert reading.crossed
    assert (reading.index > 1.0).tolist() == [True, False]


def test_sets_need_no_threshold(constraints, level, raised, still):
    only = {"lifted_set": constraints["lifted_set"]}
    at = level.at(raised.configuration)
    assert crossed(evaluate(only, {}, Now(at, still, still, ("LF", "RM")))) == ()
    assert crossed(evaluate(only, {}, Now(at, still, still, ("LF", "RB")))) == ("lifted_set",)


def test_what_does_not_apply_is_not_crossed(constraints, level, raised, still):
    only = {"coordination": constraints["coordination"]}
    now = Now(level.at(raised.configuration), still, still, ("LF", "RM"))
    reading = evaluate(only, LIMITS, now)["coordination"]
    assert np.isnan(reading.index).all()
    assert (reading.worst, reading.crossed) == (0.0, False)


def test_missing_threshold(constraints, now):
    limits = {"wheelbase": Threshold(1.0), "heigth": Threshold(1.0)}
    with pytest.raises(InputError) as caught:
        evaluate({name: constraints[name] for name in ("wheelbase", "height")}, limits, now)
    assert str(caught.value) == "height: has no threshold in this mode; did you mean 'heigth'?"


@pytest.mark.parametrize("limit", [0.0, -1.0, math.nan, math.inf])
def test_limits(limit):
    with pytest.raises(InputError, match="limit: must be a finite number above 0"):
        Threshold(limit)


@pytest.mark.parametrize("margin", [0.0, 1.1, math.nan])
def test_margin_range(margin):
    with pytest.raises(InputError, match="margin: lies above 0 and is at most 1"):
        Threshold(1.0, margin)


def test_unknown_constraint(hit):
    with pytest.raises(InputError, match=r"weelbase: no motion constraint of that name; did you mean"):
        motion_constraints(hit, HIT, ["weelbase"])


@pytest.mark.parametrize("word", ["wheelbase_divisor", "speed_floor", "yaw_floor", "load_step"])
@pytest.mark.parametrize("value", [0.0, -1.0, math.nan])
def test_options(word, value):
    with pytest.raises(InputError, match=f"{word}: must be a finite number above 0"):
        Options(**{word: value})


def test_sides_front_to_rear(hit):
    turned = Layout(HIT.left, type(HIT.right)("right", ("RB", "RM", "RF"), "R_diff", "R_act"))
    with pytest.raises(InputError) as caught:
        motion_constraints(hit, turned)
    assert str(caught.value) == (
        "RB: stands behind RM at home (got -0.775); list the wheels of the right side front to rear"
    )


def test_now_refuses_nonsense(hit, level, raised, still):
    at = level.at(raised.configuration)
    bad = still.copy()
    bad[hit.column["L_act"]] = math.nan
    with pytest.raises(InputError, match=r"v of L_act: is no finite number \(got nan\)"):
        Now(at, bad, still)
    with pytest.raises(InputError, match=r"nominal: a velocity has .* \(got \(3,\)\); give shape \(26,\)"):
        Now(at, still, np.zeros(3))
    with pytest.raises(InputError, match=r"load of LM: is no finite number \(got nan\)"):
        Now(at, still, still, loads={"LF": 1.0, "LM": math.nan})
