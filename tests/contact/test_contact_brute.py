"""The search against brute force on rough maps of every spacing, wheels leaning and turned."""

import numpy as np
import pytest
from contact_oracle import brute, contacts, heights, lowered, rough_map, wheel_axis

MAPS = [(0.25, 60, 0.2), (0.094, 100, 0.08), (0.05, 160, 0.05), (0.02, 200, 0.025), (0.01, 300, 0.02)]
SHAPES = [(0, 0.11, 0.04), (0, 0.05, 0.03), (0, 0.115, 0.005), (0, 0.0, 0.1), (0, 0.0, 0.02), (1, 0.12, 0.05)]


@pytest.mark.parametrize("interpolation", ["smooth", "linear"])
@pytest.mark.parametrize(("spacing", "n", "rms"), MAPS)
def test_gap_on_rough_maps(spacing, n, rms, interpolation):
    terrain = rough_map(n, spacing, rms, 3, interpolation)
    rng = np.random.default_rng(int(1000 * spacing))
    wrong = 0
    for k in range(18):
        form, ring, tread = SHAPES[k % len(SHAPES)]
        x, y = rng.uniform(0.3 * n * spacing, 0.7 * n * spacing, 2)
        axis = wheel_axis(rng.uniform(-3, 3), rng.normal() * 0.2)
        shape = lowered(terrain, (form, [x, y, heights(terrain, x, y)[0] + ring + tread], axis, ring, tread))
        shape[1][2] += tread * rng.uniform(-0.4, 0.5)
        row = contacts(terrain, shape)[0]
        best, _ = brute(terrain, shape)
        assert abs(row[0] - best) < 1e-4
        wrong += abs(row[0] - best) > 1e-9 + (1e-8 if interpolation == "linear" else 0.0)
        assert heights(terrain, row[1], row[2])[0] == pytest.approx(row[3], abs=1e-12)
        assert np.linalg.norm(row[4:]) == pytest.approx(1.0, abs=1e-12)
        assert row[6] > 0.0
    assert wrong <= 1


@pytest.mark.parametrize("spacing", [0.02, 0.094])
def test_derivative_of_the_gap_is_the_normal(spacing):
    """d gap / d centre = n, and d gap / d axis = n times the lever, by central differences."""
    terrain = rough_map(150, spacing, 0.6 * spacing, 5)
    rng = np.random.default_rng(2)
    e = 1e-6
    for form, ring, tread in SHAPES:
        for _ in range(4):
            x, y = rng.uniform(0.4 * 150 * spacing, 0.6 * 150 * spacing, 2)
            axis = wheel_axis(rng.uniform(-3, 3), rng.normal() * 0.15)
            shape = lowered(terrain, (form, [x, y, heights(terrain, x, y)[0] + 0.2], axis, ring, tread))
            row = contacts(terrain, shape)[0]
            for lift in (0.0, 0.3 * tread, -0.3 * tread):
                at = shape[1] + [0, 0, lift]
                row = contacts(terrain, (form, at, axis, ring, tread))[0]
                for i in range(3):
                    step = e * np.eye(3)[i]
                    up = contacts(terrain, (form, at + step, axis, ring, tread))[0]
                    down = contacts(terrain, (form, at - step, axis, ring, tread))[0]
                    assert (up[0] - down[0]) / (2 * e) == pytest.approx(row[4 + i], abs=2e-4)


def test_gap_falls_steadily_into_the_ground():
    """A wheel pushed down 12 cm: gap finite and falling all the way, normal upward."""
    for interpolation in ("smooth", "linear"):
        terrain = rough_map(100, 0.05, 0.02, 7, interpolation)
        for ring, tread in [(0.09, 0.03), (0.12, 0.0), (0.0, 0.1), (0.0, 0.0)]:
            shape = lowered(terrain, (0, [2.4, 2.6, 0.3], wheel_axis(0.4, 0.1), ring, tread))
            gaps = []
            for depth in np.linspace(-0.2, 0.12, 65):
                rows = contacts(terrain, (0, shape[1] - [0, 0, depth], shape[2], ring, tread))
                assert np.isfinite(rows).all()
                assert (rows[:, 6] > 0).all()
                gaps.append(rows[0, 0])
            assert (np.diff(gaps) < 0).all()
            assert gaps[-1] < -0.05
