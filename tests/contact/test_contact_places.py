"""Ridges, notches, steps and cross slopes; several contacts of one wheel; symmetry."""

import math

import numpy as np
import pytest
from contact_oracle import brute, contacts, heights, lowered, rough_map, wheel_axis
from hypothesis import given, settings
from hypothesis import strategies as st

from rover_pin.contact.search import find_all, find_contacts
from rover_pin.terrain import Terrain

STEEP = math.tan(math.radians(60.0))


def ridge(angle, kind, sign=-1.0):
    """A crease through the origin along `angle`, flanks of 60 deg falling (a crest) or rising (a V)."""
    c, s = math.cos(angle), math.sin(angle)

    def height(x, y):
        return sign * STEEP * np.abs(s * x - c * y)

    if kind == "function":
        return Terrain.from_function(height)
    x = (np.arange(161) - 80) * 0.025
    return Terrain.from_grid(height(x[None, :], x[:, None]), 0.025, origin=(-2, -2), interpolation=kind)


POSES = [(0.0, 0.0, 0.0, 0.0), (0.0, 0.1, 0.013, 0.004), (0.7, -0.2, -0.02, 0.03)]
"""Yaw, camber, x, y of the wheel over the ridge."""


@pytest.mark.parametrize("kind", ["function", "linear", "smooth"])
@pytest.mark.parametrize(("turn", "angle"), list(enumerate([0.0, 0.5, math.pi / 4, 1.2, math.pi / 2])))
@pytest.mark.parametrize(("size", "tread"), list(enumerate([0.03, 0.01, 0.1])))
def test_over_a_ridge_of_60_degrees(kind, turn, angle, size, tread):
    """Every pose meets every kind, angle and tread, not every combination: a brute search costs a second."""
    terrain = ridge(angle, kind)
    yaw, camber, x, y = POSES[(turn + size) % 3]
    shape = (0, [x, y, 0.15], wheel_axis(yaw, camber), 0.15 - tread, tread)
    shape = lowered(terrain, shape, 0.1 * tread)
    row = contacts(terrain, shape)[0]
    best, _ = brute(terrain, shape)
    assert abs(row[0] - best) < 1e-4
    assert row[0] == pytest.approx(0.1 * tread, abs=1e-4 if kind == "function" else 1e-9)


def test_on_a_sharp_crest_across_the_gap_is_the_height_over_it():
    """Level crest across a level wheel: the least point of the wheel is over the crest, normal up."""
    for kind in ("function", "linear"):
        row = contacts(
            ridge(math.pi / 2, kind), (0, [0.0, 0.0, 0.15], np.array([0.0, 1.0, 0.0]), 0.12, 0.03)
        )[0]
        assert row[0] == pytest.approx(0.0, abs=2e-5 if kind == "function" else 1e-9)
        assert row[6] == pytest.approx(1.0, abs=1e-3)


@pytest.mark.parametrize("kind", ["function", "linear"])
def test_in_a_notch_across_it_touches_twice(kind):
    """A wheel of radius r in a V of 60 deg flanks: centre r / cos 60 above the corner, two normals."""
    terrain = ridge(math.pi / 2, kind, 1.0)
    rows = contacts(terrain, (0, [0.0, 0.0, 0.3], np.array([0.0, 1.0, 0.0]), 0.12, 0.03))
    assert len(rows) == 2
    assert rows[:, 0] == pytest.approx(0.0, abs=1e-9)
    assert sorted(rows[:, 4]) == pytest.approx([-math.sin(math.pi / 3), math.sin(math.pi / 3)], abs=1e-9)


@pytest.mark.parametrize("kind", ["function", "linear"])
def test_in_a_rut_along_it_touches_with_both_sides_of_its_tread(kind):
    terrain = ridge(0.0, kind, 1.0)
    rows = contacts(terrain, (0, [0.0, 0.0, 0.12 + 0.06], np.array([0.0, 1.0, 0.0]), 0.12, 0.03))
    assert len(rows) == 2
    assert rows[:, 0] == pytest.approx(0.0, abs=1e-9)
    assert sorted(rows[:, 5]) == pytest.approx([-math.sin(math.pi / 3), math.sin(math.pi / 3)], abs=1e-9)


@pytest.mark.parametrize("height", [0.05, 0.1, 0.3])
def test_against_a_step_it_touches_ground_and_step(height):
    terrain = Terrain.step(height, 0.0)
    ring, tread = 0.12, 0.03
    axis = np.array([0.0, 1.0, 0.0])

    def least(x):
        return contacts(terrain, (0, [x, 0.0, 0.15], axis, ring, tread))[0, 0]

    far, near = -0.6, 0.0
    assert least(far) == pytest.approx(0.0, abs=1e-9)
    assert least(near) < -1e-3
    for _ in range(60):
        middle = 0.5 * (far + near)
        far, near = (middle, near) if least(middle) > -1e-10 else (far, middle)
    rows = contacts(terrain, (0, [far, 0.0, 0.15], axis, ring, tread))
    assert len(rows) == 2
    assert rows[:, 0] == pytest.approx(0.0, abs=1e-8)
    ground, edge = sorted(rows, key=lambda r: r[3])
    assert ground[3] == pytest.approx(0.0, abs=1e-9)
    assert ground[6] == pytest.approx(1.0, abs=1e-9)
    assert edge[3] > 0.03
    assert edge[4] < -0.3


def test_flat_grid_gives_one_contact():
    for interpolation in ("smooth", "linear"):
        terrain = Terrain.from_grid(np.zeros((60, 60)), 0.05, interpolation=interpolation)
        for camber in (0.0, 0.2):
            for yaw in (0.0, 0.3, math.pi / 4, 2.0):
                shape = lowered(terrain, (0, [1.5, 1.5, 0.2], wheel_axis(yaw, camber), 0.12, 0.03))
                rows = contacts(terrain, shape)
                assert len(rows) == 1
                assert rows[0, 0] == pytest.approx(0.0, abs=1e-9)


@settings(max_examples=25, deadline=None, derandomize=True)
@given(st.floats(1.5, 3.0), st.floats(1.5, 3.0), st.floats(-3, 3), st.floats(-0.4, 0.4), st.floats(-0.3, 0.3))
def test_moves_with_the_map_and_forgets_the_axis_sign(x, y, yaw, camber, lift):
    base = rough_map(90, 0.05, 0.04, 11)
    axis = wheel_axis(yaw, camber)
    here = (0, np.array([x, y, heights(base, x, y)[0] + 0.15 + 0.03 * lift]), axis, 0.12, 0.03)
    row = contacts(base, here)[0]
    turned = contacts(base, (0, here[1], -axis, 0.12, 0.03))[0]
    assert turned[0] == pytest.approx(row[0], abs=1e-9)
    nodes = 0.05 * np.arange(90)
    z = heights(base, *np.meshgrid(nodes, nodes)).reshape(90, 90)
    moved = Terrain.from_grid(z + 0.5, 0.05, origin=(10.0, -4.0))
    there = contacts(moved, (0, here[1] + [10.0, -4.0, 0.5], axis, 0.12, 0.03))[0]
    assert there[0] == pytest.approx(row[0], abs=1e-9)
    # A quarter turn of map and wheel: (x, y) goes to (-y, x).
    quarter = Terrain.from_grid(np.rot90(z, -1), 0.05)
    spot = [nodes[-1] - y, x, here[1][2]]
    around = contacts(quarter, (0, np.array(spot), np.array([-axis[1], axis[0], axis[2]]), 0.12, 0.03))[0]
    assert around[0] == pytest.approx(row[0], abs=1e-9)


@settings(max_examples=40, deadline=None, derandomize=True)
@given(st.floats(-0.2, 0.4), st.floats(0.0, 0.1), st.floats(-1.5, 1.5), st.floats(-3.1, 3.1))
def test_rows_are_sorted_apart_and_within_the_window(lift, window, camber, yaw):
    terrain = rough_map(90, 0.05, 0.06, 13)
    shape = (
        0,
        np.array([2.0, 2.0, heights(terrain, 2.0, 2.0)[0] + lift]),
        wheel_axis(yaw, camber),
        0.12,
        0.03,
    )
    rows = contacts(terrain, shape, window)
    assert 1 <= len(rows) <= 8
    assert np.isfinite(rows).all()
    assert (np.diff(rows[:, 0]) >= 0).all()
    assert rows[-1, 0] <= rows[0, 0] + window
    for i in range(len(rows)):
        for j in range(i):
            assert np.linalg.norm(rows[i, 1:4] - rows[j, 1:4]) > 1e-4


def test_all_at_once_is_one_by_one():
    terrain = rough_map(90, 0.05, 0.04, 17)
    rng = np.random.default_rng(0)
    m = 6
    forms = np.array([0, 0, 0, 0, 1, 0])
    axes = np.array([wheel_axis(rng.uniform(-3, 3), 0.1) for _ in range(m)])
    centers = np.column_stack([rng.uniform(1.5, 3, (m, 2)), rng.uniform(0.1, 0.3, m)])
    rings, treads = np.array([0.12, 0.05, 0.0, 0.0, 0.1, 0.1]), np.array([0.03, 0.03, 0.05, 0.0, 0.05, 0.0])
    out, counts = np.zeros((m, 8, 7)), np.zeros(m, dtype=np.int64)
    where = (terrain.kind, terrain.table, terrain.params, terrain.spacing)
    find_all(*where, forms, centers, axes, rings, treads, 0.01, out, counts)
    for i in range(m):
        one = np.zeros((8, 7))
        n = find_contacts(*where, forms[i], centers[i], axes[i], rings[i], treads[i], 0.01, one)
        assert n == counts[i]
        assert (one[:n] == out[i, :n]).all()
