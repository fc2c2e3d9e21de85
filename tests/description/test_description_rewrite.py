"""Limits, locks, floating roots, freed joints, masses and the up axis."""

import numpy as np
import pinocchio as pin
import pytest


def test_continuous_is_unbounded_and_says_what_it_ignored(make):
    body = [make.link("a"), make.link("b")]
    rover = make.load(
        *body, make.joint("j", "a", "b", "continuous", extra='<limit lower="-1" upper="1" effort="3"/>')
    )
    assert rover.model.nq == rover.model.nv == 7
    assert rover.lower[6] == -np.inf
    assert rover.upper[6] == np.inf
    assert rover.effort[6] == 3.0
    assert "joint j: limits of a continuous joint ignored" in rover.notes


def test_limits_of_a_revolute(make):
    rover = make.load(*make.pair(limits="-0.5 0.7"))
    column = rover.column["j"]
    assert (rover.lower[column], rover.upper[column]) == (-0.5, 0.7)
    assert (rover.effort[column], rover.velocity[column]) == (10.0, 2.0)
    assert rover.model.upperPositionLimit[column] == 0.7
    assert not rover.lower.flags.writeable


def test_one_limit_stated_means_zero_for_the_other(make):
    body = [make.link("a"), make.link("b"), make.joint("j", "a", "b", limits="", extra='<limit upper="2"/>')]
    rover = make.load(*body)
    assert (rover.lower[6], rover.upper[6]) == (0.0, 2.0)


def test_missing_limits_are_noted(make):
    rover = make.load(*make.pair(limits=""))
    assert rover.upper[6] == np.inf
    assert "joint j: no limits stated, taken as unbounded" in rover.notes


def test_huge_limits_are_none(make):
    rover = make.load(*make.pair(limits="-1e300 1e300"))
    assert (rover.lower[6], rover.upper[6]) == (-np.inf, np.inf)
    assert "joint j: its limits are so wide that they count as none" in rover.notes


def test_zero_effort_is_a_placeholder(make):
    body = [
        make.link("a"),
        make.link("b"),
        make.joint("j", "a", "b", "continuous", extra='<limit effort="0"/>'),
    ]
    driven, free = (make.load(*body, sidecar=f"{key}: [j]") for key in ("actuated", "passive"))
    told = "joint j: driven with effort 0, taken as a motor without a stated limit"
    assert driven.effort[6] == free.effort[6] == np.inf
    assert told in driven.notes
    assert told not in free.notes


@pytest.mark.parametrize("kind", ["revolute", "prismatic"])
def test_close_limits_lock_where_they_are(make, kind):
    free = make.load(
        *make.pair(kind, xyz="0.1 0.2 0.3", axis="0 1 0"),
        make.link("tip"),
        make.joint("f", "arm", "tip", "fixed", xyz="1 0 0"),
    )
    q = free.configuration({"j": 0.4})
    data = free.model.createData()
    pin.framesForwardKinematics(free.model, data, q)
    expected = data.oMf[free.model.getFrameId("tip")]
    held = make.load(
        *make.pair(kind, xyz="0.1 0.2 0.3", axis="0 1 0", limits="0.4 0.4000001"),
        make.link("tip"),
        make.joint("f", "arm", "tip", "fixed", xyz="1 0 0"),
    )
    assert held.joints == ()
    assert "joint j: limits 0.4, 0.4 lock it there; taken as fixed" in held.notes
    data = held.model.createData()
    pin.framesForwardKinematics(held.model, data, np.zeros(6))
    found = data.oMf[held.model.getFrameId("tip")]
    np.testing.assert_allclose(found.homogeneous, expected.homogeneous, atol=1e-7)


def test_axis_is_made_unit(make):
    rover = make.load(*make.pair(axis="0 0 5"))
    data = rover.model.createData()
    pin.forwardKinematics(rover.model, data, rover.configuration({"j": 0.3}))
    np.testing.assert_allclose(data.oMi[2].rotation, pin.exp3(np.array([0, 0, 0.3])), atol=1e-14)


def test_missing_axis_is_x_and_noted(make):
    body = [
        make.link("a"),
        make.link("b"),
        '<joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint>',
    ]
    assert "joint j: no axis stated, x taken as URDF says" in make.load(*body).notes


def test_floating_root_is_the_base(make):
    rover = make.load(
        make.link("world", mass=None),
        make.link("body", mass=3),
        make.link("arm"),
        make.joint("free", "world", "body", "floating", xyz="9 9 9"),
        make.joint("j", "body", "arm"),
    )
    assert rover.root == "body"
    assert rover.mass == pytest.approx(4.0)
    assert rover.joints == ("j",)
    assert "joint free: a floating root of its own taken as the base; link world dropped" in rover.notes


def test_floating_inside_is_refused(make):
    said = make.refused(
        make.link("a"),
        make.link("b"),
        make.link("c"),
        make.joint("x", "a", "b"),
        make.joint("y", "b", "c", "floating"),
    )
    assert said == (
        "bot.urdf: joint y: a floating joint inside the robot; only the base "
        "floats; fix it, or give it an axis"
    )


def test_second_floating_is_refused(make):
    said = make.refused(
        make.link("a", mass=None),
        make.link("b"),
        make.link("c"),
        make.joint("x", "a", "b", "floating"),
        make.joint("y", "b", "c", "floating"),
    )
    assert said.startswith("bot.urdf: joint y: a floating joint inside the robot")


def test_floating_beside_another_joint_is_refused(make):
    said = make.refused(
        make.link("a"),
        make.link("b"),
        make.link("c"),
        make.joint("x", "a", "b", "floating"),
        make.joint("y", "a", "c"),
    )
    assert said == (
        "bot.urdf: joint x: a floating joint, but link a above it carries "
        "other joints; hang nothing else on that link"
    )


def test_free_lets_a_fixed_joint_move(make):
    rover = make.load(
        *make.pair("fixed"), sidecar="free: {j: {type: revolute, axis: [0, 2, 0], limits: [-0.5, 0.5]}}"
    )
    assert rover.joints == ("j",)
    assert (rover.lower[6], rover.upper[6]) == (-0.5, 0.5)


def test_free_of_an_unknown_joint(make):
    assert make.refused(*make.pair("fixed"), sidecar="free: {jj: {type: revolute}}") == (
        "rover.yaml: free.jj: no such joint; did you mean 'j'?"
    )


def test_free_of_a_moving_joint(make):
    assert make.refused(*make.pair(), sidecar="free: {j: {type: revolute}}") == (
        "rover.yaml: free.j: the URDF does not fix this joint (got 'revolute'); remove it from `free`"
    )


def test_inertials_override(make):
    rover = make.load(
        make.link("base", mass=None),
        sidecar="inertials: {base: {mass: 12, com: [1, 2, 3], inertia: [1, 2, 3, 0, 0, 0]}}",
    )
    assert rover.mass == pytest.approx(12)
    np.testing.assert_allclose(rover.model.inertias[1].lever, [1, 2, 3])
    np.testing.assert_allclose(np.diag(rover.model.inertias[1].inertia), [1, 2, 3])


def test_inertials_of_an_unknown_link(make):
    assert make.refused(make.link("base"), sidecar="inertials: {bas: {mass: 1}}") == (
        "rover.yaml: inertials.bas: no such link; did you mean 'base'?"
    )


def test_mass_without_moments_is_kept(make):
    rover = make.load('<link name="a"><inertial><mass value="7"/></inertial></link>')
    assert rover.mass == pytest.approx(7)


def test_missing_and_zero_masses_are_noted(make):
    rover = make.load(
        make.link("a"),
        make.link("b", mass=None),
        make.link("c", mass=0),
        make.link("tool", mass=None),
        make.joint("x", "a", "b"),
        make.joint("y", "b", "c"),
        make.joint("z", "c", "tool", "fixed"),
    )
    assert "link b has no inertial: no mass" in rover.notes
    assert "link c has zero mass" in rover.notes
    assert not any("tool" in note for note in rover.notes)


def test_impossible_inertia_is_noted(make):
    body = '<link name="a"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="9"/></inertial></link>'
    assert "link a has an inertia that no body can have (statics do not use it)" in make.load(body).notes


@pytest.mark.parametrize("up", [[0, 1, 0], [0, 0, -1], [1, 1, 1], [1, 0, 0]])
def test_up_is_taken_to_z_by_the_shortest_rotation(make, up):
    rover = make.load(*make.pair(), sidecar=f"up: {up}")
    data = rover.model.createData()
    pin.framesForwardKinematics(rover.model, data, np.zeros(7))
    rotation = data.oMf[rover.model.getFrameId("base")].rotation
    unit = np.array(up) / np.linalg.norm(up)
    np.testing.assert_allclose(rotation @ unit, [0, 0, 1], atol=1e-12)
    angle = np.arccos(np.clip((np.trace(rotation) - 1) / 2, -1, 1))
    assert angle == pytest.approx(np.arccos(np.clip(unit[2], -1, 1)), abs=1e-7)
    assert rover.root == "base"


def test_gazebo_loops_and_damping_are_noted(make):
    rover = make.load(
        *make.pair(extra='<dynamics damping="0.1"/>'),
        '<gazebo><joint name="close" '
        'type="revolute"><parent>arm</parent><child>base</child></joint></gazebo>',
    )
    assert (
        "loop close (arm to base) stands only in a <gazebo> tag: dropped; declare it under `loops`"
        in rover.notes
    )
    assert "joint j: damping and friction are not used" in rover.notes


def test_undeclared_wheels_are_noted(make):
    rover = make.load(make.link("a"), make.link("wheel_l"), make.joint("j", "a", "wheel_l", "continuous"))
    assert "no wheels nor contacts are declared: nothing touches the ground" in rover.notes
    assert (
        "link wheel_l looks like a wheel and is not declared; list it under `wheels` in the sidecar"
        in rover.notes
    )
    assert "no sidecar: suspension, wheels and actuation are only what the URDF says" in rover.notes
