"""Closed forms on planes, whichever kind of terrain says them."""

import math

import numpy as np
import pytest
from contact_oracle import contacts, unit, wheel_axis
from hypothesis import given, settings
from hypothesis import strategies as st

from rover_pin.terrain import Terrain

RING, SEGMENT = 0, 1


def plane_gap(shape, n, offset):
    form, center, axis, ring, tread = shape
    along = float(np.dot(axis, n))
    reach = ring * math.sqrt(max(1 - along**2, 0)) if form == RING else ring * abs(along)
    return float(np.dot(center, n)) - offset - reach - tread


def terrains(a, b):
    """The plane z = 0.1 + a x + b y as every kind of terrain that can say it."""
    x = np.arange(60) * 0.1
    z = 0.1 + a * x[None, :] + b * x[:, None]
    yield Terrain.from_grid(z, 0.1, origin=(-3, -3), interpolation="linear"), 0.1 + 3 * a + 3 * b
    yield Terrain.from_function(lambda x, y: 0.1 + a * x + b * y), 0.1


@settings(max_examples=60, deadline=None, derandomize=True)
@given(
    st.floats(0, 40), st.floats(-3, 3), st.floats(-3.2, 3.2), st.floats(-0.6, 0.6), st.floats(0, 1),
    st.floats(-0.02, 0.5), st.sampled_from([RING, SEGMENT]),
)  # fmt: skip
def test_plane_terrain_is_exact(deg, heading, yaw, camber, share, height, form):
    terrain = Terrain.slope(deg, math.degrees(heading))
    s = math.tan(math.radians(deg))
    n = unit([-s * math.cos(heading), -s * math.sin(heading), 1])
    r = 0.2
    shape = (form, np.array([0.3, -0.2, height]), wheel_axis(yaw, camber), r * (1 - share), r * share)
    row = contacts(terrain, shape)[0]
    assert row[0] == pytest.approx(plane_gap(shape, n, 0.0), abs=1e-12)
    assert row[4:] == pytest.approx(n, abs=1e-12)
    assert np.dot(row[1:4], n) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("form", [RING, SEGMENT])
@pytest.mark.parametrize("tread", [0.0, 0.02, 0.15])
@pytest.mark.parametrize(
    ("deg", "heading"), [(0.0, 0.0), (20.0, 0.0), (20.0, 1.2), (35.0, -2.0), (60.0, 0.7)]
)
def test_search_finds_the_plane(form, tread, deg, heading):
    s = math.tan(math.radians(deg))
    a, b = s * math.cos(heading), s * math.sin(heading)
    n = unit([-a, -b, 1])
    for terrain, h0 in terrains(a, b):
        for yaw, camber, gap in [(0.0, 0.0, 0.0), (0.8, 0.15, 0.003), (2.0, -0.3, -0.004), (-1.1, 0.05, 0.1)]:
            shape = (form, np.zeros(3), wheel_axis(yaw, camber), 0.15 - tread, tread)
            offset = h0 * n[2]
            lift = gap - plane_gap(shape, n, offset)
            shape[1][:] = lift * n
            rows = contacts(terrain, shape)
            assert rows[0, 0] == pytest.approx(gap, abs=1e-9)
            if tread > 0.0:
                assert rows[0, 4:] == pytest.approx(n, abs=1e-7)
            if form == RING:
                assert len(rows) == 1


def test_a_sphere_in_place_of_a_wheel_is_wrong_on_a_cross_slope():
    """The wheel's ring leans away from the slope's normal; a ball of the wheel's radius does not know."""
    terrain = Terrain.slope(20.0, 90.0)
    center = np.array([0.0, 0.0, 0.3])
    wheel = contacts(terrain, (RING, center, np.array([0.0, 1.0, 0.0]), 0.12, 0.03))[0]
    ball = contacts(terrain, (RING, center, np.array([0.0, 1.0, 0.0]), 0.0, 0.15))[0]
    cos = math.cos(math.radians(20.0))
    assert wheel[0] == pytest.approx(0.3 * cos - 0.12 * cos - 0.03, abs=1e-12)
    assert wheel[0] - ball[0] == pytest.approx(0.12 * (1 - cos), abs=1e-12)
    assert abs(wheel[0] - ball[0]) > 5e-3


def test_shapes_that_touch_all_along_stand_on_their_quarters_or_ends():
    flat = Terrain.flat()
    lying = contacts(flat, (RING, np.array([0, 0, 0.03]), np.array([0.0, 0.0, 1.0]), 0.1, 0.03))
    assert len(lying) == 4
    assert lying[:, 0] == pytest.approx(0.0, abs=1e-15)
    assert np.ptp(lying[:, 1]) == pytest.approx(0.2)
    rod = contacts(flat, (SEGMENT, np.array([0, 0, 0.03]), np.array([0.0, 1.0, 0.0]), 0.1, 0.03))
    assert sorted(rod[:, 2]) == pytest.approx([-0.1, 0.1])
    assert len(contacts(flat, (RING, np.array([0, 0, 0.13]), np.array([0.0, 1.0, 0.0]), 0.1, 0.03))) == 1


@pytest.mark.parametrize("interpolation", ["smooth", "linear"])
def test_lying_on_a_flat_grid_is_finite(interpolation):
    terrain = Terrain.from_grid(np.zeros((40, 40)), 0.05, interpolation=interpolation)
    for form in (RING, SEGMENT):
        for axis in ([0.0, 0.0, 1.0], [0.0, 1.0, 0.0]):
            rows = contacts(terrain, (form, np.array([1.0, 1.0, 0.03]), np.array(axis), 0.1, 0.03))
            assert 1 <= len(rows) <= 8
            assert np.isfinite(rows).all()
