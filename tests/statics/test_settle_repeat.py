"""The same question has the same answer, bit for bit, whatever was asked before."""

import math
import pickle

import numpy as np
import pytest
from little_rover import FIXTURES, fixture

import rover_pin as rp
from rover_pin.statics import level as module

ROUGH = rp.Terrain.rough(1, 0.05, 0.8)
NAMES = ("rocker_bogie", "hit_mrii", "rigid4", "sprung4", "trailing4", "turnbuckle")


def fresh(name):
    if name in ("rocker_bogie", "hit_mrii"):
        return rp.load(name)
    return rp.load(FIXTURES / name / f"{name}.urdf")


def fingerprint(stance):
    """Every number of a stance, as bytes."""
    numbers = [*stance.configuration, *stance.com, *stance.loads.values(), *stance.gaps.values()]
    numbers += [*stance.springs.values(), *stance.stops.values(), *stance.residuals.values()]
    for contact in stance.contacts:
        numbers += [*contact.point, *contact.normal, *contact.rolling, contact.load, contact.gap]
    words = (str(stance.status), stance.reason, stance.limiting, stance.redundant, stance.undetermined)
    return words, np.array(numbers).tobytes()


def ask(rover, i=0):
    return rp.settle(rover, ROUGH, x=0.4 + i, y=-0.3 * i, yaw=0.5 + i)


@pytest.mark.parametrize("name", NAMES)
def test_twice_is_the_same_and_others_between_change_nothing(name):
    rover = fresh(name)
    first = fingerprint(ask(rover))
    assert fingerprint(ask(rover)) == first
    for i in range(1, 5):
        ask(rover, i)
    rp.settle(rover, rp.Terrain.flat(), gravity=1.62)
    rp.settle(rover, rp.Terrain.slope(80), yaw=math.pi / 2)
    assert fingerprint(ask(rover)) == first
    assert fingerprint(ask(fresh(name))) == first


def test_the_order_of_questions_does_not_matter():
    one, other = fresh("rocker_bogie"), fresh("rocker_bogie")
    forwards = [fingerprint(ask(one, i)) for i in range(6)]
    backwards = [fingerprint(ask(other, i)) for i in reversed(range(6))]
    assert forwards == backwards[::-1]


def test_what_is_kept_of_level_ground_changes_nothing():
    """More postures than are kept, then the first again."""
    rover = fresh("hit_mrii")
    first = fingerprint(rp.settle(rover, ROUGH, x=0.4, joints={"L_act": 0.0}))
    for i in range(module.KEPT + 3):
        rp.settle(rover, rp.Terrain.flat(), joints={"L_act": 0.001 * (i + 1)})
    assert len(module._footings[rover]) <= module.KEPT
    assert fingerprint(rp.settle(rover, ROUGH, x=0.4, joints={"L_act": 0.0})) == first


def test_a_pickled_rover_answers_alike():
    rover = fresh("rocker_bogie")
    assert fingerprint(ask(pickle.loads(pickle.dumps(rover)))) == fingerprint(ask(rover))


def test_a_pickled_terrain_answers_alike():
    rover = fresh("rocker_bogie")
    there = pickle.loads(pickle.dumps(ROUGH))
    here = fingerprint(ask(rover))
    assert fingerprint(rp.settle(rover, there, x=0.4, y=-0.0, yaw=0.5)) == here


def test_payload_does_not_share_what_is_kept():
    rover = fresh("rigid4")
    bare = rp.settle(rover, rp.Terrain.flat())
    laden = rp.settle(rover.with_payload([(10.0, (0.2, 0, 0))]), rp.Terrain.flat())
    again = rp.settle(rover, rp.Terrain.flat())
    assert fingerprint(again) == fingerprint(bare)
    assert sum(laden.loads.values()) == pytest.approx(bare.weight + 98.1)


def test_a_stance_is_not_changed_by_the_next_settle():
    rover = fixture("turnbuckle")
    stance = ask(rover)
    before = fingerprint(stance)
    ask(rover, 2)
    assert fingerprint(stance) == before


def test_what_a_stance_hands_out_is_read_only():
    stance = ask(fixture("rigid4"))
    for array in (stance.configuration, stance.position, stance.rpy, stance.com, stance.contacts[0].point):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0
    for mapping in (stance.loads, stance.joints, stance.residuals, stance.gaps, stance.springs, stance.stops):
        with pytest.raises(TypeError):
            mapping["fl"] = 1.0


def test_a_whole_turn_changes_nothing_but_the_yaw():
    rover = fixture("four_bar")
    one = rp.settle(rover, ROUGH, x=0.5, yaw=0.3)
    other = rp.settle(rover, ROUGH, x=0.5, yaw=0.3 + 2 * math.pi)
    np.testing.assert_allclose(one.rpy[:2], other.rpy[:2], atol=1e-9)
    for wheel, load in one.loads.items():
        assert other.loads[wheel] == pytest.approx(load, abs=1e-5)
