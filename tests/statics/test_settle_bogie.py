"""The body's six rows alone are optimistic: the bogies' rows say no where the body says yes."""

import dataclasses
import math

import numpy as np
import pytest
from little_rover import fixture

import rover_pin as rp
from rover_pin.statics.balance import balance
from rover_pin.statics.distribute import RULES
from rover_pin.statics.friction_problem import make_problem


def body_only(stance, friction):
    """The friction problem with the rows of the base alone."""
    rows = balance(stance)
    body = [k for k, name in enumerate(rows.rows) if name.startswith("base_")]
    assert len(body) == 6
    assert len(rows.rows) == 8
    kept = dataclasses.replace(
        rows,
        rows=tuple(rows.rows[k] for k in body),
        gravity=rows.gravity[body],
        contact=rows.contact[body],
        internal=rows.internal[body],
    )
    driven = frozenset({"ml", "bl", "mr", "br"})
    return make_problem(stance.contacts, kept, stance.weight, friction, driven)


@pytest.mark.parametrize(
    ("slope", "by_body", "by_bogies"),
    [(5.0, True, True), (6.5, True, True), (6.7, True, False), (15.0, True, False), (21.0, True, False)],
)
def test_bogies_forbid_what_the_body_allows(slope, by_body, by_bogies):
    """By hand: the body up to 26.57 deg at friction 0.8; with the bogies 6.58 deg at any friction."""
    stance = rp.settle(fixture("bogie_min"), rp.Terrain.slope(slope))
    assert stance.settled, stance.reason
    optimistic = RULES["least_torque"](body_only(stance, 0.8))
    assert optimistic.feasible is by_body, optimistic.reason
    for friction in (0.8, 5.0):
        for rule in ("least_friction", "least_torque"):
            whole = rp.distribute(stance, friction=friction, rule=rule)
            assert whole.feasible is (by_bogies and friction >= whole_need(stance)), whole.reason


def whole_need(stance):
    """Least friction with every row, inf where nothing helps."""
    found = rp.distribute(stance, friction=50.0, rule="least_friction")
    return found.friction if found.feasible else math.inf


def test_the_two_verdicts_side_by_side():
    stance = rp.settle(fixture("bogie_min"), rp.Terrain.slope(10))
    body = RULES["least_friction"](body_only(stance, 0.8))
    whole = rp.distribute(stance, friction=0.8, rule="least_friction")
    assert body.feasible
    assert body.friction < 0.8
    assert not whole.feasible
    assert whole.reason


def test_the_limit_of_the_bogies_is_where_it_is_by_hand():
    """H / a tan(slope) = 0.3 - 0.1 tan(slope) with H / a = 2.5: tan(slope) = 0.3 / 2.6."""
    limit = math.degrees(math.atan(0.3 / 2.6))
    assert limit == pytest.approx(6.58, abs=5e-3)
    below, above = (rp.settle(fixture("bogie_min"), rp.Terrain.slope(limit + d)) for d in (-0.02, 0.02))
    assert rp.distribute(below, friction=50.0, rule="least_friction").feasible
    assert not rp.distribute(above, friction=50.0, rule="least_friction").feasible


def test_the_balance_is_the_equilibrium_of_the_stance():
    """Vertical loads solve every row; gravity of the base's rows is the weight."""
    stance = rp.settle(fixture("bogie_min"), rp.Terrain.rough(1, 0.02, 0.8), x=0.4)
    assert stance.settled, stance.reason
    rows = balance(stance)
    forces = np.concatenate([[0, 0, contact.load] for contact in stance.contacts])
    np.testing.assert_allclose(rows.contact @ forces, rows.gravity, atol=1e-8 * stance.weight)
    assert rows.gravity[rows.rows.index("base_z")] == pytest.approx(stance.weight)
    assert rows.gravity[rows.rows.index("base_x")] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("name", ["turnbuckle", "four_bar", "sprung4", "trailing4", "thirds"])
def test_balance_holds_with_loops_springs_and_couplings(name):
    """Multipliers of loops and stops fitted: nothing is left."""
    stance = rp.settle(fixture(name), rp.Terrain.rough(1, 0.02, 0.8), x=0.3, yaw=0.2)
    assert stance.settled, stance.reason
    rows = balance(stance)
    forces = np.concatenate([[0, 0, contact.load] for contact in stance.contacts])
    rest = rows.gravity - rows.contact @ forces
    if rows.internal.shape[1]:
        rest = rest - rows.internal @ np.linalg.lstsq(rows.internal, rest, rcond=1e-10)[0]
    np.testing.assert_allclose(rest, 0.0, atol=1e-7 * stance.weight)
    wheels = rp.distribute(stance, rule="vertical")
    for wheel, load in stance.loads.items():
        if load > 0:
            assert wheels.loads[wheel] == pytest.approx(load, abs=1e-9)


@pytest.mark.parametrize("slope", [3.0, 10.0, 25.0])
@pytest.mark.parametrize("name", ["rigid4", "thirds", "rocker_bogie"])
def test_a_slope_asks_for_its_tangent(name, slope):
    rover = rp.load(name) if name == "rocker_bogie" else fixture(name)
    stance = rp.settle(rover, rp.Terrain.slope(slope), yaw=0.3)
    assert stance.settled, stance.reason
    found = rp.distribute(stance, friction=0.9, rule="least_friction")
    assert found.friction == pytest.approx(math.tan(math.radians(slope)), abs=1e-6)
