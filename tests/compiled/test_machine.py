"""A machine's arrays, against Pinocchio by a small walk of their own."""

import numpy as np
import pinocchio as pin
import pytest

import rover_pin as rp
from rover_pin.compiled.machine import machine_of

ROVERS = ["rocker_bogie", "hit_mrii"]


def turn(axis, angle):
    """Rodrigues' formula."""
    x, y, z = axis
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def base_pose(q):
    yaw, pitch, roll = q[3:6]
    return turn([0, 0, 1], yaw) @ turn([0, 1, 0], pitch) @ turn([1, 0, 0], roll), q[:3]


def walk(machine, q, g=0):
    """Rotations and origins of every joint's body, world; q as a rover's."""
    poses = {1: base_pose(q)}
    for joint in range(2, len(machine.parents)):
        rotation, origin = poses[machine.parents[joint]]
        origin = origin + rotation @ machine.translations[g, joint]
        rotation = rotation @ machine.rotations[g, joint]
        axis, value = machine.axes[g, joint], q[6 + joint - 2]
        if machine.turning[joint]:
            rotation = rotation @ turn(axis, value)
        else:
            origin = origin + rotation @ axis * value
        poses[joint] = (rotation, origin)
    return poses


def sprung(make):
    """A slanted sliding joint, a fixed chain, a foot, a strut, a loop and a box."""
    box = '<collision><origin xyz="0.1 0 0" rpy="0.3 0 0.2"/><geometry><box size="0.4 0.2 0.1"/></geometry>'
    return make.load(
        make.link("base", 3.0, com="0.1 0.2 0.3", extra=f"{box}</collision>"),
        make.link("leg", 2.0, com="0 0 -0.2"),
        make.link("toe", 0.5, com="0.1 0 0"),
        make.link("arm", 1.0),
        make.joint("slide", "base", "leg", "prismatic", axis="1 2 3", xyz="0.5 0 0"),
        '<joint name="fix" type="fixed"><parent link="leg"/><child link="toe"/>'
        '<origin xyz="0 0.1 -0.3" rpy="0.4 0.5 0.6"/></joint>',
        make.joint("turn", "base", "arm", axis="1 0 1", xyz="-0.5 0 0"),
        sidecar="""
        contacts: [{name: f, frame: toe, center: [0.1, 0.2, 0.3], radius: 0.02}]
        belly: [{frame: arm, point: [0.1, 0, -0.1]}]
        springs: [{name: s, frames: [base, {link: arm, xyz: [0, 0, 0.2]}], stiffness: 10, length_max: 2}]
        loops: [{name: l, frames: [toe, arm], type: distance, length: 1.5}]
        couplings: [{name: c, joints: {slide: 2, turn: -1}, offset: 0.1}]
        """,
    )


@pytest.fixture(params=[*ROVERS, "sprung"])
def rover(request, make):
    if request.param == "sprung":
        return sprung(make).with_payload([(2.0, (0.1, 0.0, 0.4))])
    return rp.load(request.param)


def test_centre_of_mass_and_wheels_at_random_configurations(rover):
    machine = machine_of(rover)
    data = rover.model.createData()
    rng = np.random.default_rng(3)
    for _ in range(5):
        q = rng.uniform(-1, 1, rover.model.nv)
        poses = walk(machine, q)
        pin.centerOfMass(rover.model, data, q)
        held = [
            poses[j][0] @ machine.moments[0, j] + poses[j][1] * machine.masses[0, j]
            for j in range(1, rover.model.njoints)
        ]
        np.testing.assert_allclose(sum(held) / machine.masses[0].sum(), data.com[0], atol=1e-13)
        for i, shape in enumerate(rover.shapes):
            rotation, origin = poses[machine.shape_joints[i]]
            body = data.oMi[shape.joint]
            center = origin + rotation @ machine.centers[0, i]
            np.testing.assert_allclose(center, body.act(np.array(shape.center)), atol=1e-13)
            np.testing.assert_allclose(
                rotation @ machine.shape_axes[0, i], body.rotation @ shape.axis, atol=1e-13
            )


def test_outline_holds_belly_and_hull(rover):
    machine = machine_of(rover)
    assert np.all(np.diff(machine.outline_joints) >= 0)
    for point in (*rover.belly, *rover.hull):
        corners = machine.outline[0, machine.outline_joints == point.joint]
        assert len(corners) == 8
        assert np.all(point.point - point.radius >= corners.min(axis=0) - 1e-12)
        assert np.all(point.point + point.radius <= corners.max(axis=0) + 1e-12)


def test_mechanism_is_taken_as_it_stands(make):
    rover = sprung(make)
    machine = machine_of(rover)
    loop, strut = rover.loops[0], rover.springs[0]
    assert machine.loop_lengths.tolist() == [[1.5]]
    assert machine.loop_joints.tolist() == [[loop.first.joint, loop.second.joint]]
    np.testing.assert_array_equal(machine.loop_rotations[0, 0, 0], loop.first.rotation)
    np.testing.assert_array_equal(machine.strut_translations[0, 0, 1], strut.second.translation)
    assert machine.strut_joints.tolist() == [[1, strut.second.joint]]
    slide, turning = rover.column["slide"], rover.column["turn"]
    assert machine.coupling_rows[0, 0, [slide, turning]].tolist() == [2, -1]
    assert machine.coupling_offsets.tolist() == [[0.1]]
    assert machine.turning.tolist() == [True, True, *(n == "turn" for n in rover.joints)]
    np.testing.assert_array_equal(machine.lower[0], rover.lower)


def test_payload_counts_on_its_joint(make):
    rover = sprung(make)
    loaded = machine_of(rover.with_payload([(2.0, (0.5, 0.0, 1.0))]))
    bare = machine_of(rover)
    np.testing.assert_allclose(loaded.masses[0, 1] - bare.masses[0, 1], 2.0, atol=1e-14)
    np.testing.assert_allclose(loaded.moments[0, 1] - bare.moments[0, 1], [1.0, 0.0, 2.0], atol=1e-14)


def test_a_rover_without_belly_or_shapes_has_an_empty_outline(make):
    machine = machine_of(make.load(*make.pair()))
    assert machine.outline.shape == (1, 0, 3)
    assert machine.outline_joints.shape == (0,)
    assert machine.centers.shape == (1, 0, 3)
    assert machine.loop_rotations.shape == (1, 0, 2, 3, 3)
