"""Rough ground keeps what it states: rms, mean, seed, spectrum, shortest wave."""

import numpy as np
import pytest

from rover_pin.errors import TerrainError
from rover_pin.terrain import Terrain


def nodes_of(terrain):
    x, y = terrain.nodes
    return terrain.height(x[None, :], y[:, None])


def radial_spectrum(heights, spacing):
    n = heights.shape[0]
    power = np.abs(np.fft.fft2(heights)) ** 2
    k = np.hypot(*np.meshgrid(np.fft.fftfreq(n, spacing), np.fft.fftfreq(n, spacing)))
    return k.ravel(), power.ravel()


@pytest.mark.parametrize("hurst", [0.3, 0.8, 1.0])
def test_the_power_falls_by_the_stated_law(hurst):
    terrain = Terrain.rough(11, 0.05, hurst, size=20.0, spacing=0.05)
    k, power = radial_spectrum(nodes_of(terrain), 0.05)
    band = (k > 4.0 / 20.0) & (k < 0.9 / 0.2)
    edges = np.geomspace(k[band].min(), k[band].max(), 16)
    which = np.digitize(k[band], edges)
    mean_k = [np.log(k[band][which == b]).mean() for b in range(1, 16)]
    mean_p = [np.log(power[band][which == b].mean()) for b in range(1, 16)]
    slope = np.polyfit(mean_k, mean_p, 1)[0]
    assert slope == pytest.approx(-(2.0 * hurst + 2.0), abs=0.1)


@pytest.mark.parametrize("shortest", [None, 0.5, 1.0])
def test_no_wave_is_shorter_than_stated(shortest):
    terrain = Terrain.rough(2, 0.1, 0.5, size=10.0, spacing=0.1, shortest=shortest)
    k, power = radial_spectrum(nodes_of(terrain), 0.1)
    limit = 1.0 / (0.4 if shortest is None else shortest)
    assert power[k > limit * 1.000001].sum() < 1e-20 * power.sum()
    assert power[(k > 0.8 * limit) & (k <= limit)].sum() > 0.0


def test_mean_and_rms_are_exact_and_the_map_is_centred():
    terrain = Terrain.rough(4, 0.07, 0.8, size=6.0, spacing=0.1)
    heights = nodes_of(terrain)
    assert heights.shape == (61, 61)
    assert heights.mean() == pytest.approx(0.0, abs=1e-15)
    assert heights.std() == pytest.approx(0.07, rel=1e-12)
    assert terrain.extent == pytest.approx((-3.0, 3.0, -3.0, 3.0))
    assert np.abs(nodes_of(Terrain.rough(4, 0.0, 0.8, size=6.0))).max() == 0.0


def test_the_seed_decides_every_bit():
    make = [Terrain.rough(seed, 0.05, 0.8, size=5.0) for seed in (7, 7, 8)]
    assert make[0].table.tobytes() == make[1].table.tobytes()
    assert make[0].digest == make[1].digest != make[2].digest


@pytest.mark.parametrize(
    ("numbers", "message"),
    [
        ({"spacing": 0.0}, "the spacing must be positive (got 0.0)"),
        ({"size": -1.0}, "the size must be positive (got -1.0)"),
        (
            {"shortest": 0.05},
            "the shortest wave does not fit the map (got 0.05); between two spacings (0.1 m)",
        ),
        ({"size": 0.1}, "the shortest wave does not fit the map"),
        ({"seed": 1.5}, "the seed must be a whole number, 0 or more (got 1.5)"),
        ({"seed": "x"}, "the seed must be a whole number, 0 or more (got 'x')"),
        ({"size": 1e6}, "the map would be too large"),
    ],
)
def test_numbers_out_of_range(numbers, message):
    with pytest.raises(TerrainError) as caught:
        Terrain.rough(**{"seed": 1, "rms": 0.05, "hurst": 0.8, **numbers})
    assert message in str(caught.value)
