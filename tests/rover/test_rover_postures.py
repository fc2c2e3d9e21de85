"""Postures by name or mapping, and what they may not be."""

import numpy as np
import pytest

import rover_pin as rp

SIDECAR = "postures: {home: {j: 0.2}, folded: {j: -0.5}}"


def refused(rover, posture):
    with pytest.raises(rp.errors.PostureError) as caught:
        rover.resolve_posture(posture)
    return str(caught.value).replace(f"{rover.source.parent}/", "")


def test_by_name_or_mapping(make):
    rover = make.load(*make.pair(), sidecar=SIDECAR)
    assert rover.home == {"j": 0.2}
    assert rover.resolve_posture("folded") == {"j": -0.5}
    assert rover.resolve_posture(None) == rover.resolve_posture() == {"j": 0.2}
    assert rover.resolve_posture({"j": np.float64(0.9)}) == {"j": 0.9}
    assert rover.neutral[6] == 0.2
    assert rover.configuration({"j": 0.7})[6] == 0.7


def test_home_may_be_silent(make):
    rover = make.load(*make.pair(), sidecar="")
    assert rover.home == {}
    assert rover.resolve_posture("home") == {}


def test_unknown_names(make):
    rover = make.load(*make.pair(), sidecar=SIDECAR)
    assert refused(rover, "foldet") == (
        "rover.yaml: posture: no posture of that name (got 'foldet'); did you mean 'folded'?"
    )
    assert (
        refused(rover, {"jj": 0.1}) == "joint jj: no moving joint of that name (got 0.1); did you mean 'j'?"
    )


def test_values(make):
    rover = make.load(*make.pair(), sidecar=SIDECAR)
    assert refused(rover, {"j": 1.5}) == (
        "posture outside limits: Joint j: -1 <= 1.5 <= 1; stay within the limits"
    )
    assert refused(rover, {"j": float("nan")}) == "joint j: not a finite number (got nan); give rad or m"
    assert refused(rover, {"j": "up"}) == "joint j: not a finite number (got 'up'); give rad or m"
    assert rover.resolve_posture({"j": 1.0 + 1e-12}) == {"j": 1.0 + 1e-12}


def test_zero_outside_the_limits_gives_way_to_the_nearest(make):
    assert make.load(*make.pair(limits="0.3 0.8")).neutral[6] == 0.3


def test_a_held_joint_may_be_named_at_its_place(make):
    rover = make.load(*make.pair(limits="0.4 0.4"), sidecar="postures: {home: {j: 0.4}}")
    assert rover.home == {}
    assert make.refused(*make.pair(limits="0.4 0.4"), sidecar="postures: {home: {j: 0.5}}") == (
        "rover.yaml: postures.home.j: no moving joint of that name (got 0.5); there are none"
    )
