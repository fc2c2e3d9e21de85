"""Mass, centre of mass, base pose and Jacobians, by hand and by finite differences."""

import pickle
from types import SimpleNamespace

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import rover_pin as rp
from rover_pin.description.recipe import Recipe
from rover_pin.loader import assemble


def placed(rover, q, frame):
    data = rover.model.createData()
    pin.framesForwardKinematics(rover.model, data, q)
    return data.oMf[rover.model.getFrameId(frame)].copy()


def stance_at(q):
    return SimpleNamespace(configuration=q)


def body(make):
    return [
        make.link("base", mass=3, com="0 0 0.1"),
        make.link("arm", mass=1, com="1 0 0"),
        make.link("tip", mass=0.5),
        make.link("slider", mass=2),
        make.joint("turn", "base", "arm", axis="0 1 0", xyz="0.2 0.3 0"),
        make.joint("f", "arm", "tip", "fixed", xyz="1 0 0.5"),
        make.joint("slide", "arm", "slider", "prismatic", axis="1 0 1", xyz="0 0 1"),
    ]


def test_names_and_columns(make):
    rover = make.load(*body(make))
    assert rover.joints == ("turn", "slide")
    assert rover.dof_names == (
        "base_x",
        "base_y",
        "base_z",
        "base_yaw",
        "base_pitch",
        "base_roll",
        "turn",
        "slide",
    )
    assert rover.column["turn"] == 6
    assert rover.model.nq == rover.model.nv == 8
    assert rover.name == rover.model.name == "bot"
    assert rover.source.name == "bot.urdf"
    assert rover.sidecar_path is None


def test_mass_and_com_by_hand(make):
    rover = make.load(*body(make))
    assert rover.mass == pytest.approx(6.5, rel=1e-15)
    turn, slide = 0.3, 0.4
    q = rover.configuration({"turn": turn, "slide": slide})
    c, s = np.cos(turn), np.sin(turn)
    rotation = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    pivot = np.array([0.2, 0.3, 0.0])
    sliding = np.array([0, 0, 1]) + slide * np.array([1, 0, 1]) / np.sqrt(2)
    moments = 3 * np.array([0, 0, 0.1])
    moments = moments + 1 * (pivot + rotation @ [1, 0, 0])
    moments = moments + 0.5 * (pivot + rotation @ [1, 0, 0.5])
    moments = moments + 2 * (pivot + rotation @ sliding)
    com = pin.centerOfMass(rover.model, rover.model.createData(), q)
    np.testing.assert_allclose(com, moments / 6.5, atol=1e-14)


def test_root_mass_is_kept(make):
    assert make.load(make.link("only", mass=4.25)).mass == 4.25


def test_base_pose_is_the_root_links(make):
    rover = make.load(*body(make))
    roll, pitch, yaw = 0.1, -0.2, 0.3
    pose = placed(rover, rover.configuration(position=(1, 2, 3), rpy=(roll, pitch, yaw)), "base")
    expected = (
        pin.exp3(np.array([0, 0, yaw])) @ pin.exp3(np.array([0, pitch, 0])) @ pin.exp3(np.array([roll, 0, 0]))
    )
    np.testing.assert_allclose(pose.rotation, expected, atol=1e-14)
    np.testing.assert_allclose(pose.translation, [1, 2, 3])


def test_gravity_points_down(make):
    np.testing.assert_array_equal(make.load(*body(make)).model.gravity.linear, [0, 0, -9.81])


@pytest.mark.parametrize("frame", ["base", "arm", "tip", "slider", "turn", "f"])
def test_jacobian_against_finite_differences(make, frame):
    rover = make.load(*body(make))
    q = np.random.default_rng(1).uniform(-0.6, 0.6, rover.model.nv)
    jacobian = rover.jacobian(stance_at(q), frame)
    assert jacobian.shape == (6, 8)
    assert not jacobian.flags.writeable
    step = 1e-6
    here = placed(rover, q, frame)
    for i in range(rover.model.nv):
        e = np.zeros(rover.model.nv)
        e[i] = step
        ahead, behind = placed(rover, q + e, frame), placed(rover, q - e, frame)
        linear = (ahead.translation - behind.translation) / (2 * step)
        spin = (ahead.rotation - behind.rotation) @ here.rotation.T / (2 * step)
        angular = np.array([spin[2, 1], spin[0, 2], spin[1, 0]])
        np.testing.assert_allclose(jacobian[:3, i], linear, atol=1e-9)
        np.testing.assert_allclose(jacobian[3:, i], angular, atol=1e-9)


def test_jacobian_of_an_unknown_frame(make):
    rover = make.load(*body(make))
    with pytest.raises(rp.errors.InputError) as caught:
        rover.jacobian(stance_at(np.zeros(8)), "arn")
    assert (
        str(caught.value) == "frame: no link or joint of this name (got 'arn'); did you mean 'arm' or 'turn'?"
    )


def test_payload_sits_on_the_root_link(make):
    rover = make.load(*body(make), sidecar="up: [1, 0, 0]")
    loaded = rover.with_payload([(5, (0.1, 0.2, 0.3)), (1.5, (0, 0, 0))])
    assert loaded.mass == pytest.approx(13.0)
    assert rover.mass == pytest.approx(6.5)
    q = loaded.configuration()
    base = placed(loaded, q, "base")
    before = pin.centerOfMass(rover.model, rover.model.createData(), q) * 6.5
    com = pin.centerOfMass(loaded.model, loaded.model.createData(), q)
    np.testing.assert_allclose(com, (before + 5 * base.act(np.array([0.1, 0.2, 0.3]))) / 13, atol=1e-14)
    assert loaded.with_payload([(1, (0, 0, 0))]).mass == pytest.approx(14.0)


@pytest.mark.parametrize("bad", [(-1, (0, 0, 0)), (np.nan, (0, 0, 0)), (1, (0, np.inf, 0))])
def test_payload_that_is_none(make, bad):
    with pytest.raises(
        rp.errors.InputError, match=r"payload: not a mass at a place .*; give kg >= 0 and x, y, z in m"
    ):
        make.load(*body(make)).with_payload([bad])


def test_pickle_makes_it_again_without_its_files(make):
    rover = make.load(*body(make), sidecar="wheels: [{frame: tip, radius: 0.1, axis: [0, 1, 0]}]")
    loaded = rover.with_payload([(5, (0.1, 0.2, 0.3))])
    text = pickle.dumps(loaded)
    rover.source.unlink()
    rover.sidecar_path.unlink()
    again = pickle.loads(text)
    assert again.model.inertias[1].isApprox(loaded.model.inertias[1])
    assert again.mass == loaded.mass
    assert again.urdf == loaded.urdf
    assert again.recipe == loaded.recipe
    assert [w.name for w in again.wheels] == ["tip"]


def test_repr_and_description(make):
    rover = make.load(*body(make), sidecar="springs: [{name: s, joint: turn, stiffness: 3}]")
    assert repr(rover) == "Rover(bot: 6.5 kg, 2 joints, 0 driven, 0 wheels, 0 feet)"
    told = rover.describe()
    assert "springs: s" in told
    assert "mobility 2, rank 0, redundancy 0" in told
    assert "note: no wheels nor contacts" in told


def test_reading_twice_gives_the_same(make):
    path = make.write(*body(make))
    assert rp.load(path).urdf == rp.load(path).urdf


@st.composite
def trees(draw):
    """A random tree as URDF text, its mass and its number of moving joints."""
    size = draw(st.integers(1, 8))
    masses = [draw(st.floats(0.1, 10)) for _ in range(size)]
    parts = [
        f'<link name="l{i}"><inertial><mass value="{m!r}"/><inertia ixx="1" '
        f'iyy="1" izz="1"/></inertial></link>'
        for i, m in enumerate(masses)
    ]
    moving = 0
    for i in range(1, size):
        kind = draw(st.sampled_from(["revolute", "continuous", "prismatic", "fixed"]))
        axis = draw(st.tuples(*[st.integers(-2, 2)] * 3).filter(any))
        xyz = draw(st.tuples(*[st.floats(-1, 1)] * 3))
        moving += kind != "fixed"
        above = draw(st.integers(0, i - 1))
        parts.append(
            f'<joint name="j{i}" type="{kind}"><parent link="l{above}"/><child link="l{i}"/>'
            f'<origin xyz="{xyz[0]!r} {xyz[1]!r} {xyz[2]!r}"/>'
            f'<axis xyz="{axis[0]} {axis[1]} {axis[2]}"/></joint>'
        )
    order = draw(st.permutations(parts))
    return f'<robot name="t">{"".join(order)}</robot>', sum(masses), moving


@settings(max_examples=40, deadline=None, derandomize=True)
@given(tree=trees(), seed=st.integers(0, 1000))
def test_any_tree_is_a_plain_vector(tree, seed):
    """nq == nv, no mass is lost, and integrating v by q + v t is what Pinocchio does."""
    text, mass, moving = tree
    rover = assemble(Recipe(None, rp.robots()[0].path, text))
    assert rover.model.nq == rover.model.nv == 6 + moving
    assert rover.mass == pytest.approx(mass)
    assert len(rover.joints) == moving
    q, v = np.random.default_rng(seed).uniform(-1, 1, (2, rover.model.nv))
    np.testing.assert_allclose(pin.integrate(rover.model, q, v), q + v, atol=1e-12)


def test_a_link_and_a_joint_may_share_a_name(make):
    rover = make.load(
        make.link("base"),
        make.link("x"),
        make.link("rover_base"),
        make.link("y"),
        make.joint("x", "base", "x", xyz="1 0 0"),
        make.joint("root_joint", "x", "y", "fixed", xyz="0 1 0"),
        make.joint("rover_base", "x", "rover_base"),
        sidecar="up: [1, 0, 0]",
    )
    assert set(rover.joints) == {"x", "rover_base"}
    assert rover.jacobian(stance_at(rover.configuration()), "root_joint").shape == (6, 8)


def test_loading_says_nothing(make, capfd):
    make.load(*body(make), make.link("odd", mass=None), make.joint("o", "base", "odd", limits="0 0"))
    assert capfd.readouterr() == ("", "")


def test_public_mappings_are_read_only(make):
    rover = make.load(*body(make), sidecar="postures: {home: {turn: 0.1}}")
    for mapping in (rover.postures, rover.home, rover.column, rover.parameters):
        with pytest.raises(TypeError):
            mapping["turn"] = 1
