"""Robust slack: closed forms, generators by linear programs, what it promises."""

import math

import numpy as np
import pytest
from com_planes import generator_slack
from hand_made import on_slope, rigid, rough
from standing import FOUR, SQUARE, measured, with_bogies

from rover_pin.statics.robust_slack import robust_slack


@pytest.mark.parametrize(("x", "y"), [(0.0, 0.0), (0.2, 0.5), (-0.7, 0.1)])
def test_slack_of_a_rigid_four_wheeler(x, y):
    # W / 4 (1 +- x +- y +- k), k free: of the pairs (1 + k - |x + y|) and (1 - k - |x - y|) the lesser is
    # largest at 1 - max(|x|, |y|)
    margin = measured("slack", rigid(SQUARE, None, (x, y, 0.3), wheels=FOUR))
    assert margin.value == pytest.approx(500.0 / 4.0 * (1.0 - max(abs(x), abs(y))), abs=1e-5)
    assert margin.edges[margin.limiting] == margin.value
    assert margin.details["over_weight"] == pytest.approx(margin.value / 500.0, abs=1e-8)


def test_slack_on_a_slope_and_beyond_what_friction_holds():
    # six equal contacts: normal W cos / 6, tangential W sin / 6
    for alpha in (0.2, 0.5):
        problem = on_slope(alpha, com=(0.0, 0.0, 0.0), mu=0.4)
        expected = 500.0 / 6.0 * (math.cos(alpha) - math.sin(alpha) / 0.4)
        assert measured("slack", problem).value == pytest.approx(expected, abs=1e-5)


@pytest.mark.parametrize("make", [rough, with_bogies])
def test_slack_is_the_limit_of_generators(make):
    problem = make(3)
    ours = measured("slack", problem).value
    short = [ours - generator_slack(problem, edges) for edges in (8, 32)]
    assert 0.0 <= short[1] <= 0.5
    assert short[1] < 0.2 * short[0] or short[0] < 1e-4


def test_any_smaller_error_leaves_every_force_in_its_cone():
    problem = rough(2)
    margin = measured("slack", problem)
    assert margin.value > 0.0
    # the contact with the least has exactly the ball of radius friction s / sqrt(1 + friction^2)
    local = robust_slack(problem.space, problem.friction).forces[:18].reshape(-1, 3) * problem.weight
    ball = 0.6 * margin.value / math.hypot(1.0, 0.6)
    rng = np.random.default_rng(0)
    error = rng.normal(size=(2000, 6, 3))
    worst = local + ball * (1 - 1e-9) * error / np.linalg.norm(error, axis=2, keepdims=True)
    assert np.all(np.hypot(worst[..., 1], worst[..., 2]) <= 0.6 * worst[..., 0] + 1e-6)
