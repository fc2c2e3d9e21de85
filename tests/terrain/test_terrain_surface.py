"""The surface of grids: nodes, derivatives, other interpolators, borders."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.interpolate import RegularGridInterpolator
from scipy.ndimage import map_coordinates

from rover_pin.terrain import LINEAR, SMOOTH, Terrain, surface

SPACING = 0.1
ORIGIN = (-1.3, 2.1)
Z = np.random.default_rng(5).normal(size=(23, 31))
MAPS = {name: Terrain.from_grid(Z, SPACING, ORIGIN, name) for name in ("smooth", "linear")}


def at(terrain, x, y):
    return np.array(surface(terrain.kind, terrain.table, terrain.params, x, y))


def inside(n, seed=0):
    rng = np.random.default_rng(seed)
    xmin, xmax, ymin, ymax = MAPS["smooth"].extent
    return rng.uniform(xmin, xmax, n), rng.uniform(ymin, ymax, n)


@pytest.mark.parametrize("name", ["smooth", "linear"])
def test_every_node_is_reproduced_to_the_border(name):
    terrain = MAPS[name]
    x, y = terrain.nodes
    assert (y.size, x.size) == Z.shape
    np.testing.assert_allclose(terrain.height(x[None, :], y[:, None]), Z, atol=1e-13)


@pytest.mark.parametrize("shape", [(3, 3), (3, 4), (5, 3)])
def test_the_smallest_maps_reproduce_their_nodes(shape):
    z = np.arange(float(np.prod(shape))).reshape(shape) ** 1.5
    terrain = Terrain.from_grid(z, 2.0)
    i, j = np.indices(shape)
    np.testing.assert_allclose(terrain.height(2.0 * j, 2.0 * i), z, atol=1e-12)


def test_smooth_is_scipys_mirrored_quadratic_spline():
    x, y = inside(3000)
    where = [(y - ORIGIN[1]) / SPACING, (x - ORIGIN[0]) / SPACING]
    expected = map_coordinates(Z, where, order=2, mode="mirror")
    np.testing.assert_allclose(MAPS["smooth"].height(x, y), expected, atol=1e-11)


def test_linear_is_scipys_grid_interpolator():
    x, y = inside(3000)
    terrain = MAPS["linear"]
    nodes_x, nodes_y = terrain.nodes
    points = np.clip(np.column_stack([y, x]), [nodes_y[0], nodes_x[0]], [nodes_y[-1], nodes_x[-1]])
    expected = RegularGridInterpolator((nodes_y, nodes_x), Z)(points)
    np.testing.assert_allclose(terrain.height(x, y), expected, atol=1e-12)


@settings(max_examples=150, deadline=None, derandomize=True)
@given(name=st.sampled_from(["smooth", "linear"]), u=st.floats(0.0, 30.0), v=st.floats(0.0, 22.0))
def test_derivatives_are_those_of_the_height(name, u, v):
    terrain, e = MAPS[name], 1e-4
    step = e * SPACING
    shift = 0.5 if name == "smooth" else 0.0
    for w in (u, v):  # away from the seams of the pieces, where second derivatives jump
        assume(abs((w + shift) % 1.0 - 0.5) < 0.5 - 2.0 * e)
    assume(2.0 * e < u < 30.0 - 2.0 * e and 2.0 * e < v < 22.0 - 2.0 * e)
    x, y = ORIGIN[0] + u * SPACING, ORIGIN[1] + v * SPACING
    values = at(terrain, x, y)
    along_x = (at(terrain, x + step, y) - at(terrain, x - step, y)) / (2.0 * step)
    along_y = (at(terrain, x, y + step) - at(terrain, x, y - step)) / (2.0 * step)
    np.testing.assert_allclose(values[1:3], [along_x[0], along_y[0]], atol=2e-5)
    np.testing.assert_allclose(values[3:], [along_x[1], along_x[2], along_y[2]], atol=2e-3)
    assert values[4] == pytest.approx(along_y[1], abs=2e-3)


def test_smooth_gradient_is_continuous_across_the_seams():
    terrain = MAPS["smooth"]
    x = ORIGIN[0] + (np.arange(30) + 0.5) * SPACING
    y = np.full(30, ORIGIN[1] + 0.77)
    jump = terrain.gradient(x + 1e-10, y) - terrain.gradient(x - 1e-10, y)
    assert np.abs(jump).max() < 1e-5


@pytest.mark.parametrize("name", ["smooth", "linear"])
def test_outside_the_border_goes_on_level(name):
    terrain = MAPS[name]
    xmin, xmax, ymin, ymax = terrain.extent
    out, edge = at(terrain, xmin - 3.0, 2.5), at(terrain, xmin, 2.5)
    assert out[0] == edge[0]
    assert out[1] == out[3] == out[4] == 0.0
    assert out[2] == edge[2]
    assert terrain.height(xmax + 9.0, ymax + 9.0) == pytest.approx(Z[-1, -1], abs=1e-13)
    assert at(terrain, -math.inf, math.inf)[0] == pytest.approx(Z[-1, 0], abs=1e-13)
    np.testing.assert_array_equal(terrain.gradient(xmax + 1.0, ymin - 1.0), [0.0, 0.0])


def test_smooth_meets_its_border_without_a_crease():
    terrain = MAPS["smooth"]
    xmin, xmax, _, _ = terrain.extent
    slopes = terrain.gradient([xmin, xmax], [2.57, 2.57])
    np.testing.assert_allclose(slopes[:, 0], 0.0, atol=1e-12)


def test_a_point_that_is_no_number_has_no_height():
    for terrain in (*MAPS.values(), Terrain.flat(), Terrain.from_function(lambda x, y: x + y)):
        assert np.isnan(at(terrain, math.nan, 0.0)).all()
        assert not terrain.covers(math.nan, 0.0)


def test_queries_broadcast_and_normals_stand_on_the_surface():
    terrain = MAPS["smooth"]
    x, y = np.linspace(-1.0, 1.0, 5)[None, :], np.linspace(2.2, 4.0, 4)[:, None]
    assert terrain.height(x, y).shape == (4, 5)
    assert terrain.gradient(x, y).shape == (4, 5, 2)
    assert terrain.height(0.0, 3.0).shape == ()
    assert terrain.normal(0.0, 3.0).shape == (3,)
    normal, slope = terrain.normal(x, y), terrain.gradient(x, y)
    np.testing.assert_allclose(np.linalg.norm(normal, axis=-1), 1.0, rtol=1e-15)
    np.testing.assert_allclose(normal[..., :2] / normal[..., 2:], -slope, rtol=1e-12)
    assert terrain.height([], []).shape == (0,)


def test_the_map_covers_its_border_and_nothing_beyond():
    terrain = Terrain.from_grid(np.zeros((4, 6)), 0.5, (1.0, -2.0))
    assert terrain.extent == (1.0, 3.5, -2.0, -0.5)
    np.testing.assert_array_equal(
        terrain.covers([1.0, 3.5, 0.999, 2.0, 2.0], [-2.0, -0.5, -1.0, -0.49, -1.0]), [1, 1, 0, 0, 1]
    )


@pytest.mark.parametrize(
    "make", [lambda: MAPS["smooth"], lambda: MAPS["linear"], lambda: Terrain.slope(12.0)]
)
def test_blended_is_a_straight_line_from_level_ground(make):
    terrain = make()
    x, y = inside(50)
    for s in (0.0, 0.3, 1.0):
        mixed = terrain.blended(0.7, s)
        np.testing.assert_allclose(mixed.height(x, y), 0.7 + s * (terrain.height(x, y) - 0.7), atol=1e-14)
        np.testing.assert_allclose(mixed.gradient(x, y), s * terrain.gradient(x, y), atol=1e-12)
        assert mixed.table is terrain.table
    twice = terrain.blended(0.7, 0.5).blended(0.7, 0.5)
    np.testing.assert_allclose(twice.height(x, y), terrain.blended(0.7, 0.25).height(x, y), atol=1e-14)


def test_arrays_cannot_be_written():
    for terrain in (*MAPS.values(), Terrain.flat(), Terrain.step(0.1)):
        for array in (terrain.table, terrain.params):
            assert array.dtype == np.float64
            assert array.flags.c_contiguous
            with pytest.raises(ValueError, match="read-only"):
                array[0] = 1.0
    z = np.zeros((3, 3))
    terrain = Terrain.from_grid(z, 1.0, interpolation="linear")
    z[:] = 9.0
    assert terrain.height(1.0, 1.0) == 0.0


def test_kinds_and_figures():
    assert MAPS["smooth"].kind == SMOOTH
    assert MAPS["linear"].kind == LINEAR
    summary = Terrain.from_grid([[0.0, 1.0], [0.0, 1.0]], 1.0, interpolation="linear").summary()
    assert summary.slope_max_deg == pytest.approx(45.0)
    assert (summary.lowest_m, summary.highest_m, summary.mean_m, summary.rms_m) == (0.0, 1.0, 0.5, 0.5)
    figures = MAPS["smooth"].summary().as_dict()
    assert figures["shape"] == Z.shape
    assert figures["rms_m"] == pytest.approx(Z.std())
    assert figures["highest_m"] == pytest.approx(Z.max())
