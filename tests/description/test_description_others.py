"""Files of others beside a URDF: Gepetto's `robot.yaml`, SRDF, ROS packages of the environment."""

import pickle
from pathlib import Path

import numpy as np
import pytest

import rover_pin as rp
from rover_pin.description.packages import Packages

FOUR_BAR = Path(__file__).parents[1] / "fixtures" / "four_bar"
WHEELS = """
couplings: [{name: swing, joints: {upper_l: 1, upper_r: 1}}]
wheels:
  - {name: bl, frame: wheel_bl, radius: 0.15, width: 0.1, tread: 0.03, friction: 0.8}
  - {name: fl, frame: wheel_fl, radius: 0.15, width: 0.1, tread: 0.03, friction: 0.8}
  - {name: br, frame: wheel_br, radius: 0.15, width: 0.1, tread: 0.03, friction: 0.8}
  - {name: fr, frame: wheel_fr, radius: 0.15, width: 0.1, tread: 0.03, friction: 0.8}
"""
GEPETTO = """closed_loop: [['leg_l_A', 'leg_l_B'], ['leg_r_A', 'leg_r_B']]
type: ['3d', '3D']
name_mot: ['drive_bl', 'drive_fl', 'drive_br', 'drive_fr']
"""
FRAMES = "".join(
    f'<link name="leg_{s}_{e}"/><joint name="at_leg_{s}_{e}" type="fixed"><parent link="{link}_{s}"/>'
    f'<child link="leg_{s}_{e}"/><origin xyz="{xyz}"/></joint>'
    for s in "lr"
    for e, link, xyz in (("A", "knuckle_link", "0 0 -0.12"), ("B", "lower_link", "0.3 0 0"))
)
OURS = """schema: 1
loops:
  - {name: l, frames: [leg_l_A, leg_l_B], type: ball}
  - {name: r, frames: [leg_r_A, leg_r_B], type: ball}
actuated: [drive_bl, drive_fl, drive_br, drive_fr]
"""
SRDF = """<robot name="bot">
<group_state name="up" group="g"><joint name="j" value="0.5"/>
<joint name="base_joint" value="0 0 1 0 0 0 1"/></group_state>
<group_state name="up" group="h"><joint name="gone" value="0.1"/></group_state>
<passive_joint name="j"/></robot>"""


@pytest.fixture
def four_bar(tmp_path):
    """Its URDF with frames where its legs close, as Gepetto's files need them."""
    text = (FOUR_BAR / "four_bar.urdf").read_text()
    path = tmp_path / "four_bar.urdf"
    path.write_text(text.replace("</robot>", FRAMES + "</robot>"))
    return path


def stood(path, sidecar):
    rover = rp.load(path, sidecar=sidecar)
    return rp.settle(rover, rp.Terrain.rough(2, 0.05, 0.8, size=8.0), x=0.3, y=-0.2, yaw=0.7)


def refused(call, *args, **keywords):
    with pytest.raises(rp.errors.InputError) as caught:
        call(*args, **keywords)
    return str(caught.value)


def test_the_stance_of_a_robot_yaml_is_that_of_our_sidecar_bit_for_bit(four_bar, tmp_path):
    ours, named, mixed = (tmp_path / name for name in ("ours.yaml", "named.yaml", "mixed.yaml"))
    ours.write_text(OURS + WHEELS)
    (tmp_path / "robot.yaml").write_text(GEPETTO)
    named.write_text("schema: 1\nrobot_yaml: robot.yaml\n" + WHEELS)
    mixed.write_text("schema: 1\n" + GEPETTO + WHEELS)
    expected = stood(four_bar, ours)
    assert str(expected.status) == "settled"
    assert max(abs(v) for v in expected.joints.values()) > 1e-3  # the legs have moved
    for path in (named, mixed):
        stance = stood(four_bar, path)
        assert np.array_equal(stance.configuration, expected.configuration)
        assert stance.loads == expected.loads
    again = pickle.loads(pickle.dumps(rp.load(four_bar, sidecar=named)))  # made without robot.yaml
    assert [loop.type for loop in again.loops] == ["ball", "ball"]


def test_a_robot_yaml_alone_beside_the_urdf_is_its_sidecar(four_bar, tmp_path):
    (tmp_path / "robot.yaml").write_text(GEPETTO)
    rover = rp.load(four_bar)
    assert rover.sidecar_path.name == "robot.yaml"
    assert len(rover.loops) == 2
    assert set(rover.actuated) == {"drive_bl", "drive_fl", "drive_br", "drive_fr"}
    (tmp_path / "robot.yaml").write_text("camera: 1\n")  # somebody else's
    assert rp.load(four_bar).sidecar_path is None


def test_joints_of_another_type(make, tmp_path):
    path = make.write(
        *make.pair(xyz="0.1 0 0.2"), make.link("tip"), make.joint("k", "arm", "tip", xyz="0 0 1")
    )
    (tmp_path / "robot.yaml").write_text(
        "closed_loop: []\nname_mot: [k]\njoint_name: [j, k]\njoint_type: [SPHERICAL, CARDAN]\n".replace(
            "[k]", "[]"
        )
    )
    rover = rp.load(path)
    assert rover.joints == ("j_X", "j_Y", "j_Z", "k_X", "k_Y")
    q = rover.configuration({"j_X": 0.3, "j_Y": -0.4, "j_Z": 0.5, "k_Y": 0.2})
    data = rover.model.createData()
    import pinocchio as pin

    pin.framesForwardKinematics(rover.model, data, q)

    def turn(axis, angle):
        return pin.exp3(angle * np.eye(3)[axis])

    arm = turn(0, 0.3) @ turn(1, -0.4) @ turn(2, 0.5)
    tip = data.oMf[rover.model.getFrameId("tip")]
    np.testing.assert_allclose(tip.rotation, arm @ turn(1, 0.2), atol=1e-12)
    np.testing.assert_allclose(tip.translation, [0.1, 0, 0.2] + arm @ [0, 0, 1], atol=1e-12)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (
            "closed_loop: [[a]]\n",
            "robot.yaml: closed_loop[0]: is not a pair of frames (got \"['a']\"); write [frame_a, frame_b]",
        ),
        ("closed_loop: 3\n", "robot.yaml: closed_loop: not a list (got '3'); write [a, b, ...]"),
        (
            "closed_loop: []\njoint_name: [j]\n",
            "robot.yaml: joint_type: has 0 types for 1 joints; give one for each of joint_name",
        ),
        (
            "closed_loop: []\njoint_name: [j]\njoint_type: [SPHERICL]\n",
            "robot.yaml: joint_type[0]: is no type of a joint (got 'SPHERICL'); did you mean 'SPHERICAL'?",
        ),
        (
            "closed_loop: []\njoint_name: [jj]\njoint_type: [FIXED]\n",
            "robot.yaml: retype.jj: no such joint; did you mean 'j'?",
        ),
        (
            "closed_loop: []\nschema: 1\nname_mot: [j]\npassive: []\n",
            "robot.yaml: name_mot: says with `passive` what is driven twice; keep one",
        ),
        (
            "closed_loop: [[arm, nope]]\n",
            "robot.yaml: loops.loop_1: no link or joint of this name (got 'nope'); known: arm, base, j",
        ),
    ],
)
def test_robot_yamls_that_cannot_be_used(make, tmp_path, text, told):
    path = make.write(*make.pair())
    (tmp_path / "robot.yaml").write_text(text)
    assert refused(rp.load, path).replace(f"{tmp_path}/", "") == told


def test_postures_and_passive_joints_of_an_srdf(make, tmp_path):
    (tmp_path / "bot.srdf").write_text(SRDF)
    rover = make.load(*make.pair(), sidecar="srdf: bot.srdf\npostures: {down: {j: -0.5}}")
    assert {name: dict(values) for name, values in rover.postures.items()} == {
        "up": {"j": 0.5},
        "down": {"j": -0.5},
    }
    assert rover.passive == ("j",)
    assert "joint base_joint of the SRDF has several values: dropped from its postures" in rover.notes
    assert "joint gone of the SRDF does not move here: dropped from its postures" in rover.notes
    again = pickle.loads(pickle.dumps(rover))
    assert again.postures["up"]["j"] == 0.5
    alone = rp.load(tmp_path / "bot.urdf", sidecar=tmp_path / "bot.srdf")
    assert alone.postures["up"]["j"] == 0.5
    own = make.load(*make.pair(), sidecar="srdf: bot.srdf\npostures: {up: {j: 0.25}}\nactuated: [j]")
    assert own.postures["up"]["j"] == 0.25  # the sidecar's own word goes first
    assert own.actuated == ("j",)


def test_an_srdf_takes_joints_from_what_the_urdf_drives(make, tmp_path):
    parts = [*make.pair(), make.link("tip"), make.joint("k", "arm", "tip")]
    drives = "".join(f'<transmission name="t{n}"><joint name="{n}"/></transmission>' for n in "jk")
    (tmp_path / "bot.srdf").write_text(SRDF)
    assert make.load(*parts, drives, sidecar="srdf: bot.srdf").actuated == ("k",)
    assert make.load(*parts, sidecar="srdf: bot.srdf").actuated == ("k",)
    assert make.load(*parts, drives, sidecar="").actuated == ("j", "k")


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        (
            'value="0.5"',
            'value="half"',
            "bot.srdf: group_state up, joint j: its value is not a finite number (got 'half'); give rad or m",
        ),
        (
            'value="0.5"',
            'value="nan"',
            "bot.srdf: group_state up, joint j: its value is not a finite number (got 'nan'); give rad or m",
        ),
        (
            'name="gone" value="0.1"',
            'name="j" value="0.1"',
            "bot.srdf: group_state up, joint j: two values in one "
            "posture, 0.5 and 0.1; rename one of the states",
        ),
        (
            '<group_state name="up" group="g">',
            '<group_state group="g">',
            "bot.srdf: a group_state: no name; name it",
        ),
        ("</robot>", "", "bot.srdf: not XML: "),
        ("<passive_joint", '<link name="l"/><passive_joint', "bot.srdf: not an SRDF: it is a URDF; "),
        (
            'value="0.5"',
            'value="1.5"',
            "rover.yaml: postures.up.j: posture outside limits: Joint j: "
            "-1 <= 1.5 <= 1; stay within the limits",
        ),
    ],
)
def test_srdfs_that_cannot_be_used(make, tmp_path, old, new, told):
    (tmp_path / "bot.srdf").write_text(SRDF.replace(old, new, 1))
    assert make.refused(*make.pair(), sidecar="srdf: bot.srdf").startswith(told)


def test_an_srdf_that_is_not_there(make):
    assert make.refused(*make.pair(), sidecar="srdf: no.srdf") == (
        "rover.yaml: srdf: no such file (got 'no.srdf'); give a path from the sidecar's folder"
    )
    said = make.refused(*make.pair(), sidecar="srdf: package://no_such_pkg/a.srdf")
    assert said.startswith(
        "rover.yaml: srdf: no such file (got 'package://no_such_pkg/a.srdf'); tried the map (empty), "
    )


def package(folder, name):
    folder.mkdir(parents=True)
    (folder / "package.xml").write_text(f"<package><name>{name}</name></package>")
    (folder / "m.stl").write_text("")
    return folder


def test_packages_of_the_environment(tmp_path, monkeypatch):
    near = tmp_path / "here" / "urdf" / "a.urdf"
    near.parent.mkdir(parents=True)
    source = package(tmp_path / "ws" / "src" / "stack" / "odd_folder", "one_pkg")
    shared = package(tmp_path / "prefix" / "share" / "two_pkg", "two_pkg")
    monkeypatch.setenv("ROS_PACKAGE_PATH", f"/nowhere:{tmp_path / 'ws'}")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "prefix"))
    packages = Packages(near)
    assert packages.find("one_pkg") == source
    assert packages.resolve("package://two_pkg/m.stl") == shared / "m.stl"
    given = package(tmp_path / "given", "whatever")
    assert Packages(near, {"one_pkg": given}).find("one_pkg") == given
    assert packages.find("three_pkg") is None
    assert packages.advice("package://three_pkg/m.stl") == (
        f"tried the map (empty), ROS_PACKAGE_PATH (/nowhere:{tmp_path}/ws), AMENT_PREFIX_PATH "
        f"({tmp_path}/prefix), "
        f"three_pkg among and beside the folders above {near}, an installed ROS; "
        "give its folder: --package three_pkg=DIR"
    )
    assert packages.advice("package://one_pkg/n.stl") == (
        f"tried n.stl in {source}; give the folder that has it: --package one_pkg=DIR"
    )


def test_the_notes_say_where_a_package_was_looked_for(make):
    mesh = '<visual><geometry><mesh filename="package://no_such_pkg/a.stl"/></geometry></visual>'
    rover = make.load(make.link("base", extra=mesh))
    assert "mesh package://no_such_pkg/a.stl is missing: not drawn" in rover.notes
    assert any(note.startswith("package no_such_pkg: tried the map (empty), ") for note in rover.notes)


def test_packages_listed_when_an_include_is_missing(tmp_path):
    path = tmp_path / "a.urdf.xacro"
    path.write_text(
        '<robot name="x" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        '<xacro:include filename="$(find no_such_pkg)/p.xacro"/><link name="base"/></robot>'
    )
    said = refused(rp.load, path)
    assert "tried the map (empty), ROS_PACKAGE_PATH (" in said
    assert "no_such_pkg among and beside the folders above" in said
