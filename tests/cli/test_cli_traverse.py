"""`traverse`: an object, a table, files, the largest step, or one line."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
import xarray as xr

from rover_pin.cli import main

RIGID = str(Path(__file__).parents[1] / "fixtures" / "rigid4" / "rigid4.urdf")


def test_an_object_and_every_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    names = {"--csv": "t.csv", "-o": "t.nc", "--plot": "t.svg", "--html": "t.html"}
    files = [word for option, name in names.items() for word in (option, str(tmp_path / name))]
    words = ["traverse", RIGID, "--path=-1,0;1,0", "--terrain", "slope:10", "--step", "0.5", *files]
    assert main([*words, "--measures", "tip,energy", "--json"]) == 0
    told = capsys.readouterr()
    found = json.loads(told.out)
    assert (found["robot"], found["passed"], found["stop"], found["length_m"]) == ("rigid4", True, None, 2.0)
    assert len(found["steps"]) == 5
    assert found["steps"][2]["way_m"] == pytest.approx(1.0)
    assert found["steps"][0]["limit"] is None
    assert set(found["worst"]) == {
        "load_n", "friction_needed", "torque_needed", "effort_share", "tip", "energy",
    }  # fmt: skip
    assert found["worst"]["friction_needed"]["value"] == pytest.approx(math.tan(math.radians(10)), abs=1e-6)
    assert found["worst"]["tip"]["limiting"]
    assert told.err.count("wrote ") == 4
    rows = (tmp_path / "t.csv").read_text().splitlines()
    assert len(rows) == 6
    assert "load_n/fl" in rows[0].split(",")
    with xr.open_dataset(tmp_path / "t.nc", engine="h5netcdf") as data:
        assert data.sizes["step"] == 5
        assert data["load_n"].attrs["units"] == "N"
    assert "<svg" in (tmp_path / "t.svg").read_text()


def test_a_table_that_says_where_it_stops(capsys: pytest.CaptureFixture[str]) -> None:
    words = [
        "traverse",
        RIGID,
        "--path",
        "0,0;1,0",
        "--terrain",
        "slope:25",
        "--friction",
        "0.4",
        "--until-stop",
    ]
    assert main(words) == 1
    told = capsys.readouterr().out
    assert "stops after 0.000 m: friction at" in told
    assert "needs friction 0.4663 where there is 0.4" in told


def test_the_largest_step(capsys: pytest.CaptureFixture[str]) -> None:
    words = ["traverse", RIGID, "--largest-step", "--terrain", "step:0.002,0.5", "--step", "0.2"]
    assert main([*words, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["climbed_m"], found["stopped_m"], found["limit"]) == (0.002, None, None)
    assert found["trials"] == [{"height_m": 0.002, "climbed": True}]
    assert main(words) == 0
    told = capsys.readouterr().out
    assert "climbs a step of 2.0 mm" in told
    assert "give a higher --terrain step:HEIGHT,X" in told


@pytest.mark.parametrize(
    ("words", "line"),
    [
        ([], "--path: is missing; write --path 0,0;2,0"),
        (["--path", "1,1"], "path: needs two different waypoints (got '1,1')"),
        (["--path", "0,0;1,0", "--measures", "tipp"], "did you mean 'tip'?"),
        (["--path", "0,0;1,0", "--step", "x"], "--step: is not a finite number (got 'x')"),
        (["--path", "0,0;1,0", "--plot", "t.gif"], "plot: is no picture; name it .png, .svg or .pdf"),
        (["--path", "gone.csv"], "gone.csv: path: No such file or directory"),
        (["--largest-step", "--terrain", "slope:5"], "--terrain: is no step, so it has no largest height"),
        (["--largest-step", "--csv", "t.csv"], "--csv: does not go with --largest-step"),
        (["--largest-step", "--measures", "tip"], "--measures: does not go with --largest-step"),
        (["--largest-step", "--terrain", "step:-1,0"], "--terrain, HEIGHT: must be a finite number above 0"),
        (["--largest-step", "--terrain", "step:1,nan"], "--terrain, X: is not a finite number (got nan)"),
        (["--largest-step", "--spacing", "0"], "--spacing: must be a finite number above 0 (got 0.0)"),
        (["--largest-step", "--path", "5,0;6,0"], "path: does not go up the step: where it starts"),
    ],
)
def test_bad_input_is_one_line(words: list[str], line: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["traverse", RIGID, *words]) == 2
    told = capsys.readouterr()
    assert told.out == ""
    assert line in told.err
    assert told.err.count("\n") == 1
