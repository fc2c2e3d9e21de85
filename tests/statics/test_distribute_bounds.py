"""Load intervals: closed forms, another solver, unbounded and infeasible ones."""

import numpy as np
import pytest
from cutting_planes import CuttingPlanes
from hand_made import HEXAGON, SIX, UP, contacts_at, on_slope, rigid, rigid_rows, rough, stance_of

import rover_pin as rp
from rover_pin.errors import InputError
from rover_pin.statics.bounds import load_bounds, problem_bounds
from rover_pin.statics.distribute import RULES
from rover_pin.statics.friction_problem import make_problem
from rover_pin.statics.stance import Status

THREE = [[1.0, 0.0, 0.0], [-0.5, 0.8, 0.0], [-0.5, -0.8, 0.0]]


def test_three_legs_on_level_ground_have_one_load_each():
    bounds = problem_bounds(rigid(THREE, np.tile(UP, (3, 1)), (0, 0, 0.5), wheels=("a", "b", "c")))
    for low, high in bounds.values():
        assert low == pytest.approx(500.0 / 3, abs=1e-5)
        assert high == pytest.approx(500.0 / 3, abs=1e-5)


def test_a_rigid_square_shares_between_its_diagonals():
    square = [[1.0, 1.0, 0], [1.0, -1.0, 0], [-1.0, 1.0, 0], [-1.0, -1.0, 0]]
    bounds = problem_bounds(rigid(square, np.tile(UP, (4, 1)), (0, 0, 0.5), wheels=("a", "b", "c", "d")))
    for low, high in bounds.values():
        assert low == pytest.approx(0.0, abs=1e-5)
        assert high == pytest.approx(250.0, abs=1e-5)


@pytest.mark.parametrize("seed", range(4))
def test_against_cutting_planes(seed):
    problem = rough(seed, slant=0.2, mu=0.4, free=("fl",) if seed % 2 else ())
    bounds = problem_bounds(problem)
    planes = CuttingPlanes(problem)
    for i, wheel in enumerate(SIX):
        cost = np.zeros(planes.n)
        cost[3 * i : 3 * i + 3] = problem.frames[i, :, 2]
        low = planes.minimise(cost, problem.friction, 0.0)
        high = -planes.minimise(-cost, problem.friction, 0.0)
        assert bounds[wheel] == pytest.approx((500.0 * low, 500.0 * high), abs=1e-4)


@pytest.mark.parametrize("seed", range(4))
def test_every_rule_that_friction_holds_lies_within(seed):
    problem = rough(seed, slant=0.1, mu=0.7)
    bounds = problem_bounds(problem)
    for rule in RULES.values():
        forces = rule(problem)
        if forces.feasible:
            for wheel, load in forces.loads.items():
                assert bounds[wheel][0] - 1e-4 <= load <= bounds[wheel][1] + 1e-4


def test_bracing_without_bound_is_infinite():
    # nearly upright walls on both sides: pressing harder lets friction hold any load up or down
    normals = [[0.0, -np.sign(y), 0.2] for _, y, _ in HEXAGON]
    contacts = contacts_at(HEXAGON, normals)
    problem = make_problem(contacts, rigid_rows(HEXAGON, (0, 0, 0), 500.0), 500.0, 0.9, frozenset())
    for low, high in problem_bounds(problem).values():
        assert high == float("inf")
        assert low == -float("inf")


def test_too_little_friction_leaves_no_interval():
    for low, high in problem_bounds(on_slope(0.5, mu=0.4)).values():
        assert np.isnan(low)
        assert np.isnan(high)


def test_more_friction_never_narrows():
    narrow, wide = (problem_bounds(rough(1, mu=mu)) for mu in (0.4, 0.8))
    for wheel in SIX:
        assert wide[wheel][0] <= narrow[wheel][0] + 1e-5
        assert wide[wheel][1] >= narrow[wheel][1] - 1e-5


def test_real_stance():
    stance = rp.settle(rp.load("rocker_bogie"), rp.Terrain.flat())
    bounds = load_bounds(stance, friction=0.6)
    assert list(bounds) == list(stance.loads)
    for wheel, (low, high) in bounds.items():
        assert type(low) is float
        assert 0.0 <= low <= stance.loads[wheel] <= high < stance.weight


def test_a_stance_that_does_not_stand_has_none():
    stance = stance_of(contacts_at(HEXAGON), (0, 0, 0.3), status=Status.SLACK)
    with pytest.raises(InputError, match="the rover does not stand, so nothing carries it"):
        load_bounds(stance)
