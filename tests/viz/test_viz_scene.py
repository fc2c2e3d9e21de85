"""The scene of a stance, read back from the commands that Meshcat would get."""

from __future__ import annotations

import struct
from types import SimpleNamespace

import numpy as np
import pinocchio as pin
import pytest
import umsgpack
import viz_doubles as doubles
from scipy.spatial import ConvexHull

from rover_pin.viz.record import recording
from rover_pin.viz.scene import draw
from rover_pin.viz.support import corners, hull, limiting_edge
from rover_pin.viz.tree import base_matrix, joint_nodes, turn


@pytest.fixture(scope="module")
def stance():
    return doubles.stance()


@pytest.fixture(scope="module")
def commands(stance):
    visualizer, recorder = recording()
    draw(visualizer, stance, limiting="fl-fr")
    return recorder.commands


def transforms(commands):
    found = {}
    for command in commands:
        if command["type"] == "set_transform":
            found[command["path"]] = np.array(command["matrix"]).reshape(4, 4).T
    return found


def objects(commands):
    return {c["path"]: c["object"] for c in commands if c["type"] == "set_object"}


def cross(a, b):
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def in_world(path, known):
    matrix, parts = np.eye(4), path.strip("/").split("/")
    for k in range(1, len(parts) + 1):
        matrix = matrix @ known.get("/" + "/".join(parts[:k]), known.get("/".join(parts[:k]), np.eye(4)))
    return matrix


def test_every_joint_stands_where_pinocchio_puts_it(stance, commands):
    model, data = stance.rover.model, stance.rover.model.createData()
    pin.forwardKinematics(model, data, np.asarray(stance.configuration))
    known = transforms(commands)
    for node in joint_nodes(model):
        path = next(p for p in known if p.endswith(f"meshcat/{node.path}"))
        np.testing.assert_allclose(in_world(path, known), data.oMi[node.joint].homogeneous, atol=1e-12)


def test_every_visual_stands_where_its_link_does(stance, commands):
    model, data = stance.rover.model, stance.rover.model.createData()
    pin.forwardKinematics(model, data, np.asarray(stance.configuration))
    known = transforms(commands)
    placed = [in_world(path, known) for path in objects(commands) if "/visuals/" in path]
    for visual in stance.rover.visuals:
        wanted = data.oMi[visual.joint].homogeneous @ visual.placement
        assert min(np.abs(wanted - matrix).max() for matrix in placed) < 1e-12


def test_ground_loads_polygon_and_com_are_one_object_each(stance, commands):
    paths = [path.split("meshcat/")[1] for path in objects(commands)]
    assert len(paths) == len(set(paths))
    others = sorted(path for path in paths if "/visuals/" not in path)
    assert others == ["com", "ground", "loads", "support/area", "support/edges"]
    drawn = len(stance.rover.visuals) + len(stance.rover.wheels)  # wheels have no looks of their own
    assert len(paths) - len(others) == drawn


def test_a_stance_that_tips_has_no_loads_and_no_polygon():
    visualizer, recorder = recording()
    draw(visualizer, doubles.stance(status="tips"))
    paths = {path.split("meshcat/")[1] for path in objects(recorder.commands)}
    assert {path for path in paths if "/visuals/" not in path} == {"com", "ground"}


def test_the_stream_keeps_each_command_behind_its_length(commands):
    visualizer, recorder = recording()
    visualizer["a"].set_transform(np.diag([1.0, 2.0, 3.0, 1.0]))
    visualizer["a"].set_property("visible", False)
    stream, read = recorder.stream(), []
    while stream:
        size = struct.unpack("<I", stream[:4])[0]
        read.append(umsgpack.unpackb(stream[4 : 4 + size]))
        stream = stream[4 + size :]
    assert [c["type"] for c in read] == ["set_transform", "set_property"]
    assert read == recorder.commands


@pytest.mark.parametrize("value", [-2.0, 0.0, 0.3, 3.0])
def test_turning_and_sliding_agree_with_pinocchio(value):
    model = doubles.rover().model
    data = model.createData()
    for node in joint_nodes(model)[1:]:
        q = np.zeros(model.nq)
        q[model.idx_qs[node.joint]] = value
        pin.forwardKinematics(model, data, q)
        np.testing.assert_allclose(
            node.placement @ turn(node, value), data.liMi[node.joint].homogeneous, atol=1e-12
        )


def test_the_base_turns_yaw_pitch_roll():
    model = doubles.rover().model
    data = model.createData()
    pin.forwardKinematics(model, data, np.r_[1.0, 2.0, 3.0, 0.4, -0.5, 0.6, np.zeros(model.nq - 6)])
    ours = base_matrix(model, np.array([1.0, 2.0, 3.0]), np.array([0.6, -0.5, 0.4]))
    np.testing.assert_allclose(ours, data.oMi[1].homogeneous, atol=1e-12)


def test_hull_against_scipy():
    random = np.random.default_rng(0)
    for n in (3, 4, 7, 30):
        points = random.normal(size=(n, 2))
        ours = hull(points)
        assert set(ours) == set(ConvexHull(points).vertices)
        ring = points[ours]
        turning = cross(np.roll(ring, -1, 0) - ring, np.roll(ring, -2, 0) - np.roll(ring, -1, 0))
        assert (turning > 0).all()
    assert len(hull(np.array([[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]))) < 3


def test_the_named_edge_limits_else_the_nearest(stance):
    ring = corners(stance)
    names = [f"{a.wheel}-{ring[(i + 1) % len(ring)].wheel}" for i, a in enumerate(ring)]
    for i, name in enumerate(names):
        assert limiting_edge(stance, name) == i
        assert limiting_edge(stance, "-".join(reversed(name.split("-")))) == i
    points = np.array([c.point[:2] for c in ring])
    edge = np.roll(points, -1, 0) - points
    away = cross(edge, stance.com[:2] - points) / np.linalg.norm(edge, axis=1)
    assert limiting_edge(stance, "no-such") == int(np.argmin(away))


def test_a_mesh_that_cannot_be_read_is_said_and_the_rest_is_drawn(tmp_path):
    broken = tmp_path / "body.stl"
    broken.write_bytes(b"solid nothing")
    stance = doubles.stance()
    parts = len(stance.rover.visuals)
    stance.rover.visuals = (
        *stance.rover.visuals,
        SimpleNamespace(
            link="x",
            joint=1,
            placement=np.eye(4),
            kind="mesh",
            size=(1, 1, 1),
            mesh=broken,
            rgba=(1, 1, 1, 1),
        ),
    )
    visualizer, recorder = recording()
    assert draw(visualizer, stance).unread == ("body.stl",)
    assert sum("/visuals/" in path for path in objects(recorder.commands)) == parts + 6
