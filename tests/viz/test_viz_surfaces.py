"""Meshes: wheels as swept rings, the ground on the terrain's own surface."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
import trimesh
import viz_doubles as doubles
from hypothesis import given, settings
from hypothesis import strategies as st

from rover_pin.viz.arrows import lightest, load_arrows
from rover_pin.viz.meshes import bare_shapes, ring_surface, visual_object
from rover_pin.viz.surfaces import arrow, ball, tube
from rover_pin.viz.terrain_mesh import ground_surface, nice_step, stretched


def shape(ring, tread, axis=(0.3, 1.0, -0.2), form=0):
    axis = np.array(axis, dtype=float)
    axis /= np.linalg.norm(axis) or 1.0
    return SimpleNamespace(ring=ring, tread=tread, center=np.array([0.1, -0.2, 0.3]), axis=axis, form=form)


def distance_to_disc(points, thing):
    """From points to the disc of radius `ring`; to the circle outside it."""
    away = points - thing.center
    along = away @ thing.axis
    radial = np.linalg.norm(away - along[:, None] * thing.axis, axis=1)
    return np.hypot(np.maximum(radial - thing.ring, 0.0), along)


@settings(max_examples=25, deadline=None, derandomize=True)
@given(ring=st.floats(0.02, 0.5), tread=st.floats(0.005, 0.2))
def test_a_wheel_is_its_swept_ring(ring, tread):
    wheel = shape(ring, tread)
    away = distance_to_disc(ring_surface(wheel).vertices, wheel)
    assert away.max() <= 1.02 * tread + 1e-12  # the hub stands out by a fiftieth
    assert np.isclose(away, tread, rtol=1e-9).mean() > 0.5


def test_a_foot_is_a_ball_and_a_segment_a_capsule():
    foot = shape(0.0, 0.05, axis=(0, 0, 0))
    np.testing.assert_allclose(np.linalg.norm(ring_surface(foot).vertices - foot.center, axis=1), 0.05)
    capsule = shape(0.2, 0.05, form=1)
    away = ring_surface(capsule).vertices - capsule.center
    along = np.clip(away @ capsule.axis, -0.2, 0.2)
    np.testing.assert_allclose(np.linalg.norm(away - along[:, None] * capsule.axis, axis=1), 0.05)


def test_bars_and_arrows_reach_from_start_to_end():
    start, end = np.array([1.0, 2.0, 3.0]), np.array([1.5, 1.0, 3.3])
    along = (end - start) / np.linalg.norm(end - start)
    for made in (tube(start, end, 0.02, (1, 0, 0)), arrow(start, end, 0.02, (1, 0, 0))):
        way = (made.vertices - start) @ along
        assert way.min() == pytest.approx(0.0, abs=1e-12)
        assert way.max() == pytest.approx(np.linalg.norm(end - start))
        assert made.faces.max() < len(made.vertices)
    np.testing.assert_allclose(np.linalg.norm(ball(start, 0.3, (0, 0, 0)).vertices - start, axis=1), 0.3)


def test_arrows_are_as_long_as_their_loads():
    stance = doubles.stance()
    made = load_arrows(stance, 1.6)
    heaviest = max(stance.contacts, key=lambda c: c.load)
    assert made.vertices[:, 2].max() <= max(c.point[2] for c in stance.contacts) + 0.4 * 1.6 + 1e-9
    tip = heaviest.point + np.array([0, 0, 0.4 * 1.6])
    assert np.linalg.norm(made.vertices - tip, axis=1).min() < 1e-9
    assert lightest(stance) == "ml"
    assert len(load_arrows(doubles.stance(status="tips"), 1.6).faces) == 0


def test_the_ground_is_the_terrains_surface_within_the_map():
    terrain = doubles.Hills(extent=(-3.0, 3.0, -2.0, 2.5))
    ground, step = ground_surface(terrain, 2.5, 0.0, 1.6)
    x, y, z = ground.vertices.T
    np.testing.assert_allclose(z, terrain.height(x, y), atol=1e-12)
    assert (x.min(), x.max(), y.min(), y.max()) == pytest.approx((-3.0, 3.0, -2.0, 2.5))
    assert step > 0
    assert ground.faces.max() < len(ground.vertices)
    up = trimesh.Trimesh(ground.vertices, ground.faces, process=False).face_normals
    assert (up[:, 2] > 0).all()


def test_unbounded_ground_is_cut_around_the_rover_and_level_ground_has_no_contours():
    ground, step = ground_surface(doubles.Hills(height=0.0), 10.0, -4.0, 1.6)
    assert step == 0.0
    assert np.abs(ground.vertices[:, 0] - 10.0).max() == pytest.approx(4 * 1.6)


@settings(max_examples=50, deadline=None, derandomize=True)
@given(st.floats(0.1, 3.0), st.floats(0.0, 40.0), st.floats(0.0, 40.0))
def test_stretched_coordinates_increase_and_reach_the_ends(near, left, right):
    xs = stretched(5.0, near, 5.0 - left, 5.0 + right)
    assert (np.diff(xs) >= 0).all()
    assert (xs[0], xs[-1]) == pytest.approx((5.0 - left, 5.0 + right))


@pytest.mark.parametrize(
    ("reach", "step"), [(1.0, 0.1), (0.9, 0.05), (23.0, 2.0), (0.0, 0.0), (float("nan"), 0.0)]
)
def test_contour_steps_are_round(reach, step):
    assert nice_step(reach) == pytest.approx(step)


def test_mesh_visuals_of_several_forms_are_scaled(tmp_path):
    box = trimesh.creation.box((1.0, 2.0, 3.0))
    for suffix in ("stl", "obj", "ply"):
        path = tmp_path / f"box.{suffix}"
        box.export(path)
        visual = SimpleNamespace(
            placement=np.eye(4), kind="mesh", size=(0.1, 0.1, 0.2), mesh=path, rgba=(0.1, 0.2, 0.3, 0.5)
        )
        made, _ = visual_object(visual)
        np.testing.assert_allclose(np.ptp(made.geometry.vertices, axis=0), [0.1, 0.2, 0.6], rtol=1e-6)
        assert made.material.opacity == 0.5


def test_cylinders_lie_along_z():
    placement = np.eye(4)
    visual = SimpleNamespace(
        placement=placement, kind="cylinder", size=(0.1, 0.4), mesh=None, rgba=(1, 1, 1, 1)
    )
    made, turned = visual_object(visual)
    assert (made.geometry.radiusTop, made.geometry.height) == (0.1, 0.4)
    np.testing.assert_allclose(turned @ [0, 1, 0, 0], [0, 0, 1, 0], atol=1e-15)  # three.js has it along y


def test_a_wheel_with_looks_of_its_own_is_not_drawn_twice():
    rover = doubles.rover()
    rover.visuals = (*rover.visuals, SimpleNamespace(link="wheel_fl"))
    assert "fl" not in [wheel.name for wheel in bare_shapes(rover)]
    assert len(bare_shapes(rover)) == 5


class Terrace:
    """Level at 0 and 0.2 m, both heights of contours, with a ramp between."""

    label, spacing, extent = "terrace", 0.05, (-3.0, 3.0, -3.0, 3.0)

    def height(self, x, y):
        return np.clip(np.asarray(x) + 0.0 * np.asarray(y), 0.0, 0.2)

    def gradient(self, x, y):
        x = np.asarray(x) + 0.0 * np.asarray(y)
        return np.stack([np.where((x > 0) & (x < 0.2), 1.0, 0.0), 0.0 * x], axis=-1)


def test_level_ground_at_a_contours_height_is_not_painted_as_a_line():
    ground, step = ground_surface(Terrace(), 0.0, 0.0, 1.0)
    assert step == pytest.approx(0.02)
    x = ground.vertices[:, 0]
    for side in (x < -1e-9, x > 0.2 + 1e-9):
        assert np.ptp(ground.colours[side], axis=0).max() < 1e-12
