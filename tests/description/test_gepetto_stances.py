"""A loop of Gepetto's robot.yaml and the same loop of our sidecar: one stance, bit for bit, the right one."""

import dataclasses
import json

import numpy as np
import pinocchio as pin
import pytest
from closed_rover import TOUCHING, closed_rover, gepettos_residual
from scipy.spatial.transform import Rotation

import rover_pin as rp
from rover_pin.cli import main

PLACES = {
    "rough": (rp.Terrain.rough(4, 0.03, 0.8, size=8.0), {"x": 0.3, "y": -0.2, "yaw": 0.7}),
    "mars": (rp.Terrain.rough(9, 0.02, 0.8, size=8.0), {"x": -1.0, "yaw": 2.1, "gravity": 3.71}),
    "step": (rp.Terrain.step(0.06, 0.2), {"yaw": -0.6, "joints": {"drive_bl": 0.4}}),
}


def written(folder, made):
    """The URDF, and sidecars that say its loop in four ways."""
    path = folder / "closed.urdf"
    path.write_text(made.urdf)
    (folder / "robot.yaml").write_text(made.gepetto)
    texts = {
        "ours": made.ours() + TOUCHING,
        "named": "robot_yaml: robot.yaml\n" + TOUCHING,
        "mixed": made.gepetto + TOUCHING,
        "placed": made.ours(made.placed) + TOUCHING,
    }
    for name, text in texts.items():
        (folder / f"{name}.yaml").write_text("schema: 1\n" + text)
    return path, {name: folder / f"{name}.yaml" for name in texts}


def public(value):
    """Everything a stance or contact says, but for whose it is."""
    names = [f.name for f in dataclasses.fields(value) if f.name not in ("rover", "terrain")]
    fields = {name: getattr(value, name) for name in names}
    for name, each in fields.items():
        if isinstance(each, np.ndarray):
            fields[name] = each.tolist()
        elif name == "contacts":
            fields[name] = [public(contact) for contact in each]
        elif hasattr(each, "keys"):
            fields[name] = dict(each)
    return fields


@pytest.mark.parametrize("kind", ["3d", "6d"])
@pytest.mark.parametrize("seed", [0, 5, 8])
def test_loops_of_random_shape_stand_alike_and_in_equilibrium(tmp_path, seed, kind):
    path, sidecars = written(tmp_path, closed_rover(seed, kind))
    rovers = {name: rp.load(path, sidecar=file) for name, file in sidecars.items()}
    for terrain, where in PLACES.values():
        stances = {name: rp.settle(rover, terrain, **where) for name, rover in rovers.items()}
        ours = stances["ours"]
        assert ours.settled
        assert not ours.stops
        assert max(abs(v) for name, v in ours.joints.items() if "pin" in name) > 1e-3  # the linkage has moved
        assert public(stances["named"]) == public(ours)
        assert public(stances["mixed"]) == public(ours)
        assert rp.stability(stances["mixed"]) == rp.stability(ours)
        np.testing.assert_allclose(stances["placed"].configuration, ours.configuration, atol=1e-11)
        assert stances["placed"].loads == pytest.approx(ours.loads, abs=1e-9 * ours.weight)
        open_, unbalanced = gepettos_residual(path, ours, kind)
        assert open_ < 1e-9
        assert unbalanced < 1e-9


def test_settle_prints_the_same_of_both(tmp_path, capsys):
    path, sidecars = written(tmp_path, closed_rover(2, "6d"))
    told = []
    for name in ("ours", "named", "mixed"):
        words = ["--terrain", "rough:4,0.03,0.8", "--at", "0.3,-0.2,40", "--json"]
        assert main(["settle", str(path), "--sidecar", str(sidecars[name]), *words]) == 0
        told.append(json.loads(capsys.readouterr().out))
    assert told[0] == told[1] == told[2]
    assert told[0]["status"] == "settled"
    assert sum(w["load_n"] for w in told[0]["wheels"].values()) > 100.0


@pytest.mark.parametrize("kind", ["3d", "6d"])
def test_a_loop_that_is_open_at_zero_is_closed(tmp_path, kind):
    path, sidecars = written(tmp_path, closed_rover(5, kind, open_=0.2))
    terrain, where = PLACES["rough"]
    ours, mixed = (rp.settle(rp.load(path, sidecar=sidecars[n]), terrain, **where) for n in ("ours", "mixed"))
    assert public(mixed) == public(ours)
    assert max(gepettos_residual(path, ours, kind)) < 1e-9
    (tmp_path / "drawn_closed").mkdir()
    path, sidecars = written(tmp_path / "drawn_closed", closed_rover(5, kind))
    closed = rp.settle(rp.load(path, sidecar=sidecars["ours"]), terrain, **where)
    assert ours.joints["crank_pin"] == pytest.approx(closed.joints["crank_pin"] - 0.2, abs=1e-9)
    assert ours.loads == pytest.approx(closed.loads, abs=1e-7)


def test_the_last_hinge_of_a_planar_loop_may_as_well_be_a_ball(tmp_path):
    """SPHERICAL frees two more turns, which the weld at its end takes away again."""
    made = closed_rover(8, "6d")
    path, sidecars = written(tmp_path, made)
    balls = tmp_path / "balls.yaml"
    types = "joint_name: [tip_pin]\njoint_type: [SPHERICAL]\n"
    balls.write_text("schema: 1\n" + made.gepetto + types + TOUCHING)
    terrain, where = PLACES["rough"]
    hinge, ball = (
        rp.settle(rp.load(path, sidecar=file), terrain, **where) for file in (sidecars["ours"], balls)
    )
    assert {"tip_pin_X", "tip_pin_Y", "tip_pin_Z"} <= set(ball.joints)
    assert ball.loads == pytest.approx(hinge.loads, abs=1e-8)
    assert ball.joints["crank_pin"] == pytest.approx(hinge.joints["crank_pin"], abs=1e-10)
    assert ball.rpy == pytest.approx(hinge.rpy, abs=1e-10)


@pytest.mark.parametrize("letters", ["XY", "XZ", "YX", "YZ", "ZX", "ZY", "XYZ", ""])
def test_joint_types_turn_as_there(make, tmp_path, letters):
    """UJOINT_YZ is a turn about y, then about z, in the joint's own frame; a ball all three."""
    kind = {3: "SPHERICAL", 2: f"UJOINT_{letters}", 0: "FIXED"}[len(letters)]
    origin = '<origin xyz="0.1 -0.2 0.3" rpy="0.4 -0.5 0.6"/>'
    text = make.joint("j", "base", "arm", axis="0.6 0 0.8").replace('<origin xyz="0 0 0"/>', origin)
    path = make.write(make.link("base"), make.link("arm"), text)
    (tmp_path / "robot.yaml").write_text(
        f"closed_loop: []\nname_mot: []\njoint_name: [j]\njoint_type: [{kind}]\n"
    )
    rover = rp.load(path)
    assert rover.joints == tuple(f"j_{letter}" for letter in letters)
    angles = dict(zip(rover.joints, (0.7, -0.4, 0.3), strict=False))
    data = rover.model.createData()
    pin.framesForwardKinematics(rover.model, data, rover.configuration(angles))
    arm = data.oMf[rover.model.getFrameId("arm", pin.FrameType.BODY)]
    expected = Rotation.from_euler("xyz", [0.4, -0.5, 0.6])  # fixed axes, as rpy
    if letters:
        expected = expected * Rotation.from_euler(letters, list(angles.values()))  # capitals: moving axes
    np.testing.assert_allclose(arm.rotation, expected.as_matrix(), atol=1e-12)
    np.testing.assert_allclose(arm.translation, [0.1, -0.2, 0.3], atol=1e-12)
