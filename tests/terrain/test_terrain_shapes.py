"""Flat, slope, step and the words of the command line."""

import math

import numpy as np
import pytest

from rover_pin.errors import TerrainError
from rover_pin.terrain import PLANE, Terrain


def test_flat_is_level_everywhere():
    ground = Terrain.flat(1.5)
    assert ground.kind == PLANE
    assert ground.height(1e6, -1e6) == 1.5
    np.testing.assert_array_equal(ground.normal([0.0, 1.0], [2.0, 3.0]), [[0, 0, 1], [0, 0, 1]])
    assert ground.extent == (-math.inf, math.inf, -math.inf, math.inf)
    assert not ground.bounded
    assert ground.nodes is None


@pytest.mark.parametrize("heading", [0.0, 90.0, 200.0])
def test_slope_rises_along_its_heading(heading):
    ground = Terrain.slope(20.0, heading)
    along = np.array([math.cos(math.radians(heading)), math.sin(math.radians(heading))])
    assert ground.height(*(3.0 * along)) == pytest.approx(3.0 * math.tan(math.radians(20.0)))
    assert ground.height(-along[1], along[0]) == pytest.approx(0.0, abs=1e-15)
    assert math.degrees(math.acos(ground.normal(0.0, 0.0)[2])) == pytest.approx(20.0)


def test_step_is_a_ramp_one_spacing_long_that_ends_at_x():
    ground = Terrain.step(0.2, 1.5, 0.1)
    x = np.array([-50.0, 1.3999, 1.45, 1.4999, 1.5001, 80.0])
    np.testing.assert_allclose(ground.height(x, 7.0), [0.0, 0.0, 0.1, 0.1998, 0.2, 0.2], atol=1e-14)
    np.testing.assert_allclose(ground.gradient(x, -900.0)[:, 0], [0.0, 0.0, 2.0, 2.0, 0.0, 0.0], atol=1e-12)
    assert ground.covers(1e9, -1e9)
    assert ground.height(1.45, 1e5) == pytest.approx(0.1)
    assert Terrain.step(-0.2, 0.0).height(0.0, 0.0) == -0.2


def test_words_make_the_same_terrains_as_python():
    assert Terrain.parse("flat").digest == Terrain.flat().digest
    assert Terrain.parse("slope:12.5").digest == Terrain.slope(12.5).digest
    assert Terrain.parse("step:0.1,-2", spacing=0.02).digest == Terrain.step(0.1, -2.0, 0.02).digest
    rough = Terrain.parse("rough:3,0.05,0.7", spacing=0.2, interpolation="linear")
    assert rough.digest == Terrain.rough(3, 0.05, 0.7, spacing=0.2, interpolation="linear").digest
    for word in ("flat", "slope:12.5", "step:0.1,-2", "rough:3,0.05,0.7"):
        assert Terrain.parse(word).label == word


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("flatt", "did you mean 'flat'?"),
        ("slope", "terrain 'slope' takes 1 number (got 'slope'); write slope:DEG"),
        ("flat:2", "terrain 'flat' takes no numbers"),
        ("slope:steep", "DEG is not a number (got 'slope:steep'); write slope:DEG"),
        ("step:0.1", "write step:HEIGHT,X"),
        ("rough:1.5,0.1,0.8", "SEED is not a whole number"),
        ("rough:-1,0.1,0.8", "the seed must be a whole number, 0 or more (got -1)"),
        ("rough:nan,0.1,0.8", "SEED is not a whole number"),
        ("rough:1,-0.1,0.8", "the rms must not be negative (got -0.1)"),
        ("rough:1,0.1,1.8", "the Hurst exponent must be between 0 and 1 (got 1.8)"),
        ("slope:90", "a slope must be between -90 and 90 deg (got 90.0)"),
        ("slope:nan", "the slope is not finite (got nan)"),
        ("yard.tif", "yard.tif: no such file"),
        ("maps/yard", "maps/yard: no such file"),
        ("", "not a terrain"),
    ],
)
def test_bad_words_say_the_cure(text, message):
    with pytest.raises(TerrainError) as caught:
        Terrain.parse(text)
    assert message in str(caught.value)


def test_room_for_a_rover():
    Terrain.flat().require_room(5.0, "rocker_bogie")
    with pytest.raises(TerrainError, match=r"yard: the map of 0\.4 x 0\.2 m is too small for rover"):
        Terrain.from_grid(np.zeros((3, 5)), 0.1, label="yard").require_room(0.9, "rover")
