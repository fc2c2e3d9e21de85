"""Measured height maps, where they are at hand (ROVER_PIN_DATA, or shared/data beside the repository)."""

import os
from pathlib import Path

import numpy as np
import pytest
import tifffile

from rover_pin.terrain import Terrain

DATA = Path(os.environ.get("ROVER_PIN_DATA", Path(__file__).parents[3] / "shared" / "data")) / "terrain"


@pytest.mark.parametrize(("name", "spacing"), [("marsyard2021.tif", 0.094), ("marsyard2022.tif", 0.1945525)])
@pytest.mark.parametrize("interpolation", ["smooth", "linear"])
def test_a_measured_map_is_read_as_it_lies(name, spacing, interpolation):
    path = DATA / name
    if not path.exists():
        pytest.skip(f"{path} is not here")
    z = tifffile.imread(path).astype(np.float64)
    terrain = Terrain.from_file(path, spacing, interpolation=interpolation)
    i, j = np.indices(z.shape)
    np.testing.assert_allclose(terrain.height(spacing * j, spacing * i), z, atol=1e-9)
    rows, columns = z.shape
    assert terrain.extent == pytest.approx((0.0, (columns - 1) * spacing, 0.0, (rows - 1) * spacing))
    assert terrain.covers(12.0, 9.5)
    assert Terrain.from_file(path).spacing == pytest.approx(spacing, rel=1e-6)
    summary = terrain.summary()
    assert summary.highest_m == pytest.approx(z.max())
    assert 10.0 < summary.slope_mean_deg < 20.0
