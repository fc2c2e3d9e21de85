"""Mechanisms with loops on slopes: counts, what they stand for, locks that carry through them."""

import math

import numpy as np
import pytest
from little_rover import Builder, fixture

import rover_pin as rp
from rover_pin.errors import MechanismError

COUNTS = {
    ("four_bar", "rover.yaml"): (5, 2, 5),
    ("four_bar", "planar.yaml"): (5, 0, 5),
    ("four_bar", "coupling.yaml"): (5, 0, 5),
    ("turnbuckle", "rover.yaml"): (6, 0, 5),
    ("turnbuckle", "coupling.yaml"): (1, 0, 10),
    ("thirds", "rover.yaml"): (1, 0, 9),
    ("rigid4", "rover.yaml"): (0, 0, 4),
}


@pytest.mark.parametrize("which", COUNTS, ids=lambda w: "-".join(w))
def test_rank_redundancy_and_mobility(which):
    info = fixture(*which).info()
    assert (info["rank"], info["redundancy"], info["mobility"]) == COUNTS[which]


@pytest.mark.parametrize("heading", [0, 90, 200])
@pytest.mark.parametrize("name", ["four_bar", "turnbuckle"])
def test_loops_stand_on_a_slope_as_the_coupling_they_stand_for(name, heading):
    ground = rp.Terrain.slope(14, heading)
    built = rp.settle(fixture(name), ground, yaw=0.4)
    stated = rp.settle(fixture(name, "coupling.yaml"), ground, yaw=0.4)
    assert built.settled, built.reason
    assert stated.settled, stated.reason
    np.testing.assert_allclose(built.position, stated.position, atol=1e-8)
    np.testing.assert_allclose(built.rpy, stated.rpy, atol=1e-8)
    for wheel, load in stated.loads.items():
        assert built.loads[wheel] == pytest.approx(load, abs=1e-4)
    assert built.residuals["loop_m"] < 1e-9
    assert built.residuals["equilibrium"] < 1e-9
    assert built.redundant == 0  # four wheels, four freedoms


def test_parallel_legs_stay_parallel():
    stance = rp.settle(fixture("four_bar"), rp.Terrain.rough(4, 0.04, 0.8), x=1.0, y=0.3, yaw=1.0)
    assert stance.settled, stance.reason
    for side in "lr":
        upper = stance.joints[f"upper_{side}"]
        assert abs(upper) > 1e-3
        assert stance.joints[f"lower_{side}"] == pytest.approx(upper, abs=1e-8)
        assert stance.joints[f"knuckle_{side}"] == pytest.approx(-upper, abs=1e-8)
    assert stance.joints["upper_l"] == pytest.approx(-stance.joints["upper_r"], abs=1e-10)


def test_a_held_joint_carries_its_loop_and_coupling_along():
    """The right leg is coupled to the left one, each leg's lower link and knuckle come by the loop."""
    stance = rp.settle(fixture("four_bar"), rp.Terrain.flat(), joints={"upper_l": 0.3})
    assert stance.settled, stance.reason
    assert stance.locked == ("upper_l",)
    assert stance.joints["upper_l"] == 0.3
    assert stance.joints["lower_l"] == pytest.approx(0.3, abs=1e-9)
    assert stance.joints["knuckle_l"] == pytest.approx(-0.3, abs=1e-9)
    assert stance.joints["upper_r"] == pytest.approx(-0.3, abs=1e-9)
    assert stance.joints["lower_r"] == pytest.approx(-0.3, abs=1e-9)
    assert stance.redundant == 0  # rigid, but uneven: three wheels carry
    assert sum(load > 0 for load in stance.loads.values()) == 3


def test_a_held_bar_holds_both_rockers():
    stance = rp.settle(fixture("turnbuckle"), rp.Terrain.flat(), joints={"bar": 0.2})
    assert stance.settled, stance.reason
    left, right = stance.joints["rocker_l"], stance.joints["rocker_r"]
    assert left * right < 0
    assert left + right == pytest.approx(-2.1e-3, abs=1e-4) or left + right == pytest.approx(2.1e-3, abs=1e-4)
    assert abs(left) > 0.15


def test_held_values_that_contradict_a_loop_tell_the_residual():
    with pytest.raises(MechanismError) as caught:
        rp.settle(fixture("turnbuckle"), rp.Terrain.flat(), joints={"bar": 0.2, "rocker_l": 0.0})
    text = str(caught.value)
    assert "loops.rod_l: the loop does not close with the joints that are held: residual 0." in text
    assert text.endswith("hold fewer of its joints, or at values that close it")
    residual = float(text.split("residual ")[1].split(" m")[0])
    assert residual > 1e-3


def test_held_values_that_agree_with_a_loop_are_taken():
    free = rp.settle(fixture("turnbuckle"), rp.Terrain.flat(), joints={"bar": 0.2})
    both = rp.settle(
        fixture("turnbuckle"), rp.Terrain.flat(), joints={"bar": 0.2, "rocker_l": free.joints["rocker_l"]}
    )
    assert both.settled, both.reason
    np.testing.assert_allclose(both.rpy, free.rpy, atol=1e-7)


@pytest.mark.parametrize(
    ("name", "joints", "coupling", "residual"),
    [
        ("thirds", {"rocker_l": 0.1, "rocker_r": 0.05}, "differential", -0.15),
        ("hit_mrii", {"L_diff": 0.1, "R_diff": 0.1}, "differential", -0.2),
        ("four_bar", {"upper_l": 0.1, "upper_r": 0.1}, "swing", -0.2),
    ],
)
def test_held_values_that_contradict_a_coupling_tell_the_residual(name, joints, coupling, residual):
    rover = rp.load(name) if name == "hit_mrii" else fixture(name)
    with pytest.raises(MechanismError) as caught:
        rp.settle(rover, rp.Terrain.flat(), joints=joints)
    text = str(caught.value)
    assert text.startswith(
        f"couplings.{coupling}: held values contradict the coupling, residual {residual:g}"
    )
    for joint, value in joints.items():
        assert f"{joint} {value:g}" in text


def test_a_motor_that_contradicts_its_gear_is_told():
    """L_fr is geared to the actuated L_act: 1 to 2.2."""
    with pytest.raises(MechanismError, match=r"held values contradict the coupling, residual -?0\.\d+"):
        rp.settle(rp.load("hit_mrii"), rp.Terrain.flat(), joints={"L_act": 0.22, "L_fr": 0.2})
    stance = rp.settle(rp.load("hit_mrii"), rp.Terrain.flat(), joints={"L_act": 0.22, "L_fr": 0.1})
    assert stance.settled, stance.reason


def rod_rover(tmp_path, kind, **loop):
    """Two arms on the body, closed by a loop of a type: a linkage in the x-z plane, one freedom left or none.

    Arms of 0.3 m hang from (+-0.2, 0, 0); their ends are held together as the loop says.
    """
    made = Builder(f"rod_{kind}").link("base_link", 20)
    for name, x, y in (("fl", 0.5, 0.4), ("fr", 0.5, -0.4), ("bl", -0.5, 0.4), ("br", -0.5, -0.4)):
        made.wheel(name, "base_link", (x, y, -0.6))
    for name, x in (("front", 0.2), ("back", -0.2)):
        made.link(f"arm_{name}", 1.0, (0, 0, -0.15))
        made.joint(f"swing_{name}", "base_link", f"arm_{name}", (x, 0, 0), limits=(-1.2, 1.2))
    ends = [{"link": f"arm_{n}", "xyz": [0, 0, -0.3]} for n in ("front", "back")]
    made.say(loops=[{"name": "rod", "frames": ends, "type": kind, **loop}])
    return made.load(tmp_path)


def test_a_rod_between_two_arms(tmp_path):
    """Length 0.4 as at zero: a parallelogram that hangs straight; shorter: an isosceles linkage."""
    rover = rod_rover(tmp_path, "distance", length=0.3)
    info = rover.info()
    assert (info["rank"], info["redundancy"]) == (1, 0)
    stance = rp.settle(rover, rp.Terrain.flat())
    assert stance.settled, stance.reason
    front, back = stance.joints["swing_front"], stance.joints["swing_back"]
    # x of the ends: +-0.2 - 0.3 sin(q); 0.4 - 0.3 (sin f - sin b) = 0.3 by symmetry
    assert front == pytest.approx(math.asin(0.05 / 0.3), abs=1e-8)
    assert back == pytest.approx(-math.asin(0.05 / 0.3), abs=1e-8)


def test_a_rod_at_zero_keeps_its_length(tmp_path):
    rover = rod_rover(tmp_path, "distance", at="zero")
    stance = rp.settle(rover, rp.Terrain.slope(20))
    assert stance.settled, stance.reason
    # both arms hang along gravity
    for name in ("front", "back"):
        assert stance.joints[f"swing_{name}"] == pytest.approx(math.radians(20), abs=1e-7)


def test_a_weld_at_zero_freezes_the_arms(tmp_path):
    rover = rod_rover(tmp_path, "weld", at="zero")
    info = rover.info()
    assert (info["rank"], info["redundancy"]) == (2, 4)
    stance = rp.settle(rover, rp.Terrain.slope(20))
    assert stance.settled, stance.reason
    for name in ("front", "back"):
        assert stance.joints[f"swing_{name}"] == pytest.approx(0.0, abs=1e-9)


def test_a_hinge_and_a_plane_close_two_arms_alike(tmp_path):
    """Two arms of 0.3 m over a base of 0.4 m meet in a triangle: nothing is left to move."""
    angle = math.asin(0.2 / 0.3)
    for kind, rank, redundancy in (("hinge", 2, 3), ("planar", 2, 0), ("ball", 2, 1)):
        axis = {} if kind == "ball" else {"axis": [0, 1, 0]}
        rover = rod_rover(tmp_path / kind, kind, **axis)
        info = rover.info()
        assert (info["rank"], info["redundancy"]) == (rank, redundancy), kind
        stance = rp.settle(rover, rp.Terrain.slope(10))
        assert stance.settled, stance.reason
        assert stance.joints["swing_front"] == pytest.approx(angle, abs=1e-8)
        assert stance.joints["swing_back"] == pytest.approx(-angle, abs=1e-8)


def test_a_loop_that_cannot_close_is_told_by_name_and_residual(tmp_path):
    rover = rod_rover(tmp_path, "distance", length=1.5)
    with pytest.raises(MechanismError, match=r"loops\.rod: .*residual 0\.\d+ m"):
        rp.settle(rover, rp.Terrain.flat())
    with pytest.raises(MechanismError, match=r"loops\.rod: it cannot close"):
        rover.info()
