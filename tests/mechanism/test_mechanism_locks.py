"""Locks: what may be locked, and where."""

import pytest

from rover_pin.errors import PostureError
from rover_pin.mechanism import Lock
from rover_pin.mechanism.lock import engage


def test_a_lock_holds_where_the_posture_says():
    assert engage(["a", "b"], ["a", "b", "c"], {"a": 0.3}) == (Lock("a", 0.3), Lock("b", 0.0))


def test_nothing_engaged_is_nothing_held():
    assert engage([], ["a"], {"a": 1.0}) == ()


def test_a_joint_that_is_not_lockable_names_the_nearest():
    with pytest.raises(PostureError) as caught:
        engage(["L_bogi"], ["L_bogie", "R_bogie"], {}, file="rover.yaml")
    text = str(caught.value)
    assert text.startswith("rover.yaml: lock: not a joint that can be locked (got 'L_bogi'); did you mean")
    assert "'L_bogie'" in text


def test_without_lockable_joints_the_cure_is_the_sidecar():
    with pytest.raises(PostureError, match="list it under `locks` in the sidecar"):
        engage(["bogie"], [], {})
