"""Robots of others: loaded without a sidecar, and with a small one."""

import sys
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

import rover_pin as rp

ROBOTS = Path(sys.prefix).glob("lib/python*/site-packages/cmeel.prefix/share/example-robot-data/robots")
HOME = next(iter(ROBOTS))


@pytest.mark.parametrize(
    ("path", "mass", "joints", "driven"),
    [
        ("anymal_b_simple_description/robots/anymal.urdf", None, 12, 0),
        ("tiago_description/robots/tiago.urdf", None, 48, None),
        ("solo_description/robots/solo12.urdf", None, 12, 0),
        ("hyq_description/robots/hyq_no_sensors.urdf", None, 12, 12),
        ("ur_description/urdf/ur5_robot.urdf", None, 6, 6),
        ("talos_data/robots/talos_reduced.urdf", None, 32, 32),
    ],
)
def test_robots_of_example_robot_data(path, mass, joints, driven):
    rover = rp.load(HOME / path)
    assert rover.model.nq == rover.model.nv == 6 + joints
    assert len(rover.joints) == joints
    assert driven is None or len(rover.actuated) == driven
    free = pin.buildModelFromUrdf(str(HOME / path), pin.JointModelFreeFlyer())
    assert rover.mass == pytest.approx(pin.computeTotalMass(free), rel=1e-12)
    plain = free.createData()
    pin.centerOfMass(free, plain, pin.neutral(free))
    ours = pin.centerOfMass(rover.model, rover.model.createData(), np.zeros(rover.model.nv))
    np.testing.assert_allclose(ours, plain.com[0], atol=1e-12)


def test_meshes_of_a_package_are_found():
    rover = rp.load(HOME / "solo_description/robots/solo12.urdf")
    assert any(v.kind == "mesh" and v.mesh is not None and v.mesh.is_file() for v in rover.visuals)


def test_anymal_with_feet(tmp_path):
    sidecar = tmp_path / "feet.yaml"
    feet = "".join(
        f"  - {{frame: {leg}_FOOT, radius: 0.02, friction: 0.7}}\n" for leg in ("LF", "RF", "LH", "RH")
    )
    sidecar.write_text(f"schema: 1\npassive: []\ncontacts:\n{feet}")
    rover = rp.load(HOME / "anymal_b_simple_description/robots/anymal.urdf", sidecar=sidecar)
    assert [f.name for f in rover.feet] == ["LF_FOOT", "RF_FOOT", "LH_FOOT", "RH_FOOT"]
    assert len(rover.actuated) == 12
    assert 0.6 < rover.wheel_span < 1.2
