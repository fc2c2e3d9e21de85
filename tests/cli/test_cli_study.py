"""`study`: a file, a page and a summary, or one line and nothing written."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
import xarray as xr

from rover_pin.cli import main

SMALL = """\
robot: rocker_bogie
terrain: {rough: {seed: 3, rms: 0.06, hurst: 0.7, size: 8, spacing: 0.05}}
cases: {n: 12}
measures: [tip, loads]
"""


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Any:
    def call(*words: object) -> tuple[int, str, str]:
        status = main([str(word) for word in words])
        told = capsys.readouterr()
        return status, told.out, told.err

    return call


@pytest.fixture
def spec(tmp_path: Path) -> Path:
    path = tmp_path / "small.yaml"
    path.write_text(SMALL)
    return path


def test_a_study_gives_a_file_a_page_and_an_object(run: Any, spec: Path, tmp_path: Path) -> None:
    out, page = tmp_path / "out.nc", tmp_path / "page.html"
    status, told, err = run("study", spec, "-o", out, "--engine", "serial", "--html", page, "--json")
    assert status == 0
    summary = json.loads(told)
    assert (summary["cases"], summary["status"]) == (12, {"settled": 12})
    assert summary["plain_path"] in range(13)
    assert set(summary["measures"]) == {"tip", "loads"}
    assert set(summary["measures"]["tip"]["percentiles"]) == {"1", "5", "50", "95", "99"}
    assert len(summary["measures"]["tip"]["worst"]) == 10
    assert summary["residuals"]["equilibrium"] < 1e-6
    assert err == f"wrote {out}\nwrote {page}\n"
    data = xr.load_dataset(out, engine="h5netcdf")
    assert data.attrs["study"] == SMALL
    assert summary["plain_path"] == int(data.plain_path.sum()) == data.attrs["plain_path_cases"]
    assert summary["measures"]["tip"]["worst"][0]["value"] == float(data.tip.min())
    assert page.stat().st_size > 100_000
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["out.nc", "page.html", "small.yaml"]


def test_a_silent_out_is_named_after_the_file(
    run: Any, spec: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    status, told, _ = run("study", spec, "--engine", "serial")
    assert status == 0
    assert (tmp_path / "small.nc").is_file()
    assert told.startswith("rocker_bogie on rough:3,0.06,0.7")
    assert "settled 12 (100.0 %)" in told
    assert re.search(r"^answered by the plain path: \d+ \(\d+\.\d %\)$", told, re.MULTILINE)
    assert re.search(r"tip\s+rad\s+high", told)


def test_a_study_without_an_answer_is_one(run: Any, tmp_path: Path) -> None:
    spec = tmp_path / "steep.yaml"
    spec.write_text("robot: rocker_bogie\nterrain: {slope: 75}\ncases: {n: 2}\nvary: {yaw_deg: [0, 10]}\n")
    status, told, _ = run("study", spec, "-o", tmp_path / "o.nc", "--engine", "serial", "--json")
    assert status == 1
    assert json.loads(told)["status"] == {"tips": 2}


def test_resume_after_an_interrupt(
    run: Any, spec: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from rover_pin.analysis import trial
    from rover_pin.analysis.job import Runner

    out = tmp_path / "out.nc"
    carry_out = Runner.run

    def interrupted(self: Runner, chunk: tuple[int, int]) -> Any:
        if chunk[0] <= 9 < chunk[1]:
            raise KeyboardInterrupt
        return carry_out(self, chunk)

    monkeypatch.setattr(trial, "LARGEST_CHUNK", 4)
    with monkeypatch.context() as patch:
        patch.setattr(Runner, "run", interrupted)
        status, told, err = run("study", spec, "-o", out, "--engine", "serial", "--json")
    assert (status, told) == (130, "")
    assert err == f"interrupted; what is finished is kept in {out}.parts: go on with --resume\n"
    assert not out.exists()
    status, told, err = run("study", spec, "-o", out, "--engine", "serial")
    assert status == 2
    assert "an unfinished run lies here; add --resume to go on" in err
    status, told, _ = run("study", spec, "-o", out, "--engine", "serial", "--resume", "--json")
    assert (status, json.loads(told)["cases"]) == (0, 12)


@pytest.mark.parametrize(
    ("text", "words", "message"),
    [
        ("robot: rocker_bogie\nterain: flat\n", [], "s.yaml: terain: unknown key; did you mean 'terrain'?"),
        (
            SMALL.replace("[tip", "[tipp"),
            [],
            "s.yaml: measures: no such measure (got 'tipp'); did you mean 'tip'",
        ),
        (SMALL, ["--engine", "dusk"], "engine: no such engine (got 'dusk'); did you mean 'dask'?"),
        (SMALL, ["--workers", "0"], "workers: must be at least 1 (got 0)"),
        (SMALL, ["--scheduler", "tcp://a:1"], "scheduler: the engine process takes no scheduler"),
        (SMALL, ["--html", "none/x.html"], "none: there is no such folder; make it first"),
        (
            SMALL + "vary: {posture: [hom]}\n",
            [],
            "s.yaml: vary.posture: no such posture (got 'hom'); did you mean",
        ),
        (SMALL + "search: {minimise: load_spread}\n", [], "s.yaml: search: asks for a search; run it with"),
    ],
)
def test_bad_input_writes_nothing(
    run: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, text: str, words: list[str], message: str
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "s.yaml").write_text(text)
    status, out, err = run("study", "s.yaml", "-o", "out.nc", *words)
    assert (status, out) == (2, "")
    assert err.startswith(f"error: {message}")
    assert err.count("\n") == 1
    assert [entry.name for entry in tmp_path.iterdir()] == ["s.yaml"]


def test_no_such_study_file(run: Any, tmp_path: Path) -> None:
    path = tmp_path / "none.yaml"
    assert run("study", path, "-o", tmp_path / "o.nc") == (2, "", f"error: {path}: no such file\n")


def test_an_interrupt_before_anything_is_finished(
    run: Any, spec: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from rover_pin.analysis.job import Runner

    def interrupted(self: Runner) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(Runner, "first", interrupted)
    status, told, err = run("study", spec, "-o", tmp_path / "out.nc", "--engine", "serial")
    assert (status, told, err) == (130, "", "interrupted before anything was finished\n")
    assert [entry.name for entry in tmp_path.iterdir()] == ["small.yaml"]
