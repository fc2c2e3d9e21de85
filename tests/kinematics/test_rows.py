"""Rows against differences of places, on several rovers and grounds."""

import numpy as np
import pytest
from places import GROUNDS, ROVERS, difference, resting

from rover_pin.errors import InputError
from rover_pin.kinematics.advance import Sliding, advance
from rover_pin.kinematics.rolling import contact_rows, ground_rows, rim_rows
from rover_pin.kinematics.tasks import clearance as belly
from rover_pin.kinematics.tasks.wheel_lift import height, height_row
from rover_pin.kinematics.wheelbase import wheelbase, wheelbase_row

PLACES = [(name, word) for name in ROVERS for word in GROUNDS]


@pytest.fixture(params=PLACES, ids=lambda place: "-".join(place))
def at(request):
    return resting(*request.param)


def everything(at):
    return np.arange(len(at.bodies.names))


def test_the_gaps_rate(at):
    rows = contact_rows(at, everything(at), ("normal",))
    assert rows == pytest.approx(difference(lambda now: now.contacts[:, 0], at), abs=2e-6)


def test_sliding_is_what_places_say(at):
    """Along the ground, a material point where a wheel touches slides by its row times the step."""
    rng = np.random.default_rng(1)
    which = everything(at)
    rows = contact_rows(at, which)
    for _ in range(3):
        v, dt = rng.normal(size=len(at.q)), 1e-6
        sliding = Sliding(at)
        sliding.step(advance(at, v, dt))
        along, across = (rows @ v).reshape(3, -1)[1:]
        slid = sliding.slid / dt
        assert np.einsum("ij,ij->i", slid, at.rolling) == pytest.approx(along, abs=2e-4)
        assert np.einsum("ij,ij->i", slid, at.sideways) == pytest.approx(across, abs=2e-4)


def test_a_drive_rolls_its_wheel_forward(at):
    wheels = [i for i, wheel in enumerate(at.rover.wheels) if wheel.drive and at.contacts[i, 0] < 1e-5]
    if not wheels:
        pytest.skip("no drives")
    which = np.array(wheels)
    columns = [at.rover.column[at.rover.wheels[i].drive] for i in wheels]
    roll, rim = contact_rows(at, which, ("roll",)), rim_rows(at, which)
    for row, encoder, place, column in zip(roll, rim, wheels, columns, strict=True):
        assert encoder[column] == pytest.approx(
            -row[column], rel=0.02
        )  # the tread's curve where the ground tilts
        assert abs(encoder[column]) == pytest.approx(at.rover.wheels[place].radius)


def test_the_centre_of_mass(at):
    assert np.array(at.com_rows) == pytest.approx(difference(lambda now: now.com, at), abs=1e-8)


def test_a_wheels_speed_over_the_ground(at):
    which = np.arange(len(at.rover.wheels))
    if not len(which):
        pytest.skip("no wheels")
    places = difference(lambda now: now.centers[which].ravel(), at).reshape(len(which), 3, -1)
    expected = np.einsum("ij,ijk->ik", at.rolling[which], places)
    assert ground_rows(at, which) == pytest.approx(expected, abs=1e-8)


def test_clearance(at):
    if not at.rover.belly:
        with pytest.raises(InputError, match="belly: a clearance needs belly points; declare `belly`"):
            belly.clearance(at)
        return
    assert belly.clearance_row(at) == pytest.approx(difference(belly.clearance, at)[0], abs=1e-6)


def test_the_wheelbase():
    for word in GROUNDS:
        at = resting("hit_mrii", word)
        found = difference(lambda now: wheelbase(now, "LF", "RB"), at)[0]
        assert wheelbase_row(at, "LF", "RB") == pytest.approx(found, abs=1e-8)


@pytest.mark.parametrize("word", GROUNDS)
def test_heights_over_the_ground_below(word):
    """The wheel leans too: turned by its steering and tilted with the rover, its lowest point moves."""
    at = resting("hit_mrii", word)
    q = at.q.copy()
    q[at.rover.column["RM_st"]], q[5] = 0.3, q[5] + 0.2
    leaning = at.bodies.at(q)
    which = leaning.index(["RM"])
    found = difference(lambda now: height(now, int(which[0])), leaning)
    assert height_row(leaning, which) == pytest.approx(found, abs=1e-6)


def test_frames_and_turns():
    import pinocchio as pin

    at = resting("hit_mrii", "rough:3,0.04,0.8")
    joint, origin, rotation = at.frame("RB_wheel")
    rows = at.rows(np.full(3, joint), np.tile(origin, (3, 1)), np.eye(3))
    assert rows == pytest.approx(difference(lambda now: now.frame("RB_wheel")[1], at), abs=1e-8)
    turns = at.turns(np.full(3, joint), np.eye(3))
    found = difference(lambda now: rotation @ pin.log3(rotation.T @ now.frame("RB_wheel")[2]), at)
    assert turns == pytest.approx(found, abs=1e-7)


def test_an_instant_survives_the_next_one():
    at = resting("hit_mrii", "flat")
    before = np.array(at.frame("RB_wheel")[1])
    at.bodies.at(at.q + 0.1)
    assert at.frame("RB_wheel")[1] == pytest.approx(before, abs=0)


def test_refusals():
    at = resting("hit_mrii", "flat")
    with pytest.raises(
        InputError, match=r"q: a configuration has one entry a degree of freedom \(got \(3,\)\)"
    ):
        at.bodies.at(np.zeros(3))
    q = at.q.copy()
    q[at.rover.column["L_act"]] = np.nan
    with pytest.raises(InputError, match=r"L_act: is no finite number \(got nan\)"):
        at.bodies.at(q)
    with pytest.raises(InputError, match="XF: no wheel or foot of that name; did you mean"):
        at.index(["XF"])
    with pytest.raises(InputError, match=r"v: a velocity has one entry a coordinate \(got \(2,\)\)"):
        advance(at, np.zeros(2), 0.1)
    assert not at.q.flags.writeable
