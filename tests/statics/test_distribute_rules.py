"""Vertical and ratio rules, the result's parts, what bad input gets, real stances."""

import numpy as np
import pytest
from hand_made import HEXAGON, SIX, UP, Rows, contacts_at, on_slope, rigid, rigid_rows, rough, stance_of, turn

import rover_pin as rp
from rover_pin.errors import InputError
from rover_pin.statics.distribute import RULES, distribute
from rover_pin.statics.force_space import force_space, unbalanced
from rover_pin.statics.friction_problem import contact_frames, contact_names, make_problem
from rover_pin.statics.stance import Status


@pytest.mark.parametrize("alpha", [0.0, 0.1, 0.45])
def test_one_ratio_on_a_slope_is_its_tangent(alpha):
    forces = RULES["ratio"](on_slope(alpha))
    assert forces.feasible, forces.reason
    assert forces.k == pytest.approx(np.tan(alpha), abs=1e-12)
    np.testing.assert_allclose(forces.rolling, np.tan(alpha) * forces.normal, atol=1e-9)


@pytest.mark.parametrize("heading", [0.0, 0.3, 1.0])
def test_one_ratio_holds_along_the_heading_and_lateral_forces_hold_the_rest(heading):
    problem = on_slope(0.2, heading=(np.cos(heading), np.sin(heading), 0.0))
    forces = RULES["ratio"](problem)
    assert forces.residual < 1e-12
    np.testing.assert_allclose(forces.rolling, forces.k * forces.normal, atol=1e-8)
    assert forces.normal.sum() == pytest.approx(500.0 * np.cos(0.2))
    along = problem.frames[0, 1] @ (0, 0, 1) * 500.0
    assert forces.rolling.sum() == pytest.approx(along)


@pytest.mark.parametrize("seed", range(5))
def test_one_ratio_takes_the_least_sum_of_squares(seed):
    from scipy.optimize import minimize

    problem = rough(seed, slant=0.1)
    forces = RULES["ratio"](problem)
    assert forces.k is not None
    assert forces.residual < 1e-12
    frames, rows = problem.frames, problem.rows

    def world(v):
        local = np.stack([v[:6], v[12] * v[:6], v[6:12]], axis=1)
        return np.einsum("ka,kaw->kw", local, frames), local

    start = np.r_[np.full(6, 1 / 6), np.zeros(6), 0.0]
    found = minimize(
        lambda v: np.sum(world(v)[1] ** 2),
        start,
        constraints={
            "type": "eq",
            "fun": lambda v: rows.contact @ world(v)[0].ravel() - rows.gravity / 500.0,
        },
        bounds=[(0, None)] * 6 + [(None, None)] * 7,
        method="SLSQP",
        options={"maxiter": 500, "ftol": 1e-14},
    )
    assert found.success
    ours = np.sum(forces.force**2) / 500.0**2
    assert ours <= found.fun + 1e-7
    assert forces.k == pytest.approx(found.x[12], abs=1e-4)


def test_free_wheels_roll_without_force():
    forces = RULES["ratio"](on_slope(0.2, free=("fl", "fr")))
    assert forces.feasible, forces.reason
    np.testing.assert_allclose(forces.rolling[:2], 0.0, atol=1e-12)
    assert forces.k > np.tan(0.2)
    vertical = RULES["vertical"](on_slope(0.2, free=("fl", "fr")))
    assert vertical.status == "infeasible"
    assert "fl turns freely and would have to carry a rolling force" in vertical.reason


def test_vertical_says_where_friction_is_too_small():
    forces = RULES["vertical"](on_slope(0.4, mu=0.3))
    assert forces.status == "infeasible"
    assert forces.reason.endswith("asks for friction 0.4228 where there is 0.3")
    assert np.isfinite(forces.force).all()
    assert forces.friction == pytest.approx(np.tan(0.4))


def test_declared_friction_is_taken_where_none_is_given():
    mus = [0.9, 0.9, 0.9, 0.9, 0.9, 0.2]
    forces = RULES["vertical"](on_slope(0.4, mu=None, friction=mus))
    assert forces.reason.startswith("rr asks for friction 0.4228 where there is 0.2")
    np.testing.assert_array_equal(forces.given, mus)


def test_several_contacts_of_a_wheel_add_up():
    points = np.vstack([HEXAGON, HEXAGON[:1] + np.array([0.05, 0, 0.0])])
    wheels = (*SIX, "fl")
    forces = RULES["vertical"](rigid(points, np.tile(UP, (7, 1)), (0, 0, 0.2), wheels=wheels))
    assert forces.contacts == (*SIX, "fl#2")
    assert forces.loads["fl"] == pytest.approx(forces.normal[0] + forces.normal[6])
    assert sum(forces.loads.values()) == pytest.approx(500.0)


def test_torques_are_lever_times_rolling_force():
    forces = RULES["ratio"](on_slope(0.2, radius=0.25))
    for name, rolling in zip(SIX, forces.rolling, strict=True):
        assert forces.torques[name] == pytest.approx(0.25 * rolling)


def test_results_are_read_only():
    forces = RULES["vertical"](on_slope(0.2))
    for array in (forces.force, forces.normal, forces.rolling, forces.lateral, forces.ratio, forces.given):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0


def test_force_space_spans_what_balances_and_nothing_else():
    problem = rough(2)
    space = problem.space
    rng = np.random.default_rng(0)
    for _ in range(5):
        local = space.particular + space.basis @ rng.normal(size=space.basis.shape[1])
        world = np.einsum("ka,kaw->kw", local.reshape(6, 3), problem.frames)
        assert unbalanced(problem.rows, world * 500.0, 500.0) < 1e-12
    assert space.basis.shape == (18, 12)


def test_multipliers_two_sided_and_one_sided():
    # one contact beside the centre of mass and a multiplier that takes up its moment about y
    rows = rigid_rows([[0.1, 0, 0]], (0, 0, 0), 10.0)
    frames = contact_frames(contacts_at([[0.1, 0, 0]], wheels=("a",)))
    column = np.array([[0], [0], [0], [0], [2.0], [0]])
    for lower, sign, balanced in ((-np.inf, 1, True), (-np.inf, -1, True), (0.0, 1, True), (0.0, -1, False)):
        held = Rows(rows.gravity, rows.contact, sign * column, np.array([lower]))
        problem = make_problem(contacts_at([[0.1, 0, 0]], wheels=("a",)), held, 10.0, 0.5, frozenset())
        assert force_space(held, frames, (False,), 10.0).consistent
        assert (unbalanced(held, np.array([[0, 0, 10.0]]), 10.0) < 1e-12) == balanced
        assert RULES["least_friction"](problem).feasible == balanced


def test_frames_are_right_handed_and_a_foot_has_one_too():
    contacts = contacts_at(
        [[0, 0, 0], [0, 0, 0]], [[0.3, 0.1, 1], [0, 0, 1]], wheels=("a", "b"), heading=(0, 0, 0)
    )
    for frame in contact_frames(contacts):
        np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-14)
        assert np.linalg.det(frame) == pytest.approx(1.0)
    assert contact_names(contacts) == ("a", "b")


@pytest.mark.parametrize("mu", [0.0, -0.1, float("nan"), float("inf"), "0.6", True])
def test_friction_must_be_a_positive_number(mu):
    with pytest.raises(
        InputError, match=r"^friction: not a coefficient of friction \(got .*\); give a number above 0"
    ):
        on_slope(0.1, mu=mu)


def test_declared_friction_must_be_positive_and_names_the_wheel():
    with pytest.raises(
        InputError, match=r"^ml: not a coefficient of friction .*declare the wheel's `friction`"
    ):
        on_slope(0.1, mu=None, friction=[0.5, 0.5, 0.0, 0.5, 0.5, 0.5])


def test_unknown_rule_names_the_nearest():
    stance = stance_of(contacts_at(HEXAGON), (0, 0, 0.3))
    with pytest.raises(
        InputError, match=r"rule: no such rule \(got 'least_torqe'\); did you mean 'least_torque'"
    ):
        distribute(stance, rule="least_torqe")


def test_a_stance_that_does_not_stand_has_no_forces():
    stance = stance_of(contacts_at(HEXAGON), (0, 0, 0.3), status=Status.TIPS, reason="rl would have to pull")
    with pytest.raises(
        InputError, match="the rover does not stand, so nothing carries it: rl would have to pull"
    ):
        distribute(stance)


@pytest.mark.parametrize("name", ["rocker_bogie", "hit_mrii"])
def test_real_stances_by_every_rule(name):
    rover = rp.load(name)
    stance = rp.settle(rover, rp.Terrain.slope(12), x=0.3, y=0.2, yaw=0.4)
    for rule in RULES:
        forces = distribute(stance, friction=0.8, rule=rule)
        assert forces.feasible, (rule, forces.reason)
        assert forces.residual < 1e-9
        assert forces.force[:, 2].sum() == pytest.approx(stance.weight, rel=1e-9)
        assert sum(forces.loads.values()) == pytest.approx(stance.weight, rel=1e-9)
    least = distribute(stance, friction=0.8, rule="least_friction")
    assert least.friction == pytest.approx(np.tan(np.radians(12)), abs=1e-6)
    along = turn(1, -np.radians(12))
    normal = along @ UP
    np.testing.assert_allclose(
        [c.normal for c in stance.contacts], np.tile(normal, (len(stance.contacts), 1)), atol=1e-9
    )
