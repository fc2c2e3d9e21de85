"""Joints that nothing holds: masts, legs, casters, clutches."""

import math

import numpy as np
import pytest
from little_rover import Builder, fixture, four_wheels

import rover_pin as rp
from rover_pin.errors import PostureError

FLAT = rp.Terrain.flat()


def mast(tmp_path, limits, axis=(0.0, 1.0, 0.0), lean=0.0, **sidecar):
    """A box on four wheels with a mast on a joint; `lean` puts its mass ahead of the joint."""
    made = four_wheels(mass=40)
    made.link("mast_link", 2.0, (lean, 0, 0.4))
    made.joint("mast", "base_link", "mast_link", (0, 0, 0.1), axis=axis, limits=limits)
    return made.say(**sidecar).load(tmp_path)


@pytest.mark.parametrize("lean", [0.0, 0.05, -0.05])
@pytest.mark.parametrize("limits", [(-1.2, 1.2), (-0.3, 2.0)])
def test_a_passive_mast_falls_to_its_stop_and_is_named(tmp_path, limits, lean):
    stance = rp.settle(mast(tmp_path, limits, lean=lean), FLAT)
    assert stance.status is rp.Status.LOOSE, stance
    assert stance.limiting == "mast"
    assert "mast" in stance.reason


def test_a_mast_that_is_driven_or_locked_stands(tmp_path):
    driven = rp.settle(mast(tmp_path / "a", (-1.2, 1.2), actuated=["mast"]), FLAT)
    assert driven.settled, driven.reason
    lockable = mast(tmp_path / "b", (-1.2, 1.2), locks=["mast"])
    locked = rp.settle(lockable, FLAT, locks=["mast"])
    assert locked.settled, locked.reason
    assert locked.locked == ("mast",)
    given = rp.settle(lockable, FLAT, joints={"mast": 0.2})
    assert given.settled, given.reason
    assert given.joints["mast"] == 0.2
    for wheel, load in driven.loads.items():
        assert locked.loads[wheel] == pytest.approx(load, abs=1e-9)


def test_a_pendulum_hangs(tmp_path):
    """A passive joint with its mass below is not loose: it hangs plumb, on a slope too."""
    made = four_wheels(mass=40, drop=0.6)
    made.link("bob", 2.0, (0, 0, -0.3)).joint("hook", "base_link", "bob", limits=(-1.2, 1.2))
    stance = rp.settle(made.load(tmp_path), rp.Terrain.slope(15))
    assert stance.settled, stance.reason
    assert stance.joints["hook"] == pytest.approx(math.radians(15), abs=1e-8)
    assert stance.undetermined == ()
    assert not stance.stops


def test_a_mast_that_only_turns_is_undetermined(tmp_path):
    """About the vertical, its mass on the axis: nothing turns it anywhere, on a slope neither."""
    rover = mast(tmp_path, None, axis=(0.0, 0.0, 1.0))
    for ground in (FLAT, rp.Terrain.slope(10)):
        stance = rp.settle(rover, ground, posture={"mast": 0.7})
        assert stance.settled, stance
        assert stance.undetermined == ("mast",)
        assert stance.joints["mast"] == pytest.approx(0.7, abs=1e-9)


def test_a_mast_without_limits_falls_and_is_named(tmp_path):
    stance = rp.settle(mast(tmp_path, None, lean=0.02), FLAT)
    assert not stance.settled or abs(abs(stance.joints["mast"]) - math.pi) < 0.1
    if not stance.settled:
        assert stance.status is rp.Status.LOOSE, stance
        assert stance.limiting == "mast"


def legged(tmp_path, limits, **sidecar):
    """Front wheels on legs that lean forward 45 deg on a hip each; rear wheels on the body."""
    made = Builder("legged").link("base_link", 30, box=(0.6, 0.3, 0.1))
    for side, y in (("l", 0.4), ("r", -0.4)):
        made.wheel(f"b{side}", "base_link", (-0.4, y, -0.3))
        made.link(f"leg_{side}", 0.5, (0.15, 0, -0.15))
        made.joint(f"hip_{side}", "base_link", f"leg_{side}", (0.3, y, 0), limits=limits)
        made.wheel(f"f{side}", f"leg_{side}", (0.3, 0, -0.3))
    return made.say(**sidecar).load(tmp_path)


def test_legs_that_were_forgotten_among_the_actuated_are_named(tmp_path):
    """Without a motor the hips fold: the rover does not stand, and the message says which joint."""
    stance = rp.settle(legged(tmp_path / "a", None), FLAT)
    assert not stance.settled
    assert stance.status in (rp.Status.LOOSE, rp.Status.GROUNDED, rp.Status.TIPS), stance
    if stance.status is not rp.Status.GROUNDED:
        assert stance.limiting in ("hip_l", "hip_r")
    stands = rp.settle(legged(tmp_path / "b", None, actuated=["hip_l", "hip_r"]), FLAT)
    assert stands.settled, stands.reason


def test_legs_that_fold_onto_their_stops_stand_there(tmp_path):
    """Limits of 0.1 rad: the wheels bear, the stops carry: a stance, lower by the fold."""
    stance = rp.settle(legged(tmp_path, (-0.1, 0.1)), FLAT)
    assert stance.settled, stance.reason
    assert set(stance.stops) == {"hip_l", "hip_r"}
    assert stance.joints["hip_l"] == pytest.approx(-0.1, abs=1e-8)
    load, pitch = stance.loads["fl"], stance.rpy[1]
    at = 0.3 * math.sqrt(2) * math.cos(math.pi / 4 + stance.joints["hip_l"] + pitch)
    moment = load * at - 0.5 * 9.81 * at / 2 - 1e-6 * 9.81 * at
    assert stance.stops["hip_l"] == pytest.approx(moment, rel=1e-6)


def test_a_forgotten_drive_of_a_wheel_is_braked():
    """A wheel's own joint is held, listed as actuated or not (the caster's is not)."""
    stance = rp.settle(fixture("caster3"), rp.Terrain.slope(3), yaw=math.pi)
    assert stance.settled, stance.reason
    assert stance.joints["drive_c"] == 0.0


@pytest.mark.parametrize("angle", [-2.0, 0.0, 0.4, 1.5, 3.0])
def test_a_caster_keeps_its_posture_on_level_ground(angle):
    rover = fixture("caster3")
    for ground in (FLAT, rp.Terrain.flat(0.4)):
        stance = rp.settle(rover, ground, posture={"fork": angle}, yaw=0.3)
        assert stance.settled, stance
        assert stance.undetermined == ("fork",)
        assert stance.joints["fork"] == pytest.approx(angle, abs=1e-7)
        assert sum(stance.loads.values()) == pytest.approx(stance.weight, rel=1e-9)


def test_a_caster_hangs_uphill_on_a_slope():
    rover = fixture("caster3")
    stance = rp.settle(rover, rp.Terrain.slope(8), yaw=math.pi, posture={"fork": 0.3})
    assert stance.settled, stance
    assert stance.joints["fork"] == pytest.approx(0.0, abs=1e-7)
    assert stance.undetermined == ()


def test_a_locked_caster_is_not_undetermined():
    stance = rp.settle(fixture("caster3"), FLAT, joints={"fork": 0.4})
    assert stance.settled, stance
    assert stance.undetermined == ()
    assert stance.locked == ("fork",)
    assert stance.joints["fork"] == 0.4


def bump(x, y):
    """Under the left wheels of a six-wheeler."""
    x, y = np.asarray(x), np.asarray(y)
    return 0.1 * np.exp(-((x + 0.7) ** 2 + (y - 0.65) ** 2) / 0.15)


def test_clutches_hold_the_bogies():
    rover = rp.load("hit_mrii")
    ground = rp.Terrain.from_function(bump)
    free = rp.settle(rover, ground)
    held = rp.settle(rover, ground, locks=["L_bogie", "R_bogie"])
    assert free.settled, free.reason
    assert held.settled, held.reason
    assert abs(free.joints["L_bogie"]) > 0.01
    assert held.joints["L_bogie"] == 0.0
    assert held.locked == ("L_bogie", "R_bogie")
    assert sum(load > 0 for load in free.loads.values()) == 6
    assert sum(load > 0 for load in held.loads.values()) < 6
    assert sum(held.loads.values()) == pytest.approx(held.weight, rel=1e-9)


def test_a_lock_takes_the_posture_s_value():
    held = rp.settle(rp.load("hit_mrii"), FLAT, locks=["L_bogie"], posture={"L_bogie": 0.1, "L_act": 0.1})
    assert held.settled, held.reason
    assert held.joints["L_bogie"] == 0.1
    assert held.joints["L_act"] == 0.1


def test_a_given_passive_joint_is_locked_and_carries_its_coupling():
    """Half a differential held is both halves held."""
    stance = rp.settle(rp.load("hit_mrii"), FLAT, joints={"L_diff": 0.05})
    assert stance.settled, stance.reason
    assert stance.locked == ("L_diff",)
    assert stance.joints["L_diff"] == 0.05
    assert stance.joints["R_diff"] == pytest.approx(-0.05, abs=1e-15)
    geared = rp.settle(rp.load("hit_mrii"), FLAT, joints={"L_act": 0.22, "R_act": 0.11})
    assert geared.joints["L_fr"] == pytest.approx(0.1, abs=1e-12)
    assert geared.joints["R_fr"] == pytest.approx(0.05, abs=1e-12)


def test_a_posture_on_a_passive_joint_only_starts_there():
    free = rp.settle(fixture("thirds"), FLAT, posture={"bogie_l": 0.3})
    assert free.settled, free.reason
    assert free.locked == ()
    assert free.joints["bogie_l"] == pytest.approx(0.0, abs=1e-8)


def test_given_joints_outdo_the_posture():
    stance = rp.settle(rp.load("hit_mrii"), FLAT, posture="raised", joints={"L_act": 0.5, "R_act": 0.5})
    assert stance.joints["L_act"] == 0.5
    assert stance.settled


def test_what_cannot_be_locked_is_told():
    with pytest.raises(PostureError, match=r"not a joint that can be locked \(got 'L_bogi'\); did you mean"):
        rp.settle(rp.load("hit_mrii"), FLAT, locks=["L_bogi"])
    with pytest.raises(PostureError, match="list it under `locks` in the sidecar"):
        rp.settle(fixture("thirds"), FLAT, locks=["bogie_l"])
