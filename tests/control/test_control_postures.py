"""Motion constraints on posture: closed forms, hand numbers, finite differences."""

import math

import numpy as np
import pytest
from hit_mrii_closed_form import Machine
from sides import HIT, slope

import rover_pin as rp
from rover_pin.control.motion_constraints import Options, motion_constraints
from rover_pin.control.now import Now
from rover_pin.kinematics.instant import Bodies

MACHINE = Machine()
POSTURES = ("wheelbase", "height", "length")


def anywhere(hit, seed):
    """A configuration that need not stand: every coordinate off, heading and tilt too."""
    rng = np.random.default_rng(seed)
    q = rng.uniform(-0.5, 0.5, hit.model.nv)
    q[3] = rng.uniform(-3.0, 3.0)
    return q


@pytest.mark.parametrize("name", POSTURES)
@pytest.mark.parametrize("seed", range(4))
def test_gradients(hit, level, constraints, still, name, seed):
    q = anywhere(hit, seed)
    constraint = constraints[name]
    found = constraint.gradient(Now(level.at(q), still, still))
    wanted = slope(lambda p: constraint.value(Now(level.at(p), still, still)), q)
    assert found.shape == (len(constraint.parts), hit.model.nv)
    np.testing.assert_allclose(found, wanted, atol=1e-6)


@pytest.mark.parametrize("clearance", [0.15, 0.25, 0.33, 0.45, 0.48, 0.55])
def test_wheelbase_of_the_closed_form(hit, level, constraints, still, clearance):
    stance = rp.settle(hit, rp.Terrain.flat(), posture={"clearance": clearance})
    values = constraints["wheelbase"].value(Now(level.at(stance.configuration), still, still))
    np.testing.assert_allclose(values, MACHINE.shortening(stance.joints["L_act"]), atol=1e-9)


def test_wheelbase_of_the_note(level, constraints, raised, still):
    values = constraints["wheelbase"].value(Now(level.at(raised.configuration), still, still))
    np.testing.assert_allclose(values, 0.322, atol=5e-4)


def test_wheelbase_divisor(hit, level, raised, still):
    """The paper prints 1550 mm."""
    halved = motion_constraints(hit, HIT, ["wheelbase"], Options(wheelbase_divisor=1.55))["wheelbase"]
    now = Now(level.at(raised.configuration), still, still)
    np.testing.assert_allclose(halved.value(now), 0.322 / 2, atol=5e-4)
    np.testing.assert_allclose(halved.gradient(now) * 1.55, -halved.stations.at(now.at).apart_rows)


@pytest.mark.parametrize("heading", [0.0, 1.1, -2.5])
def test_wheelbase_knows_no_heading(hit, constraints, still, heading):
    stance = rp.settle(hit, rp.Terrain.flat(), yaw=heading, joints={"L_act": 0.3, "R_act": 0.1})
    now = Now(Bodies(hit, rp.Terrain.flat()).at(stance.configuration), still, still)
    left, right = constraints["wheelbase"].value(now)
    assert left == pytest.approx(MACHINE.shortening(0.3), abs=2e-3)  # not quite: the body rolls
    assert right == pytest.approx(MACHINE.shortening(0.1), abs=2e-3)


def test_height_is_the_sine_of_roll(hit, level, constraints, still):
    q = hit.configuration(rpy=(0.1, 0.05, 0.7))
    value = constraints["height"].value(Now(level.at(q), still, still))
    assert value == pytest.approx([math.sin(0.1) * math.cos(0.05)], abs=1e-12)


def test_length_of_unlike_rockers(hit, level, constraints, still):
    """Level body, bogies level: hinges are R cos b - 387.5 mm ahead of the middle wheels."""
    left, right = 0.4, 0.1
    joints = {"L_act": left, "L_bogie": left, "R_act": right, "R_bogie": right}  # unlike axes: level again
    q = hit.configuration(joints)
    value = constraints["length"].value(Now(level.at(q), still, still))
    arms = [MACHINE.rear_arm * math.cos(MACHINE.theta20 + u) for u in (left, right)]
    assert value == pytest.approx([(arms[0] - arms[1]) / 0.83], abs=1e-9)


def test_hinges_of_one_body_stay_abreast(hit, level, constraints, still):
    """Why `length` is taken from the wheels: in the body's own heading the hinges tell nothing."""
    stance = rp.settle(hit, rp.Terrain.flat(), joints={"L_act": 0.5, "R_act": 0.0})
    now = Now(level.at(stance.configuration), still, still)
    placed = constraints["length"].stations.at(now.at)
    apart = (placed.hinges[0] - placed.hinges[1]) @ placed.heading
    assert abs(apart) < 1e-3
    assert constraints["length"].value(now) == pytest.approx([-0.083], abs=5e-4)


def test_length_turns_the_body(hit, level, constraints, still):
    """Middle wheels that stay where they are turn the body by about the index times span over track."""
    joints = {"L_act": 0.4, "L_bogie": 0.4, "R_act": 0.1, "R_bogie": 0.1}
    q = hit.configuration(joints)
    index = float(constraints["length"].value(Now(level.at(q), still, still))[0])
    middle = level.at(q).centers[level.at(q).index(["LM", "RM"])]
    across = middle[0] - middle[1]
    turn = math.atan2(across[0], across[1])
    assert turn == pytest.approx(-index * 0.83 / 1.304, rel=0.02)
