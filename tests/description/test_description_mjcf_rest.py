"""An MJCF with loops beside MuJoCo itself at rest: two four-bar legs, a differential, one foot on a block."""

import numpy as np
import pytest

import rover_pin as rp

mujoco = pytest.importorskip("mujoco")

BLOCK = 0.06
HARD = 'solref="0.004 1" solimp="0.9999 0.9999 0.0001 0.5 2"'
WORLD = f"""<mujoco model="rover"><option timestep="0.001"/>
<default><geom friction="0.05 0 0" {HARD}/><equality {HARD}/></default>
<worldbody><geom type="plane" size="5 5 1"/>{{block}}
<body name="base" pos="0 0 0.5"><freejoint/>
 <geom type="box" size="0.25 0.15 0.05" mass="10" pos="0.04 0.02 0" contype="0" conaffinity="0"/>{{sides}}</body></worldbody>
<equality><joint name="swing" joint1="upper_l" joint2="upper_r" polycoef="0 -1 0 0 0"/>
<connect name="close_l" body1="lower_l" body2="knuckle_l" anchor="0.2 0 0"/>
<connect name="close_r" body1="lower_r" body2="knuckle_r" anchor="0.2 0 0"/></equality></mujoco>"""  # noqa: E501
SIDE = """<body name="upper_{s}" pos="0 {y} 0"><joint name="upper_{s}" axis="0 1 0" range="-60 60"/>
 <geom type="box" size="0.1 0.02 0.02" pos="0.1 0 0" mass="1" contype="0" conaffinity="0"/>
 <body name="knuckle_{s}" pos="0.2 0 0"><joint name="knuckle_{s}" axis="0 1 0"/>
  <geom type="box" size="0.02 0.02 0.08" pos="0 0 -0.08" mass="0.8" contype="0" conaffinity="0"/>
  <geom name="front_{s}" type="sphere" size="0.05" pos="0.1 0 -0.25" mass="0.5"/></body></body>
<body name="lower_{s}" pos="0 {y} -0.1"><joint name="lower_{s}" axis="0 1 0"/>
 <geom type="box" size="0.1 0.02 0.02" pos="0.1 0 0" mass="0.7" contype="0" conaffinity="0"/>
 <geom name="back_{s}" type="sphere" size="0.05" pos="-0.3 0 -0.15" mass="0.5"/></body>"""
FEET = "".join(
    f"  - {{name: {end}_{s}, frame: {link}_{s}, center: [{x}, 0, {z}], radius: 0.05, friction: 0.6}}\n"
    for s in "lr"
    for end, link, x, z in (("front", "knuckle", 0.1, -0.25), ("back", "lower", -0.3, -0.15))
)
SIDES = "".join(SIDE.format(s=s, y=y) for s, y in (("l", 0.2), ("r", -0.2)))


def mujoco_at_rest(text):
    """Loads by geom [N], joint positions [rad], roll and pitch of the base [rad]; slowed down."""
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    for _ in range(6000):
        mujoco.mj_step(model, data)
        data.qvel[:] *= 0.98
    assert np.abs(data.qvel).max() < 1e-6
    loads, force = {}, np.zeros(6)
    for k in range(data.ncon):
        mujoco.mj_contactForce(model, data, k, force)
        contact = data.contact[k]
        name = next(n for n in (model.geom(contact.geom1).name, model.geom(contact.geom2).name) if n)
        loads[name] = loads.get(name, 0.0) + abs(float(contact.frame.reshape(3, 3)[:, 2] @ force[:3]))
    joints = {name: data.joint(name).qpos[0] for name in ("upper_l", "knuckle_l", "lower_l", "upper_r")}
    w, x, y, z = data.qpos[3:7]
    roll = np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    return loads, joints, roll, np.arcsin(2 * (w * y - x * z))


@pytest.mark.parametrize("block", [0.0, BLOCK])
def test_loads_and_pose_are_those_of_mujoco_at_rest(tmp_path, block):
    solid = f'<geom type="box" size="0.45 0.45 {BLOCK / 2}" pos="0.55 0.55 {BLOCK / 2}"/>' if block else ""
    text = WORLD.format(block=solid, sides=SIDES)
    path = tmp_path / "rover.xml"
    path.write_text(text)
    (tmp_path / "rover.yaml").write_text("schema: 1\ncontacts:\n" + FEET)
    rover = rp.load(path)
    assert len(rover.loops) == 2
    assert len(rover.couplings) == 1
    nodes = np.zeros((21, 21))
    nodes[11:, 11:] = block  # x, y >= 0.1
    ground = rp.Terrain.from_grid(nodes, 0.1, (-1.0, -1.0), "linear")
    stance = rp.settle(rover, ground)
    assert str(stance.status) == "settled"
    loads, joints, roll, pitch = mujoco_at_rest(text)
    weight = 9.81 * rover.mass
    assert sum(loads.values()) == pytest.approx(weight, rel=1e-6)
    assert stance.loads == pytest.approx(loads, abs=2e-3 * weight)  # friction of 0.05 carries a little
    for name, value in joints.items():
        assert stance.joints[name] == pytest.approx(value, abs=1e-3)
    assert stance.rpy[:2] == pytest.approx([roll, pitch], abs=1e-3)
    if block:
        assert abs(stance.joints["knuckle_l"]) > 0.05  # the loops have moved
