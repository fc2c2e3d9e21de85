"""`compare`: tables, an object, results and a page, or one line."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from rover_pin.cli import main

WORDS = ["compare", "rocker_bogie:track=1.35", "rocker_bogie:track=1.0", "--terrain", "slope:56", "-n", "24"]
HOW = ["--engine", "serial", "--measure", "tip", "--seed", "3", "--gravity", "mars", "--payload", "1@bogie_l"]


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The files of one run."""
    folder = tmp_path_factory.mktemp("compare")
    page = folder / "c.html"
    assert main([*WORDS, *HOW, "-o", str(folder / "c.nc"), "--html", str(page)]) == 0
    return {"A": folder / "c_A.nc", "B": folder / "c_B.nc", "page": page}


def test_results_that_are_kept_give_the_same_object(
    kept: dict[str, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["compare", str(kept["A"]), str(kept["B"]), "--json", "--seed", "3"]) == 0
    told = json.loads(capsys.readouterr().out)
    a, b = (xr.load_dataset(kept[name], engine="h5netcdf") for name in "AB")
    assert (told["cases"], told["designs"][0]["gravity"], told["designs"][1]["payload"]) == (
        24, 3.71, "1.0@bogie_l_link",
    )  # fmt: skip
    both = ~np.isnan(a["tip"].values) & ~np.isnan(b["tip"].values)
    moved = (b["tip"].values - a["tip"].values)[both]
    (pair,) = told["pairs"]
    assert pair["measures"]["tip"]["median"] == pytest.approx(np.median(moved), abs=1e-15)
    assert pair["measures"]["tip"]["cases"] == int(both.sum())
    assert len(pair["only_first"]) == int(((a.status == "settled") & (b.status != "settled")).sum()) > 0
    assert told["designs"][1]["tipping"] == float((b.status == "tips").mean())


def test_people_read_tables_with_every_case_accounted_for(
    kept: dict[str, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["compare", str(kept["A"]), str(kept["B"])]) == 0
    out = capsys.readouterr().out
    assert re.search(r"^A  .*c_A.nc: .*; tips \d+\.\d % \(\d+\.\d % to \d+\.\d %\)$", out, re.MULTILINE)
    assert re.search(r"^only A settles in \d+ \(B: tips \d+\): cases \d+", out, re.MULTILINE)
    assert re.search(r"tip\s+rad\s+-?\d", out)


def test_the_page_is_one_file_without_scripts(kept: dict[str, Path]) -> None:
    text = kept["page"].read_text(encoding="utf-8")
    assert "<script" not in text
    assert "://" not in re.sub(r'src="data:[^"]*"', "", text)
    assert text.count("data:image/svg+xml") == 2 * 3  # three measures: spreads, and the pair
    assert "B less A, case by case" in text
    assert "1.0@bogie_l_link" in text


@pytest.mark.parametrize(
    ("words", "line"),
    [
        (["rocker_bogie"], "designs: there is nothing to compare with (got 1)"),
        (["rocker_bogie", "rocker_bogie"], "design: is given twice (got 'rocker_bogie')"),
        (["rocker_bogie", "a.nc"], "design: is no result like the others (got 'rocker_bogie')"),
        (["a.nc", "a.nc"], "result: is given twice (got 'a.nc')"),
        (
            ["a.nc", "b.nc", "--gravity", "moon"],
            "--gravity: results have their own (got 'moon'); leave it out",
        ),
        (["rocker_bogie", "hit_mrii", "--gravity", "mras"], "did you mean 'mars'"),
        (["rocker_bogie", "hit_mrii", "--html", "/nowhere/c.html"], "/nowhere"),
        (["rocker_bogie", "hit_mrii:wide=1"], "design hit_mrii:wide=1: parameters.wide: no such parameter"),
    ],
)
def test_bad_input_is_one_line(words: list[str], line: str, capsys: pytest.CaptureFixture[Any]) -> None:
    assert main(["compare", *words]) == 2
    told = capsys.readouterr()
    assert told.out == ""
    assert line in told.err
    assert told.err.count("\n") == 1
