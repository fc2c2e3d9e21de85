"""MJCF files, against MuJoCo's own reading of them."""

import pickle

import numpy as np
import pinocchio as pin
import pytest

import rover_pin as rp
from rover_pin.description.mjcf import is_mjcf
from rover_pin.mechanism import Kinematics

mujoco = pytest.importorskip("mujoco")

XML = """<?xml version="1.0"?>
<!-- all ways to say where something is -->
<mujoco model="m"><compiler angle="degree" eulerseq="xyZ"/>
<default><geom density="700"/><default class="w"><geom type="cylinder" size="0.1 0.03"/><joint axis="0 1 0"/></default></default>
<worldbody><geom type="plane" size="1 1 1"/><body name="rock"><geom size="0.3"/></body>
<body name="base" pos="0 0 0.5"><freejoint name="root"/><geom type="box" size="0.3 0.2 0.05" mass="10"/>
 <body name="arm" pos="0.2 0.1 0" euler="5 10 20">
  <joint name="swing" axis="0 1 0" pos="0.05 0 0" range="-30 40" ref="5" stiffness="7" springref="3"/>
  <joint name="push" type="slide" axis="1 0 0" pos="0 0.01 0" range="-.1 .1"/>
  <inertial pos="0.01 0 0" quat="1 1 0 0" mass="2" diaginertia="0.1 0.2 0.25"/>
  <body name="wheel" pos="0.2 0 -0.1" childclass="w"><joint name="drive"/><geom quat="1 1 0 0" density="500"/>
   <site name="s1" pos="0 0.1 0"/></body></body>
 <body name="b2" pos="0 -0.1 0" axisangle="0 0 1 30"><joint name="ball" type="ball"/><geom type="sphere" size="0.05"/>
  <body name="b3" pos="0 0 -.1" zaxis="0 1 1"><joint name="tilt" axis="1 0 0"/>
   <geom type="capsule" fromto="0 0 0 0.1 0 -0.3" size="0.02"/><geom type="ellipsoid" size="0.1 0.05 0.02" pos="0 0.1 0"/>
  </body></body>
 <body name="b4" pos="0 0.3 0" xyaxes="0 1 0 -1 0 1"><joint name="hinge2" axis="0 0 1" range="-10 10"/><geom size="0.04"/></body>
</body></worldbody>
<equality><connect name="c" body1="b3" body2="arm" anchor="0.1 0 -0.3"/>
<joint name="j" joint1="swing" joint2="hinge2" polycoef="0.01 2 0 0 0"/>
<weld name="w" body1="b4" body2="b3"/><connect name="off" body1="b3" body2="arm" anchor="0 0 0" active="false"/></equality>
<actuator><motor name="m" joint="drive" gear="3"/></actuator>
</mujoco>"""  # noqa: E501
ONE = "<mujoco><worldbody>{body}</worldbody>{more}</mujoco>"
BODY = (
    '<body name="a"><freejoint/><geom size="0.1"/><body name="b"><joint name="j"/><geom '
    'size="0.1"/></body></body>'
)


@pytest.fixture
def both(tmp_path):
    path = tmp_path / "m.xml"
    path.write_text(XML)
    return rp.load(path), mujoco.MjModel.from_xml_path(str(path))


def address(model, name):
    return model.jnt_qposadr[mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name)]


def posed(rover, model, rng):
    """The same random pose for both."""
    data = mujoco.MjData(model)
    data.qpos[:] = model.qpos0
    values = {
        name: rng.uniform(-0.3, 0.3) for name in ("swing", "drive", "tilt", "ball_X", "ball_Y", "ball_Z")
    }
    values |= {"push": rng.uniform(-0.1, 0.1), "hinge2": rng.uniform(-0.1, 0.1)}
    for name, value in values.items():
        if not name.startswith("ball"):
            at = address(model, name)
            data.qpos[at] = model.qpos0[at] + value
    turn = np.eye(3)
    for k, letter in enumerate("XYZ"):
        turn = turn @ pin.exp3(values[f"ball_{letter}"] * np.eye(3)[k])
    x, y, z, w = pin.Quaternion(turn).coeffs()
    at = address(model, "ball")
    data.qpos[at : at + 4] = w, x, y, z
    mujoco.mj_forward(model, data)
    return rover.configuration(values, position=(0, 0, 0.5)), data


def test_places_masses_and_inertias_are_mujocos(both):
    rover, model = both
    rng = np.random.default_rng(0)
    names = ("base", "arm", "wheel", "b2", "b3", "b4")
    ids = [mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name) for name in names]
    assert rover.mass == pytest.approx(sum(model.body_mass[i] for i in ids), rel=1e-12)
    plain = rover.model.createData()
    for _ in range(5):
        q, data = posed(rover, model, rng)
        pin.framesForwardKinematics(rover.model, plain, q)
        for name, i in zip(names, ids, strict=True):
            frame = plain.oMf[rover.model.getFrameId(name, pin.FrameType.BODY)]
            np.testing.assert_allclose(frame.translation, data.xpos[i], atol=1e-12)
            np.testing.assert_allclose(frame.rotation, data.xmat[i].reshape(3, 3), atol=1e-12)
        com = pin.centerOfMass(rover.model, plain, q)
        np.testing.assert_allclose(com, data.subtree_com[ids[0]], atol=1e-12)
        pin.computeCentroidalMap(rover.model, plain, q)
        whole = pin.crba(rover.model, rover.model.createData(), q)
        column = rover.column
        dense = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, dense)
        for name in ("drive", "hinge2", "tilt", "swing", "push"):
            dof = model.jnt_dofadr[mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name)]
            assert whole[column[name], column[name]] == pytest.approx(dense[dof, dof], rel=1e-9)


def test_limits_springs_and_actuators(both):
    rover, _ = both
    balls = {"ball_X", "ball_Y", "ball_Z"}
    assert set(rover.joints) == {"swing", "push", "drive", *balls, "tilt", "hinge2"}
    assert rover.actuated == ("drive",)
    low, high = (limits[rover.column["swing"]] for limits in (rover.lower, rover.upper))
    assert (low, high) == pytest.approx((np.radians(-35), np.radians(35)))
    assert np.isinf(rover.upper[rover.column["drive"]])
    (spring,) = rover.springs
    assert (spring.stiffness, spring.rest) == pytest.approx((7.0, np.radians(-2)))
    assert "joint swing: its values count from its ref, 0.0872665" in rover.notes
    assert "body rock of the world does not move: dropped" in rover.notes
    assert "equality off is not active: dropped" in rover.notes


def test_equalities_hold_where_mujocos_do(both):
    rover, model = both
    rng = np.random.default_rng(1)
    (coupling,) = rover.couplings
    loops = {loop.name: loop for loop in rover.loops}
    assert {name: loop.type for name, loop in loops.items()} == {"c": "ball", "w": "weld"}
    for _ in range(5):
        q, data = posed(rover, model, rng)
        at = Kinematics(rover.model, rover.model.createData(), q)
        gaps = {k: data.efc_pos[(data.efc_type == 0) & (data.efc_id == k)] for k in (0, 1, 2)}
        assert np.linalg.norm(loops["c"].residual(at)) == pytest.approx(np.linalg.norm(gaps[0]), rel=1e-9)
        assert np.linalg.norm(loops["w"].residual(at)[:3]) == pytest.approx(
            np.linalg.norm(gaps[2][:3]), rel=1e-9
        )
        joints = {name: q[rover.column[name]] for name in ("swing", "hinge2")}
        assert joints["swing"] - 2 * joints["hinge2"] - 0.01 == pytest.approx(gaps[1][0], abs=1e-12)
        assert abs(coupling.residual(at)[0]) == pytest.approx(abs(gaps[1][0]), abs=1e-12)


def test_a_sidecar_adds_to_what_the_file_says(tmp_path):
    path = tmp_path / "m.xml"
    path.write_text(XML)
    (tmp_path / "rover.yaml").write_text("schema: 1\nwheels: [{frame: wheel, radius: 0.1, width: 0.06}]\n")
    rover = rp.load(path)
    assert [wheel.drive for wheel in rover.wheels] == ["drive"]
    assert len(rover.loops) == 2
    path.unlink()
    again = pickle.loads(pickle.dumps(rover))  # made without the file
    assert [loop.name for loop in again.loops] == ["c", "w"]
    assert again.mass == rover.mass


def test_includes_and_fixed_tendons(tmp_path):
    (tmp_path / "parts.xml").write_text(f"<mujoco><worldbody>{BODY}</worldbody></mujoco>")
    path = tmp_path / "m.xml"
    path.write_text(
        '<mujoco><include file="parts.xml"/><tendon><fixed name="t"><joint joint="j" '
        'coef="3"/></fixed></tendon>'
        '<equality><tendon tendon1="t" polycoef="0.6 0 0 0 0"/></equality></mujoco>'
    )
    rover = rp.load(path)
    (coupling,) = rover.couplings
    at = Kinematics(rover.model, rover.model.createData(), rover.configuration({"j": 0.2}))
    assert coupling.residual(at) == pytest.approx([0.0], abs=1e-12)


@pytest.mark.parametrize(
    ("body", "more", "told"),
    [
        (
            BODY,
            '<equality><joint joint1="j" polycoef="0 1 2 0 0"/></equality>',
            "<joint>: not linear (got '0 1 2 0 0'); keep the first two of polycoef",
        ),
        (
            BODY,
            '<equality><joint joint1="jj"/></equality>',
            "<joint>: joint1 is no joint of the robot (got 'jj'); name a <joint>",
        ),
        (
            BODY,
            '<equality><connect name="c" body1="b" anchor="0 0 0"/></equality>',
            "<connect> c: body2 is no body "
            "of the robot (got 'the world'); a loop ties two bodies of the robot",
        ),
        (
            BODY.replace('size="0.1"', 'size="-1"', 1),
            "",
            "<geom>: a sphere needs 1 sizes above zero (got '[-1.0]'); give them in m",
        ),
        (
            BODY.replace('size="0.1"', 'size="x"', 1),
            "",
            "<geom>: size is not a list of finite numbers (got 'x'); give plain numbers",
        ),
        (
            BODY + BODY.replace('"a"', '"c"'),
            "",
            "<worldbody>: 2 bodies that move, or none of several in the world; "
            "a robot is one (got 'a, c'); leave one in the file",
        ),
        ("", "", "<worldbody>: no body in the world; a robot is one; leave one in the file"),
        (
            BODY.replace('name="j"', 'name="j" axis="0 0 0"'),
            "",
            "<joint> j: a zero axis; give the direction it moves about or along",
        ),
        (
            BODY.replace('name="j"', 'name="j" class="no"'),
            "",
            "<joint> j: no default class of that name (got 'no'); declare it under <default>",
        ),
        (
            BODY,
            '<include file="no.xml"/>',
            "<include>: no such file (got 'no.xml'); put it there, or remove the include",
        ),
        (
            BODY.replace('size="0.1"', 'type="mesh" mesh="k"', 1),
            '<asset><mesh name="k" file="k.stl"/></asset>',
            "<geom>: its mesh is missing, and its body's mass hangs on it; put the mesh there, or "
            "give the body an "
            "<inertial>",
        ),
    ],
)
def test_files_that_cannot_be_used(tmp_path, body, more, told):
    path = tmp_path / "m.xml"
    path.write_text(ONE.format(body=body, more=more))
    with pytest.raises(rp.errors.DescriptionError) as caught:
        rp.load(path)
    assert str(caught.value).replace(f"{path}: ", "") == told


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("<mujoco/>", True),
        ('\ufeff <?xml version="1.0"?>\n<!-- <robot> -->\n<!DOCTYPE x>\n<mujoco model="m">', True),
        ("<!-- <mujoco> --><robot/>", False),
        ("<mujoco_robot/>", False),
        ("<!-- never closed <mujoco>", False),
        ('<?xml version="1.0"?>' + "\n<!-- word -->" * 5000 + "<robot/>", False),  # and quickly
    ],
)
def test_what_is_an_mjcf(text, told):
    assert is_mjcf(text) is told
