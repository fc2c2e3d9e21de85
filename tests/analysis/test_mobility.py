"""mobility: worst and best heading of every cell, beside closed forms, the plain path and symmetry."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from little_rover import four_wheels

from rover_pin import Terrain, load, settle, stability
from rover_pin.analysis import mobility
from rover_pin.analysis.mobility.cells import best_and_worst, commonest_failure
from rover_pin.analysis.mobility.outcome import OUTCOMES
from rover_pin.analysis.mobility.result import write_netcdf, write_tiff
from rover_pin.errors import InputError

LENGTH, WIDTH, DROP, RADIUS = 0.5, 0.4, 0.2, 0.1
SLOPE_DEG = 10.0


@pytest.fixture(scope="module")
def rigid(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """A box on four wheels whose centre of mass is over their middle."""
    return four_wheels(LENGTH, WIDTH, drop=DROP, radius=RADIUS).load(tmp_path_factory.mktemp("rigid"))


@pytest.fixture(scope="module")
def slope() -> Terrain:
    """A plane that rises along +x, as a grid of 4 m."""
    x = np.arange(41) * 0.1 - 2.0
    heights = np.tile(math.tan(math.radians(SLOPE_DEG)) * x, (41, 1))
    return Terrain.from_grid(heights, 0.1, (-2.0, -2.0), "linear")


@pytest.fixture(scope="module")
def rough() -> Terrain:
    return Terrain.rough(3, 0.08, 0.7, size=6.0, spacing=0.1)


@pytest.fixture(scope="module")
def bogie() -> Any:
    return load("rocker_bogie")


@pytest.fixture(scope="module")
def rough_map(bogie: Any, rough: Terrain) -> xr.Dataset:
    return mobility(bogie, rough, headings=6, every=5)


def cell(data: xr.Dataset, x: float, y: float) -> Any:
    return data.sel(x=x, y=y, method="nearest")


def test_across_and_along_a_slope(rigid: Any, slope: Terrain) -> None:
    """On a plane the box stands parallel to it: tip angles are those of its sides, the slope taken off."""
    data = mobility(rigid, slope, headings=4, every=10)
    height, tilt = DROP + RADIUS, math.radians(SLOPE_DEG)
    across = min(math.atan(WIDTH / height) - tilt, math.atan(LENGTH * math.cos(tilt) / height))
    along = min(math.atan(LENGTH / height) - tilt, math.atan(WIDTH * math.cos(tilt) / height))
    middle = cell(data, 0.0, 0.0)
    assert float(middle.worst) == pytest.approx(across, abs=1e-6)
    assert float(middle.best) == pytest.approx(along, abs=1e-6)
    assert abs(math.sin(float(middle.worst_yaw_rad))) == pytest.approx(1.0)
    assert abs(math.cos(float(middle.best_yaw_rad))) == pytest.approx(1.0)
    assert (float(middle.settled_share), int(middle.status)) == (1.0, 0)


def test_more_headings_are_no_worse_than_straight_across(rigid: Any, slope: Terrain) -> None:
    data = mobility(rigid, slope, headings=16, every=20)
    across = math.atan(WIDTH / (DROP + RADIUS)) - math.radians(SLOPE_DEG)
    assert float(cell(data, 0.0, 0.0).worst) == pytest.approx(across, abs=1e-6)


def test_cells_are_what_settle_and_stability_say(bogie: Any, rough: Terrain, rough_map: xr.Dataset) -> None:
    stands = np.argwhere(rough_map.settled_share.values > 0)
    for row, column in stands[np.random.default_rng(0).permutation(len(stands))[:4]]:
        here = rough_map.isel(y=row, x=column)
        values = []
        for yaw in 2 * math.pi * np.arange(6) / 6:
            stance = settle(bogie, rough, x=float(here.x), y=float(here.y), yaw=float(yaw))
            if stance.settled:
                values.append((stability(stance, ["tip"])["tip"].value, float(yaw)))
        worst, best = min(values), max(values)
        assert float(here.worst) == pytest.approx(worst[0], abs=1e-7)
        assert float(here.best) == pytest.approx(best[0], abs=1e-7)
        assert float(here.worst_yaw_rad) == worst[1]
        assert float(here.best_yaw_rad) == best[1]
        assert float(here.settled_share) == len(values) / 6


def test_the_border_is_off_the_map(bogie: Any, rough_map: xr.Dataset) -> None:
    """Where half the track does not fit none settles; where the farthest wheel fits, none is off the map."""
    away = np.minimum(3.0 - abs(rough_map.x), 3.0 - abs(rough_map.y))
    off_map = OUTCOMES.index("off_map")
    narrow = (away < 0.5).values
    assert np.all(np.isnan(rough_map.worst.values[narrow]))
    assert np.all(rough_map.status.values[narrow] == off_map)
    assert np.all(rough_map.settled_share.values[narrow] == 0.0)
    assert np.all(rough_map.status.values[(away > 1.2).values] != off_map)


def test_a_point_symmetric_map_has_point_symmetric_answers(bogie: Any) -> None:
    """Turned by half a turn about the map's middle, rover and ground are the same question."""
    half = np.random.default_rng(5).normal(size=(13, 13))
    heights = 0.05 * (half + half[::-1, ::-1])
    data = mobility(bogie, Terrain.from_grid(heights, 0.4, (-2.4, -2.4)), headings=4)
    assert (data.settled_share > 0).sum() > 20
    for name in ("worst", "best", "settled_share"):
        values = data[name].values
        np.testing.assert_allclose(values, values[::-1, ::-1], atol=1e-6)


def test_the_dataset_says_units_and_whence(bogie: Any, rough: Terrain, rough_map: xr.Dataset) -> None:
    assert rough_map.worst.dims == ("y", "x")
    assert (rough_map.sizes["y"], rough_map.sizes["x"]) == (13, 13)
    assert (rough_map.worst.attrs["units"], rough_map.worst.attrs["better"]) == ("rad", "high")
    assert rough_map.x.attrs["units"] == rough_map.y.attrs["units"] == "m"
    assert rough_map.status.attrs["flag_meanings"].split()[:2] == ["settled", "tips"]
    assert len(rough_map.status.attrs["flag_values"]) == len(OUTCOMES)
    assert int(rough_map.outcomes.sum()) == rough_map.attrs["cases"] == 13 * 13 * 6
    assert rough_map.attrs["terrain_digest"] == rough.digest
    assert (rough_map.attrs["robot"], rough_map.attrs["headings"]) == ("rocker_bogie", 6)
    assert rough_map.attrs["numpy_version"] == np.__version__


def test_the_engine_does_not_matter(bogie: Any, rough: Terrain) -> None:
    told: list[tuple[int, int]] = []
    asked = {"headings": 3, "every": 6, "measure": "clearance", "posture": "home"}
    one = mobility(bogie, rough, **asked, progress=lambda done, count: told.append((done, count)))
    two = mobility(bogie, rough, **asked, engine="process", workers=2)
    xr.testing.assert_equal(one, two)
    cases = 11 * 11 * 3
    assert (told[0], told[-1]) == ((0, cases), (cases, cases))


def test_a_measure_whose_low_values_are_better() -> None:
    value, yaw = np.array([[1.0, 3.0, 2.0]]), np.array([0.0, 0.1, 0.2])
    found = best_and_worst(value, np.array([[True, True, True]]), yaw, "low")
    assert (found["worst"][0], found["best"][0]) == (3.0, 1.0)
    assert (found["worst_yaw_rad"][0], found["best_yaw_rad"][0]) == (0.1, 0.0)


def test_headings_that_fail_closed_count_as_the_worst() -> None:
    value, yaw = np.array([[np.nan, -np.inf, -np.inf], [0.5, np.nan, -np.inf]]), np.array([0.0, 0.1, 0.2])
    found = best_and_worst(value, ~np.isnan(value), yaw, "high")
    assert found["worst"].tolist() == [-np.inf, -np.inf]
    assert found["best"].tolist() == [-np.inf, 0.5]
    assert found["worst_yaw_rad"].tolist() == [0.1, 0.2]
    assert found["best_yaw_rad"].tolist() == [0.1, 0.0]


@given(
    value=hnp.arrays(np.float64, (4, 5), elements=st.floats(-1e3, 1e3)),
    settled=hnp.arrays(np.bool_, (4, 5)),
    better=st.sampled_from(["high", "low"]),
)
@settings(max_examples=60, deadline=None)
def test_worst_and_best_by_hand(value: Any, settled: Any, better: str) -> None:
    yaw = np.arange(5) / 5
    found = best_and_worst(value, settled, yaw, better)
    for i in range(4):
        known = [(v, a) for v, a, s in zip(value[i], yaw, settled[i], strict=True) if s]
        if not known:
            assert all(math.isnan(found[name][i]) for name in found)
            continue
        ends = {"worst": min, "best": max} if better == "high" else {"worst": max, "best": min}
        for name, end in ends.items():
            wanted = end(v for v, _ in known)
            assert found[name][i] == wanted
            assert found[f"{name}_yaw_rad"][i] == next(a for v, a in known if v == wanted)


@given(outcome=hnp.arrays(np.int64, (6,), elements=st.integers(0, 4)))
@settings(max_examples=60, deadline=None)
def test_commonest_failure_by_hand(outcome: Any) -> None:
    failures = [k for k in outcome.tolist() if k != 0]
    wanted = max(range(1, 5), key=lambda k: (failures.count(k), -k)) if failures else 0
    assert int(commonest_failure(outcome, 5)) == wanted


def test_files_give_back_what_was_written(rough_map: xr.Dataset, tmp_path: Path) -> None:
    import tifffile

    write_netcdf(rough_map, tmp_path / "map.nc")
    write_tiff(rough_map, tmp_path / "map.tif")
    xr.testing.assert_equal(xr.load_dataset(tmp_path / "map.nc", engine="h5netcdf"), rough_map)
    pixels = tifffile.imread(tmp_path / "map.tif")
    assert pixels.dtype == np.float32
    np.testing.assert_array_equal(pixels, rough_map.worst.values.astype(np.float32))
    with tifffile.TiffFile(tmp_path / "map.tif") as file:
        assert file.pages[0].tags["ModelPixelScaleTag"].value[:2] == pytest.approx((0.5, 0.5))
    assert sorted(path.name for path in tmp_path.iterdir()) == ["map.nc", "map.tif"]


def test_the_written_map_can_be_read_as_terrain(rigid: Any, slope: Terrain, tmp_path: Path) -> None:
    data = mobility(rigid, slope, headings=2, every=4).isel(x=slice(3, 8), y=slice(3, 8))
    assert not np.isnan(data.worst).any()
    write_tiff(data, tmp_path / "map.tif")
    again = Terrain.from_file(tmp_path / "map.tif", interpolation="linear")
    assert again.spacing == pytest.approx(0.4)
    assert float(again.height(0.4, 0.8)) == pytest.approx(float(data.worst[2, 1]), abs=1e-6)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"measure": "tipp"}, "measure: no such measure (got 'tipp'); did you mean 'tip'?"),
        (
            {"measure": "friction"},
            "measure: takes too long for a map (got 'friction'); give one of loads, polygon, tip, "
            "force_angle, energy, zmp, clearance",
        ),
        ({"headings": 0}, "headings: must be a whole number, at least 1 (got 0)"),
        ({"headings": 2.5}, "headings: must be a whole number, at least 1 (got 2.5)"),
        ({"every": -1}, "every: must be a whole number, at least 1 (got -1)"),
        ({"posture": "hoem"}, "did you mean 'home'?"),
        ({"gravity": 0.0}, "gravity: must be above 0 m/s2 (got 0.0)"),
        ({"engine": "threads"}, "engine: no such engine (got 'threads')"),
    ],
)
def test_bad_input(bogie: Any, rough: Terrain, words: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError) as caught:
        mobility(bogie, rough, **{"headings": 2, "every": 10, **words})
    assert message in str(caught.value)


def test_terrains_that_make_no_map(bogie: Any) -> None:
    cure = "give a height map's file, rough:SEED,RMS,HURST, or Terrain.from_grid"
    for terrain in (Terrain.slope(5.0), Terrain.step(0.1, 1.0)):
        with pytest.raises(InputError) as caught:
            mobility(bogie, terrain)
        assert str(caught.value) == f"{terrain.label}: a mobility map needs the nodes of a grid; {cure}"
    with pytest.raises(InputError) as caught:
        mobility(bogie, Terrain.from_grid(np.zeros((4, 4)), 0.1))
    told = str(caught.value)
    assert "grid: the map of 0.3 x 0.3 m is too small for rocker_bogie, whose wheels are 1.7 m apart" in told


def test_a_measure_that_the_rover_cannot_have(rigid: Any, slope: Terrain) -> None:
    with pytest.raises(InputError, match=r"measure: rigid cannot have it: .* \(got 'clearance'\)"):
        mobility(rigid, slope, measure="clearance")
