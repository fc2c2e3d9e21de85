"""What is drawn, and the hull."""

import numpy as np
import pytest

BOX = '<geometry><box size="1 0.5 0.2"/></geometry>'


def test_visuals_have_place_size_and_colour(make):
    red = '<material name="red"/>'
    rover = make.load(
        '<material name="red"><color rgba="1 0 0 0.5"/></material>',
        make.link("base", extra=f"<visual>{BOX}{red}</visual>"),
        make.link(
            "arm",
            extra=(
                '<visual><origin xyz="0 0 1"/><geometry><cylinder radius="0.1" '
                'length="2"/></geometry></visual>'
            ),
        ),
        make.link("tip", extra='<visual><geometry><sphere radius="0.3"/></geometry></visual>'),
        make.joint("j", "base", "arm"),
        make.joint("f", "arm", "tip", "fixed", xyz="1 2 3"),
    )
    box, cylinder, sphere = rover.visuals
    assert (box.kind, box.size, box.rgba, box.joint) == ("box", (1, 0.5, 0.2), (1, 0, 0, 0.5), 1)
    assert (cylinder.kind, cylinder.size, cylinder.joint) == ("cylinder", (0.1, 2), 2)
    np.testing.assert_allclose(cylinder.placement[:3, 3], [0, 0, 1])
    assert (sphere.kind, sphere.size, sphere.joint, sphere.link) == ("sphere", (0.3,), 2, "tip")
    np.testing.assert_allclose(sphere.placement[:3, 3], [1, 2, 3])
    assert sphere.rgba == (0.7, 0.7, 0.7, 1.0)


def test_meshes_are_found_not_opened(make, tmp_path):
    (tmp_path / "m.stl").write_text("not a mesh")
    mesh = '<visual><geometry><mesh filename="{}" scale="0.001 0.001 0.001"/></geometry></visual>'
    rover = make.load(make.link("base", extra=mesh.format("m.stl") + mesh.format("package://gone/n.dae")))
    (visual,) = rover.visuals
    assert visual.mesh == tmp_path / "m.stl"
    assert visual.size == (0.001, 0.001, 0.001)
    assert "mesh package://gone/n.dae is missing: not drawn" in rover.notes


def test_strange_shapes_are_left_out(make):
    strange = "<visual><geometry><capsule radius='1'/></geometry></visual><collision><geometry/></collision>"
    rover = make.load(make.link("base", extra=strange))
    assert rover.visuals == ()
    assert "link base: <capsule> visual shape left out" in rover.notes
    assert "link base: empty collision shape left out" in rover.notes


def test_hull_of_a_box_covers_its_faces(make):
    rover = make.load(make.link("base", extra=f"<collision>{BOX}</collision>"))
    points = np.array([p.point for p in rover.hull])
    half = np.array([0.5, 0.25, 0.1])
    assert np.abs(points).max(axis=0) == pytest.approx(half)
    assert np.isclose(np.abs(points), half).any(axis=1).all()
    rng = np.random.default_rng(0)
    on_face = rng.uniform(-1, 1, (200, 3)) * half
    on_face[np.arange(200), rng.integers(0, 3, 200)] = 0
    axis = rng.integers(0, 3, 200)
    on_face[np.arange(200), axis] = half[axis]
    away = np.linalg.norm(points[None] - on_face[:, None], axis=2).min(axis=1)
    assert away.max() <= 0.1 / np.sqrt(2) + 1e-9
    assert all(p.radius == 0 and p.joint == 1 and p.link == "base" for p in rover.hull)


def test_hull_of_a_cylinder_and_a_sphere(make):
    cylinder = (
        '<collision><origin xyz="0 0 1" rpy="1.5707963267948966 0 0"/>'
        '<geometry><cylinder radius="0.3" length="1"/></geometry></collision>'
    )
    ball = '<collision><origin xyz="0 0 2"/><geometry><sphere radius="0.4"/></geometry></collision>'
    rover = make.load(make.link("base", extra=cylinder + ball))
    *mantle, sphere = rover.hull
    assert (sphere.radius, tuple(sphere.point)) == (0.4, (0, 0, 2))
    points = np.array([p.point for p in mantle]) - [0, 0, 1]
    np.testing.assert_allclose(np.hypot(points[:, 0], points[:, 2]), 0.3)
    assert np.abs(points[:, 1]).max() == pytest.approx(0.5)


def test_wheels_are_no_hull(make):
    body = f"<collision>{BOX}</collision>"
    parts = [
        make.link("base", extra=body),
        make.link("fork", extra=body),
        make.link("wheel", extra=body),
        make.link("hub", extra=body),
        make.link("rigid", extra=body),
        make.joint("steer", "base", "fork", axis="0 0 1"),
        make.joint("drive", "fork", "wheel", "continuous"),
        make.joint("h", "wheel", "hub", "fixed"),
        make.joint("r", "base", "rigid", "fixed"),
    ]
    rover = make.load(
        *parts, sidecar="wheels: [{frame: wheel, radius: 0.1}, {frame: rigid, radius: 0.1, axis: [0, 1, 0]}]"
    )
    assert {p.link for p in rover.hull} == {"base", "fork"}


def test_collision_meshes_are_told(make):
    mesh = '<collision><geometry><mesh filename="m.stl"/></geometry></collision>'
    rover = make.load(make.link("base", extra=mesh))
    assert rover.hull == ()
    assert (
        "link base: its collision mesh is not tested against the ground; use "
        "boxes, cylinders, spheres or `belly`" in rover.notes
    )
