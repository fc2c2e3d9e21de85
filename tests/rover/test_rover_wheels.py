"""Wheels, feet, belly: where they sit, what carries them, what drives them."""

import numpy as np
import pinocchio as pin
import pytest


def steered(make, drive="continuous", **keywords):
    """base - rocker (y) - fork (z) - wheel (y)."""
    return [
        make.link("base"),
        make.link("rocker"),
        make.link("fork"),
        make.link("wheel"),
        make.link("rim"),
        make.joint("r", "base", "rocker", axis="0 1 0", xyz="0 0.5 0"),
        make.joint("s", "rocker", "fork", axis="0 0 1", xyz="0.4 0 0"),
        make.joint("d", "fork", "wheel", drive, xyz="0 0.1 -0.3", **keywords),
        make.joint("f", "wheel", "rim", "fixed", xyz="0 0.02 0"),
    ]


def test_the_carrier_is_above_the_wheels_own_joint(make):
    rover = make.load(*steered(make), sidecar="wheels: [{frame: wheel, radius: 0.2, width: 0.1}]")
    (wheel,) = rover.wheels
    assert (wheel.name, wheel.link, wheel.drive) == ("wheel", "wheel", "d")
    assert wheel.joint == rover.model.getJointId("s")
    np.testing.assert_allclose(wheel.center, [0, 0.1, -0.3])
    np.testing.assert_allclose(wheel.axis, [0, 1, 0])
    assert (wheel.tread, wheel.friction, wheel.free) == (0.05, 0.6, False)
    assert rover.actuated == ("d",)
    assert "nothing says what is driven: taken the wheels' own joints (d)" in rover.notes


def test_a_frame_beside_the_axle_still_turns_about_it(make):
    rover = make.load(
        *steered(make),
        sidecar="wheels: [{name: w, frame: rim, center: [0, 0.03, 0], radius: 0.2, width: 0.1}]",
    )
    (wheel,) = rover.wheels
    assert wheel.drive == "d"
    assert wheel.link == "rim"
    np.testing.assert_allclose(wheel.center, [0, 0.15, -0.3])


@pytest.mark.parametrize("extra", ["center: [0.01, 0, 0]", "axis: [0.1, 1, 0]"])
def test_a_wheel_that_its_joint_does_not_turn_about_its_own_axis(make, extra):
    rover = make.load(*steered(make), sidecar=f"wheels: [{{frame: wheel, {extra}, radius: 0.2, width: 0.1}}]")
    (wheel,) = rover.wheels
    assert wheel.drive is None
    assert wheel.joint == rover.model.getJointId("d")


def test_a_joint_names_its_frame_too(make):
    rover = make.load(*steered(make), sidecar="wheels: [{frame: d, radius: 0.2, width: 0.1}]")
    (wheel,) = rover.wheels
    assert (wheel.name, wheel.link, wheel.drive) == ("d", "wheel", "d")


def test_a_rigid_wheel(make):
    rover = make.load(
        make.link("base"),
        make.link("rim"),
        make.joint("f", "base", "rim", "fixed", xyz="1 2 3"),
        sidecar="wheels: [{frame: rim, axis: [0, 3, 0], radius: 0.2}]",
    )
    (wheel,) = rover.wheels
    assert (wheel.joint, wheel.drive, wheel.tread) == (1, None, 0.0)
    np.testing.assert_allclose(wheel.center, [1, 2, 3])
    np.testing.assert_allclose(wheel.axis, [0, 1, 0])
    assert "wheel rim: neither width nor tread is stated; taken as a thin disc" in rover.notes


def test_up_turns_what_sits_on_the_base(make):
    rover = make.load(
        make.link("base"),
        sidecar="{up: [0, 1, 0], wheels: [{frame: base, center: [1, 2, 3], axis: [1, 0, 0], radius: 1}]}"[
            1:-1
        ].replace(", wheels", "\nwheels"),
    )
    (wheel,) = rover.wheels
    np.testing.assert_allclose(wheel.center, [1, -3, 2], atol=1e-12)


def test_the_wheel_stays_when_its_drive_turns(make):
    rover = make.load(*steered(make), sidecar="wheels: [{frame: rim, radius: 0.2, width: 0.1}]")
    (wheel,) = rover.wheels
    data = rover.model.createData()
    rim = rover.model.getFrameId("rim")
    for angle in (0.0, 1.0, 2.5):
        pin.framesForwardKinematics(rover.model, data, rover.configuration({"d": angle, "r": 0.3, "s": -0.4}))
        np.testing.assert_allclose(
            data.oMi[wheel.joint].act(np.array(wheel.center)), data.oMf[rim].translation, atol=1e-14
        )
        np.testing.assert_allclose(
            data.oMi[wheel.joint].rotation @ wheel.axis, data.oMf[rim].rotation[:, 1], atol=1e-14
        )


def test_feet_and_belly(make):
    rover = make.load(
        *steered(make),
        sidecar=(
            "contacts: [{name: toe, frame: rim, radius: 0.02, friction: "
            "0.7}]\nbelly: [{frame: rocker, point: [0, 0, -0.2]}]"
        ),
    )
    (foot,) = rover.feet
    assert (foot.name, foot.link, foot.joint, foot.friction) == (
        "toe",
        "rim",
        rover.model.getJointId("d"),
        0.7,
    )
    np.testing.assert_allclose(foot.center, [0, 0.02, 0])
    (point,) = rover.belly
    assert (point.link, point.joint, tuple(point.point)) == ("rocker", 2, (0, 0, -0.2))
    assert rover.shapes == (foot,)


def test_wheel_span(make):
    rover = make.load(
        make.link("base"),
        sidecar="""
        wheels:
          - {name: a, frame: base, axis: [0, 1, 0], radius: 0.1, center: [0, 0, 0]}
          - {name: b, frame: base, axis: [0, 1, 0], radius: 0.1, center: [3, 4, 0]}
          - {name: c, frame: base, axis: [0, 1, 0], radius: 0.1, center: [1, 1, 0]}
        """,
    )
    assert rover.wheel_span == pytest.approx(5.0)
    lone = make.load(make.link("base"), sidecar="wheels: [{frame: base, axis: [0, 1, 0], radius: 0.1}]")
    assert lone.wheel_span == pytest.approx(0.2)
    assert make.load(make.link("base"), sidecar="").wheel_span == 1.0


def test_actuation_from_the_sidecar(make):
    assert make.load(*steered(make), sidecar="actuated: [d, s]").actuated == ("s", "d")
    rover = make.load(*steered(make), sidecar="passive: [r]")
    assert rover.actuated == ("s", "d")
    assert rover.passive == ("r",)


def test_actuation_from_the_urdf(make):
    control = (
        '<ros2_control name="x" type="system"><joint name="s"><command_interface name="position"/></joint>'
        '<joint name="r"><state_interface name="position"/></joint></ros2_control>'
    )
    old = "".join(f'<transmission name="t{n}"><joint name="{n}"/></transmission>' for n in "df")
    assert make.load(*steered(make), control, old).actuated == ("s",)
    rover = make.load(*steered(make), old)
    assert rover.actuated == ("d",)
    assert "<transmission> drives f, which does not move: dropped" in rover.notes


def test_nothing_says_what_is_driven(make):
    rover = make.load(*steered(make))
    assert rover.actuated == ()
    assert (
        "nothing says what is driven: every joint is taken as passive; declare `actuated` in the sidecar"
        in rover.notes
    )


def test_a_wheel_on_a_limited_joint_is_not_guessed_to_be_driven(make):
    rover = make.load(*steered(make, "revolute"), sidecar="wheels: [{frame: wheel, radius: 0.2, width: 0.1}]")
    assert rover.wheels[0].drive == "d"
    assert rover.actuated == ()
