"""`mobility`: files, a picture and a summary, or one line and nothing written."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from rover_pin.cli import main

FEW = ("--headings", "4", "--every", "6", "--engine", "serial")


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.chdir(tmp_path)

    def call(*words: object) -> tuple[int, str, str]:
        status = main([str(word) for word in words])
        told = capsys.readouterr()
        return status, told.out, told.err

    return call


@pytest.fixture
def yard(tmp_path: Path) -> Path:
    """A gentle map of 5 m."""
    x = np.linspace(0.0, 5.0, 51)
    path = tmp_path / "yard.npy"
    np.save(path, 0.1 * np.sin(x)[None, :] * np.cos(x)[:, None])
    return path


def names(folder: Path) -> list[str]:
    return sorted(entry.name for entry in folder.iterdir())


def test_a_map_gives_files_and_an_object(run: Any, yard: Path, tmp_path: Path) -> None:
    words = (
        "--tiff",
        "worst.tif",
        "--png",
        "map.png",
        "--json",
        "--robot",
        "rocker_bogie",
        "--param",
        "track=1.1",
    )
    status, told, err = run("mobility", "yard.npy", "--spacing", "0.1", *FEW, *words)
    assert status == 0
    assert err == "wrote yard_mobility.nc\nwrote worst.tif\nwrote map.png\n"
    found = json.loads(told)
    assert (found["robot"], found["terrain"]) == ("rocker_bogie", "yard.npy")
    assert (found["measure"], found["unit"], found["better"]) == ("tip", "rad", "high")
    assert found["cases"] == 9 * 9 * 4 == sum(found["outcomes"].values())
    assert found["cells"]["rows"] == found["cells"]["columns"] == 9
    data = xr.load_dataset(tmp_path / "yard_mobility.nc", engine="h5netcdf")
    assert "track=1.1" in data.attrs["parameters"]
    place = found["worst"]["worst_place"]
    assert place["value"] == float(data.worst.min()) == found["worst"]["percentiles"]["0"]
    assert float(data.worst.sel(x=place["x_m"], y=place["y_m"])) == place["value"]
    assert found["best"]["percentiles"]["100"] == float(data.best.max())
    assert (tmp_path / "map.png").read_bytes().startswith(b"\x89PNG")
    assert names(tmp_path) == ["map.png", "worst.tif", "yard.npy", "yard_mobility.nc"]


def test_a_word_and_a_table(run: Any, tmp_path: Path) -> None:
    words = ("--headings", "2", "--every", "80", "--engine", "serial", "--measure", "clearance")
    status, told, _ = run("mobility", "rough:1,0.05,0.8", *words)
    assert status == 0
    assert told.startswith("rocker_bogie on rough:1,0.05,0.8: 6 x 6 places, 2 headings, 72 cases in")
    assert "clearance [m], high is better, over the places" in told
    assert "worst place: x " in told
    assert names(tmp_path) == ["mobility.nc"]


def test_a_map_without_an_answer_is_one(run: Any, tmp_path: Path) -> None:
    np.save(tmp_path / "steep.npy", np.tile(6.0 * np.linspace(0.0, 4.0, 21), (21, 1)))
    status, told, _ = run("mobility", "steep.npy", "--spacing", "0.2", *FEW, "--json")
    assert status == 1
    assert json.loads(told)["worst"] == {"percentiles": {}, "worst_place": None}


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--measure", "tpi"), "measure: no such measure (got 'tpi'); did you mean 'tip'?"),
        (("--headings", "0"), "headings: must be a whole number, at least 1 (got 0)"),
        (("-o", "none/o.nc"), "none: there is no such folder; make it first"),
        (("--png", "none/o.png"), "none: there is no such folder; make it first"),
        (("--posture", "hme"), "did you mean 'home'?"),
        (("--robot", "rocker_bogi"), "no bundled robot of that name (got 'rocker_bogi'); did you mean"),
        (("--param", "track"), "--param: is not NAME=VALUE (got 'track')"),
        (("--workers", "0"), "workers: must be at least 1 (got 0)"),
        (("--gravity", "mras"), "gravity is not a number (got 'mras'); did you mean 'mars'?"),
        (("--spacing", "0.01"), "is too small for rocker_bogie, whose wheels are 1.7 m apart"),
    ],
)
def test_bad_input_writes_nothing(run: Any, yard: Path, words: tuple[str, ...], message: str) -> None:
    spacing = () if "--spacing" in words else ("--spacing", "0.1")
    status, out, err = run("mobility", "yard.npy", *spacing, "--png", "p.png", *words)
    assert (status, out) == (2, "")
    assert err.startswith("error: ")
    assert message in err
    assert err.count("\n") == 1
    assert names(yard.parent) == ["yard.npy"]


def test_a_terrain_without_nodes(run: Any, tmp_path: Path) -> None:
    status, out, err = run("mobility", "slope:10")
    assert (status, out) == (2, "")
    assert err.startswith(
        "error: slope:10: a mobility map needs the nodes of a grid; give a height map's file"
    )
    assert names(tmp_path) == []


def test_an_interrupt_writes_nothing(run: Any, yard: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from rover_pin.analysis.mobility.survey import Surveyor

    def interrupted(self: Surveyor, chunk: tuple[int, int]) -> Any:
        raise KeyboardInterrupt

    monkeypatch.setattr(Surveyor, "run", interrupted)
    status, out, err = run("mobility", "yard.npy", "--spacing", "0.1", *FEW)
    assert (status, out, err) == (130, "", "interrupted; nothing is written\n")
    assert names(yard.parent) == ["yard.npy"]
