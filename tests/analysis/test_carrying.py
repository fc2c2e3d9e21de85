"""Wheels in contact, load spread and tensions in a study's result."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from rows_double import LAYOUT

from rover_pin.analysis import Study
from rover_pin.analysis.carrying import load_spread, touching
from rover_pin.analysis.cases import Cases
from rover_pin.analysis.dataset import read
from rover_pin.analysis.figures import figures_of, layout_of
from rover_pin.analysis.found import found_in
from rover_pin.analysis.rows import Layout, Rows
from rover_pin.analysis.schema import Block, schema
from rover_pin.analysis.summary import figure_spreads

BOGIE = Path(__file__).parents[1] / "fixtures" / "bogie_min"
ROUGH = {"rough": {"seed": 1, "rms": 0.06, "hurst": 0.8, "size": 8}}


def test_counted_and_spread_by_hand() -> None:
    loads = np.array([[1.0, 3.0, 0.0, 9e-4], [2.0, 2.0, 2.0, 2.0], [np.nan] * 4, [0.0] * 4])
    np.testing.assert_array_equal(touching(loads), [2.0, 4.0, np.nan, 0.0])
    spread = load_spread(loads)
    assert spread[0] == pytest.approx(np.std(loads[0]) / np.mean(loads[0]))
    np.testing.assert_array_equal(spread[1:], [0.0, np.nan, np.nan])
    assert np.isnan(load_spread(loads[:, []])).all()


@pytest.fixture(scope="module")
def data(tmp_path_factory: pytest.TempPathFactory) -> xr.Dataset:
    folder = tmp_path_factory.mktemp("bogie")
    sidecar = folder / "rover.yaml"
    sidecar.write_text((BOGIE / "rover.yaml").read_text().replace("free: true", "auxiliary: true"))
    urdf = next(BOGIE.glob("*.urdf"))
    asked = Study(urdf, ROUGH, sidecar=str(sidecar), cases={"n": 40}, measures=["loads"])
    return asked.run(out=folder / "out.nc")


def test_auxiliary_wheels_do_not_count(data: xr.Dataset) -> None:
    settled = data.status.values == "settled"
    bearing = data.load_n.isel(wheel=slice(1, None)).values[settled]
    assert data.load_n.attrs["auxiliary"] == "f"
    np.testing.assert_allclose(data.load_spread[settled], bearing.std(axis=1) / bearing.mean(axis=1))
    np.testing.assert_array_equal(data.touching[settled], (bearing > 1e-3).sum(axis=1))
    np.testing.assert_allclose(data.loads[settled], bearing.min(axis=1) / bearing.mean(axis=1), atol=1e-9)
    assert np.isnan(data.touching[~settled]).all()
    assert np.isnan(data.loads_wheel.isel(wheel=0)).all()
    assert (data.load_spread.attrs["units"], data.load_spread.attrs["better"]) == ("1", "low")
    assert layout_of(data).auxiliary == ("f",)
    np.testing.assert_array_equal(figures_of(data)["load_spread"], data.load_spread)


def test_the_summary_tells_their_percentiles(data: xr.Dataset) -> None:
    told = figure_spreads(data)
    settled = data.status.values == "settled"
    unit, shares = told["load_spread"]
    assert unit == "1"
    assert shares[50] == np.percentile(data.load_spread.values[settled], 50, method="lower")


def test_tensions_stand_by_track() -> None:
    layout = Layout(LAYOUT.wheels, LAYOUT.joints, (), tracks=("left", "right"))
    rows = Rows(layout, 2)
    rows._numbers["tension_n"][0] = 3.0, 4.0
    columns = rows.columns()
    zeros = np.zeros(2)
    cases = Cases(zeros, zeros, zeros, (), zeros.astype(int), None, {"track": zeros}, {})
    form = schema(layout, cases, found_in(columns))
    made = {each.name: each for each in form.variables}
    assert made["tension_n"].dims == ("case", "track")
    assert form.labels["track"] == ["left", "right"]
    np.testing.assert_array_equal(made["tension_n"].take(Block(cases, columns)), [[3.0, 4.0], [np.nan] * 2])
    assert "parameter_track" in made


def test_without_tracks_there_is_no_tension(data: xr.Dataset) -> None:
    assert "tension_n" not in data
    assert "track" not in data.dims
    assert read(Path(data.encoding["source"])).sizes["case"] == 40
