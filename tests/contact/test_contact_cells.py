"""The thorough look on bilinear maps misses no cell: a hunt against a dense look that holds all nodes."""

import numpy as np
import pytest
from contact_oracle import brute, contacts, dense, heights, is_minimum, lowered, wheel_axis

from rover_pin.terrain import Terrain

MAPS = [(0.25, 60, 0.2), (0.094, 100, 0.08), (0.05, 160, 0.11), (0.02, 200, 0.025), (0.01, 300, 0.02)]
SHAPES = [
    (0, 0.11, 0.04),
    (0, 0.05, 0.03),
    (0, 0.115, 0.005),
    (0, 0.0, 0.1),
    (1, 0.12, 0.05),
    (0, 0.21, 0.04),
]


def jagged(n, spacing, rms, seed):
    """A seeded map with waves down to the spacing: every node sticks out a little."""
    rng = np.random.default_rng(seed)
    k = np.hypot(*np.meshgrid(np.fft.fftfreq(n, spacing), np.fft.fftfreq(n, spacing)))
    k[0, 0] = np.inf
    z = np.fft.ifft2(np.fft.fft2(rng.normal(size=(n, n))) * k**-1.45).real
    return Terrain.from_grid(z / z.std() * rms, spacing, interpolation="linear")


def touching(terrain, rng, form, ring, tread):
    """A shape somewhere on the map, leaning, a little above its contact or a little in the ground."""
    last = terrain.spacing * (terrain.table.shape[0] - 1)
    x, y = terrain.params[2:4] + rng.uniform(0.3, 0.7, 2) * last
    axis = wheel_axis(rng.uniform(-3, 3), rng.normal() * 0.2)
    high = [x, y, heights(terrain, x, y)[0] + ring + tread + 0.1]
    shape = lowered(terrain, (form, high, axis, ring, tread))
    shape[1][2] += tread * rng.uniform(-0.2, 0.2)
    return shape


@pytest.mark.parametrize("window", [1e-10, 1e-5])
@pytest.mark.parametrize(("spacing", "n", "rms"), MAPS)
def test_hunt(spacing, n, rms, window):
    terrain = jagged(n, spacing, rms, 3)
    rng = np.random.default_rng(int(1e4 * spacing))
    for k in range(48):
        shape = touching(terrain, rng, *SHAPES[k % len(SHAPES)])
        rows = contacts(terrain, shape, window)
        best = dense(terrain, shape)
        assert rows[0, 0] < best + 1e-10
        assert rows[0, 0] == pytest.approx(best, abs=1e-7)
        assert all(is_minimum(terrain, shape, x, y) for x, y in rows[:, 1:3])
        assert heights(terrain, rows[:, 1], rows[:, 2]) == pytest.approx(rows[:, 3], abs=1e-12)


def test_shapes_small_beside_a_cell():
    """Cells up to 2 m wide under shapes of centimetres: several minima in one cell."""
    rng = np.random.default_rng(4)
    for spacing in (0.5, 2.0):
        terrain = jagged(30, spacing, 0.5 * spacing, 6)
        for form, ring, tread in [(0, 0.06, 0.01), (0, 0.0, 0.02), (1, 0.1, 0.02), (0, 0.12, 0.03)]:
            shape = touching(terrain, rng, form, ring, tread)
            assert contacts(terrain, shape, 1e-5)[0, 0] == pytest.approx(brute(terrain, shape)[0], abs=1e-7)


def test_a_spike_beside_the_wheel():
    """A single node stands up under the tread's flank, between all the places a coarse look samples."""
    heights_of = np.zeros((81, 81))
    heights_of[40, 43] = 0.03
    terrain = Terrain.from_grid(heights_of, 0.01, interpolation="linear")
    spike = np.array([terrain.params[2] + 0.43, terrain.params[3] + 0.40, 0.03])
    axis = wheel_axis(0.3, 0.0)
    ring, tread = 0.11, 0.04
    for along in np.linspace(-0.12, 0.12, 41):
        center = np.array([spike[0] - along, spike[1] - 0.02, ring + tread + 0.001])
        away = spike - center
        out = away @ axis
        far = np.hypot(out, np.linalg.norm(away - out * axis) - ring) - tread
        got = contacts(terrain, (0, center, axis, ring, tread), 1e-5)[0, 0]
        assert got <= min(far, 0.001) + 1e-12
