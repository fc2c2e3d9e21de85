"""Least friction and least torque: closed forms, another solver, what has no answer."""

import numpy as np
import pytest
from cutting_planes import CuttingPlanes
from hand_made import HEXAGON, UP, contacts_at, on_slope, rigid, rigid_rows, rough, turn, with_pivot

from rover_pin.statics.distribute import RULES, smallest_friction, smallest_torque
from rover_pin.statics.friction_problem import make_problem
from rover_pin.statics.least_friction import least_friction


@pytest.mark.parametrize("alpha", [0.0, 1e-9, 1e-4, 0.05, 0.3, 0.6, 1.0])
def test_a_uniform_slope_needs_its_tangent(alpha):
    forces = smallest_friction(on_slope(alpha, com=(0.1, 0.05, 0.05), mu=2.0))
    assert forces.feasible, forces.reason
    assert forces.friction == pytest.approx(np.tan(alpha), abs=1e-7)
    assert forces.residual < 1e-12
    assert forces.normal.min() > -1e-9


@pytest.mark.parametrize("alpha", [0.1, 0.4])
def test_a_uniform_cross_slope_needs_its_tangent(alpha):
    R = turn(0, alpha)
    forces = smallest_friction(rigid(HEXAGON @ R.T, np.tile(R @ UP, (6, 1)), R @ (0.1, 0.05, 0.1), mu=None))
    assert forces.friction == pytest.approx(np.tan(alpha), abs=1e-7)


@pytest.mark.parametrize(("a", "b"), [(0.2, 0.5), (0.3, 0.3), (-0.4, 0.1), (0.5, -0.3)])
def test_two_axles_on_planes_of_their_own(a, b):
    # weight midway: each axle carries half, the horizontal forces are opposite, so both forces lean alike
    # (by g) towards each other or apart; tan|a - g| and tan|b - g| are best at g = (a + b)/2
    points = [[1.0, 0.5, 0], [1.0, -0.5, 0], [-1.0, 0.5, 0], [-1.0, -0.5, 0]]
    normals = [[np.sin(t), 0, np.cos(t)] for t in (a, a, -b, -b)]
    forces = smallest_friction(rigid(points, normals, (0, 0, 0), wheels=("a", "b", "c", "d"), mu=None))
    assert forces.friction == pytest.approx(np.tan(abs(a - b) / 2), abs=1e-7)
    assert forces.residual < 1e-12


@pytest.mark.parametrize("seed", range(6))
def test_least_friction_against_cutting_planes(seed):
    problem = rough(seed, slant=0.5, com=(0.5, 0.2, 0.3), free=("fl", "mr", "rl", "rr")[:seed])
    forces = smallest_friction(problem)
    planes = CuttingPlanes(problem)
    mu = forces.friction
    if mu > 1e-6:
        below = planes.excess(np.full(6, mu - 1e-7))
        assert below is None or below > 0.0
    above = planes.excess(np.full(6, mu + 1e-7))
    assert above is not None
    assert above < 1e-10


def test_the_bracket_is_narrow_and_held_from_both_sides():
    problem = rough(3, slant=0.5, com=(0.5, 0.2, 0.3), free=("fl", "mr", "rl", "rr"))
    found = least_friction(problem.space, np.zeros(6))
    assert found.outcome == "found"
    assert found.excess > 0.01
    assert 0.0 <= found.excess - found.lower <= 1e-7
    contact = found.forces[:18].reshape(6, 3)
    assert np.all(np.hypot(contact[:, 1], contact[:, 2]) <= found.excess * contact[:, 0])


def test_where_frictions_differ_the_excess_is_least():
    mus = np.array([0.5, 0.9, 0.6, 0.6, 0.5, 0.8])
    problem = on_slope(0.5, mu=None, friction=mus)
    forces = smallest_friction(problem)
    excess = float(np.max(forces.ratio - mus))
    planes = CuttingPlanes(problem)
    assert planes.excess(mus + excess + 1e-7) < 1e-10
    assert planes.excess(mus + excess - 1e-7) > 0.0
    assert forces.feasible == (excess <= 0.0)


def test_too_little_friction_is_said_with_the_wheel():
    forces = smallest_friction(on_slope(0.5, mu=0.4))
    assert forces.status == "infeasible"
    assert "asks for friction 0.5463 where there is 0.4" in forces.reason


@pytest.mark.parametrize("seed", range(6))
def test_least_torque_against_cutting_planes(seed):
    problem = rough(seed, slant=0.3, com=(0.5, 0.2, 0.3), mu=0.35, free=("fl",) if seed % 2 else ())
    forces = smallest_torque(problem)
    levers = np.diag([0.1] * 6)
    expected = CuttingPlanes(problem).torque(problem.friction, levers)
    assert (expected is not None) == forces.feasible
    if expected is not None:
        assert max(map(abs, forces.torques.values())) / 500.0 == pytest.approx(expected, abs=1e-9)
        assert forces.friction <= 0.35 + 1e-6
        assert forces.residual < 1e-12


def test_least_torque_on_a_slope_is_shared_evenly():
    forces = smallest_torque(on_slope(0.3, mu=0.8))
    for torque in forces.torques.values():
        assert torque == pytest.approx(0.1 * 500.0 * np.sin(0.3) / 6, abs=1e-7)


def test_least_torque_beyond_friction_has_no_answer():
    forces = smallest_torque(on_slope(0.5, mu=0.5))
    assert forces.status == "infeasible"
    assert forces.reason == "no forces within the friction hold the rover"
    assert np.isnan(forces.force).all()


def test_undriven_wheels_cost_no_torque():
    problem = on_slope(0.3, mu=0.8)
    held = make_problem(problem.contacts, problem.rows, 500.0, 0.8, frozenset({"fl", "fr"}))
    forces = smallest_torque(held)
    assert abs(forces.torques["fl"]) < 1e-7
    assert forces.torques["ml"] + forces.torques["mr"] + forces.torques["rl"] + forces.torques[
        "rr"
    ] == pytest.approx(0.1 * 500.0 * np.sin(0.3), abs=1e-6)


def tall_bogies(alpha, height, arm):
    """Rear wheels on the body, the others on two massless bogies with high pivots, on a slope."""
    R = turn(1, -alpha)
    points = HEXAGON @ R.T
    com = R @ np.array([0.0, 0.0, 0.05])
    body = rigid_rows(points, com, 500.0)
    rows = body
    for members, side in (((0, 2), 0.5), ((1, 3), -0.5)):
        rows = with_pivot(rows, points, members, R @ np.array([0.5, side, height]))
    contacts = contacts_at(points, np.tile(R @ UP, (6, 1)), loads=np.full(6, 500.0 / 6))
    names = frozenset(c.wheel for c in contacts)
    return make_problem(contacts, body, 500.0, arm, names), make_problem(contacts, rows, 500.0, arm, names)


def test_passive_joints_forbid_what_the_body_alone_allows():
    body, whole = tall_bogies(0.4, 2.0, 0.45)
    assert smallest_friction(body).feasible
    assert smallest_torque(body).feasible
    asked = smallest_friction(whole)
    assert asked.status == "infeasible"
    assert asked.friction > np.tan(0.4) + 0.01
    assert not smallest_torque(whole).feasible
    assert asked.residual < 1e-12


def test_low_pivots_forbid_nothing():
    body, whole = tall_bogies(0.4, 0.2, 0.45)
    assert smallest_friction(whole).friction == pytest.approx(smallest_friction(body).friction, abs=1e-7)


def test_nothing_balances_a_body_hung_beyond_its_only_contact():
    problem = rigid([[0.0, 0, 0]], [UP], (1.0, 0, 0), wheels=("a",), mu=0.6)
    for name in ("ratio", "least_friction", "least_torque"):
        forces = RULES[name](problem)
        assert forces.status == "infeasible"
        assert forces.reason == "no contact forces of any size balance the weight"
    vertical = RULES["vertical"](problem)
    assert vertical.status == "infeasible"
    assert "of the weight unbalanced" in vertical.reason


def test_pulling_ground_is_no_answer():
    problem = rigid(HEXAGON, np.tile(UP, (6, 1)), (2.0, 0, 0.1))
    forces = smallest_friction(problem)
    assert forces.status == "infeasible"
    assert forces.reason == "no friction holds the rover"
    assert "the ground would have to pull at" in RULES["vertical"](problem).reason


def test_bracing_between_walls_is_bounded():
    # between two upright walls the weight hangs on friction: any friction does with enough pressure, and the
    # normal forces may add up to a thousand weights
    normals = [[0.0, -np.sign(y), 0.0] for _, y, _ in HEXAGON]
    contacts = contacts_at(HEXAGON, normals)
    problem = make_problem(contacts, rigid_rows(HEXAGON, (0, 0, 0), 500.0), 500.0, 0.6, frozenset())
    forces = smallest_friction(problem)
    assert forces.friction == pytest.approx(1e-3, abs=1e-7)
    assert forces.normal.sum() == pytest.approx(1000.0 * 500.0, rel=1e-3)


def test_units_and_place_do_not_matter():
    mu = smallest_friction(rough(4, slant=0.5, free=("fl", "mr", "rl", "rr"))).friction
    heavy = smallest_friction(rough(4, slant=0.5, free=("fl", "mr", "rl", "rr"), weight=5e6)).friction
    assert heavy == pytest.approx(mu, abs=1e-7)
    problem = rough(4, slant=0.5, free=("fl", "mr", "rl", "rr"))
    rows = problem.rows
    milli = type(rows)(
        rows.gravity * np.r_[1, 1, 1, 1e3, 1e3, 1e3],
        rows.contact * np.r_[1, 1, 1, 1e3, 1e3, 1e3][:, None],
        rows.internal,
        rows.internal_lower,
    )
    scaled = make_problem(problem.contacts, milli, 500.0, 0.6, problem.driven)
    assert smallest_friction(scaled).friction == pytest.approx(mu, abs=1e-7)
