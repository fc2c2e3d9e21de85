"""Terrains that are Python functions."""

import copy
import math
import multiprocessing
import pickle

import numba
import numpy as np
import pytest

from rover_pin.errors import TerrainError
from rover_pin.terrain import CALLABLE, Terrain, surface


def waves(x, y):
    return 0.1 * np.sin(2.0 * x) * np.cos(3.0 * y) + 0.05 * x


def waves_gradient(x, y):
    return 0.2 * np.cos(2.0 * x) * np.cos(3.0 * y) + 0.05, -0.3 * np.sin(2.0 * x) * np.sin(3.0 * y)


def waves_of_floats(x, y):
    if x > 1e9:
        return 0.0
    return 0.1 * math.sin(2.0 * x) * math.cos(3.0 * y) + 0.05 * x


def waves_of_arrays(x, y):
    z = np.empty(x.shape)
    z[:] = waves(x, y)
    return z


def exact(x, y):
    s, c, sy, cy = math.sin(2 * x), math.cos(2 * x), math.sin(3 * y), math.cos(3 * y)
    return [
        0.1 * s * cy + 0.05 * x,
        0.2 * c * cy + 0.05,
        -0.3 * s * sy,
        -0.4 * s * cy,
        -0.6 * c * sy,
        -0.9 * s * cy,
    ]


def at(terrain, x, y):
    return np.array(surface(terrain.kind, terrain.table, terrain.params, x, y))


POINTS = [(0.3, 0.7), (-12.0, 5.0), (1.0, -1.0), (1.99999, 0.0), (-2.0, 2.0)]


@pytest.mark.parametrize("height", [waves, waves_of_floats, waves_of_arrays])
@pytest.mark.parametrize("gradient", [None, waves_gradient])
@pytest.mark.parametrize("extent", [None, (-2.0, 2.0, -2.0, 2.0)])
def test_height_is_the_functions_and_derivatives_are_close(height, gradient, extent):
    terrain = Terrain.from_function(height, gradient, extent)
    assert terrain.kind == CALLABLE
    for x, y in POINTS:
        if not terrain.covers(x, y):
            continue
        values = at(terrain, x, y)
        wanted = exact(x, y)
        assert values[0] == pytest.approx(wanted[0], abs=1e-15)
        tight = 1e-9 if extent is None else 1e-7  # by the border derivatives are carried over 0.1 mm
        np.testing.assert_allclose(values[1:3], wanted[1:3], atol=tight)
        np.testing.assert_allclose(values[3:], wanted[3:], atol=1e-3)
        assert terrain.height(x, y) == pytest.approx(wanted[0], abs=1e-15)
        np.testing.assert_allclose(terrain.gradient(x, y), wanted[1:3], atol=tight)


def test_gradient_may_take_floats_only():
    terrain = Terrain.from_function(waves, lambda x, y: (0.0 if x > 99 else 0.05, float(y)))
    np.testing.assert_allclose(terrain.gradient([1.0, 2.0], 3.0), [[0.05, 3.0], [0.05, 3.0]])


def test_outside_its_extent_a_function_is_not_called():
    def root(x, y):
        assert np.min(x) >= 0.0
        return np.sqrt(x)

    terrain = Terrain.from_function(root, None, (0.0, 4.0, -1.0, 1.0))
    np.testing.assert_allclose(terrain.height([-3.0, 9.0], [0.0, 5.0]), [0.0, 2.0])
    assert at(terrain, 9.0, 5.0)[1:].tolist() == [0.0] * 5
    assert at(terrain, -1.0, 0.0)[0] == 0.0
    assert at(terrain, 2.25, 0.0)[1] == pytest.approx(1.0 / 3.0, abs=1e-9)


def test_a_constant_of_floats_and_a_compiled_function_work():
    assert Terrain.from_function(lambda x, y: 0.25).height([1.0, 2.0], 3.0).tolist() == [0.25, 0.25]
    compiled = numba.njit(lambda x, y: 0.1 * x * y)
    assert Terrain.from_function(compiled).height([1.0, 2.0], 3.0) == pytest.approx([0.3, 0.6])


def test_compiled_loops_reach_the_function():
    @numba.njit
    def total(kind, table, params, n):
        return sum([surface(kind, table, params, 0.1 * i, 0.0)[0] for i in range(n)])

    terrain = Terrain.from_function(waves)
    x = 0.1 * np.arange(10)
    assert total(terrain.kind, terrain.table, terrain.params, 10) == pytest.approx(waves(x, 0.0).sum())


def test_blended_function():
    terrain = Terrain.from_function(waves).blended(1.0, 0.5)
    assert at(terrain, 0.3, 0.7)[0] == pytest.approx(0.5 + 0.5 * waves(0.3, 0.7))
    assert terrain.height(0.3, 0.7) == pytest.approx(0.5 + 0.5 * waves(0.3, 0.7))
    assert terrain.gradient(0.3, 0.7)[0] == pytest.approx(0.5 * exact(0.3, 0.7)[1])


@pytest.mark.parametrize(
    ("f", "message"),
    [
        (lambda x, y: np.log(x), "the terrain's function gives values that are not finite (got"),
        (
            lambda x, y: np.array([1.0, 2.0]),
            "the terrain's function fails (got 'ValueError: an array of shape (2,)",
        ),
        (lambda x: x, "positional argument"),
        (lambda x, y: "high", "the terrain's function fails"),
        (lambda x, y: None, "the terrain's function fails"),
        (lambda x, y: x / 0 if np.ndim(x) == 0 else 1 / 0, "ZeroDivisionError"),
        (lambda x, y: x - np.max(x), "gives one value for an array and another for its elements"),
        (3.0, "the terrain's function cannot be called (got 'float')"),
    ],
)
def test_a_bad_function_is_refused_when_tried(f, message):
    with pytest.raises(TerrainError) as caught:
        Terrain.from_function(f)
    assert message in str(caught.value)


def test_a_bad_gradient_extent_or_spacing_is_refused():
    with pytest.raises(TerrainError, match="the terrain's gradient fails"):
        Terrain.from_function(waves, lambda x, y: x)
    with pytest.raises(TerrainError, match="the terrain's gradient cannot be called"):
        Terrain.from_function(waves, 2.0)
    with pytest.raises(TerrainError, match="the extent is empty"):
        Terrain.from_function(waves, extent=(1, 0, 0, 1))
    with pytest.raises(TerrainError, match="the extent is not four numbers"):
        Terrain.from_function(waves, extent=(1, 0))
    with pytest.raises(TerrainError, match="the spacing must be positive"):
        Terrain.from_function(waves, spacing=-1)


def test_a_hole_met_later_is_an_error_not_a_nan():
    terrain = Terrain.from_function(lambda x, y: np.where(np.abs(x - 90.0) < 1.0, np.nan, 0.0 * y))
    with pytest.raises(TerrainError, match=r"not finite .* at x = 90.0, y = 0.0"):
        at(terrain, 90.0, 0.0)
    with pytest.raises(TerrainError, match=r"not finite .* at x = 90.0, y = 2.0"):
        terrain.height([0.0, 90.0], 2.0)


def test_parameters_without_their_terrain_are_an_error():
    terrain = Terrain.from_function(lambda x, y: x)
    kind, table, params = terrain.kind, terrain.table, terrain.params
    del terrain
    with pytest.raises(TerrainError, match="the terrain's function is gone"):
        surface(kind, table, params, 0.0, 0.0)


def height_there(terrain):
    return terrain.params[2], at(terrain, 0.3, 0.7), terrain.height(0.3, 0.7), terrain.digest


def test_a_function_is_registered_anew_in_a_spawned_process():
    terrain = Terrain.from_function(waves, waves_gradient, (-2.0, 2.0, -2.0, 2.0))
    again = pickle.loads(pickle.dumps(terrain))
    assert again.params[2] != terrain.params[2]
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        _, values, height, digest = pool.apply(height_there, (terrain.blended(1.0, 0.5),))
    here = height_there(terrain.blended(1.0, 0.5))
    np.testing.assert_array_equal(values, here[1])
    assert height == here[2]
    assert digest == here[3]


def test_a_function_that_cannot_be_pickled_says_so():
    terrain = Terrain.from_function(lambda x, y: x + y)
    with pytest.raises(TerrainError, match=r"cannot be sent to another process .*define it with def"):
        pickle.dumps(terrain)
    assert copy.deepcopy(terrain).height(1.0, 2.0) == 3.0
    assert copy.copy(terrain).height(1.0, 2.0) == 3.0


@pytest.mark.parametrize("word", ["flat", "slope:7", "step:0.1,0", "rough:1,0.05,0.8"])
def test_other_terrains_pickle_whole_and_read_only(word):
    terrain = Terrain.parse(word)
    again = pickle.loads(pickle.dumps(terrain))
    assert type(again) is Terrain
    assert again.digest == terrain.digest
    assert (again.label, again.extent, again.spacing) == (terrain.label, terrain.extent, terrain.spacing)
    assert not again.table.flags.writeable
    assert not again.params.flags.writeable
