"""`view`: a robot on flat ground, a result's page, or one case of it, as `settle` and the study had it."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from rover_pin import viz
from rover_pin.analysis import Study
from rover_pin.cli import main

ROUGH = {"rough": {"seed": 3, "rms": 0.06, "hurst": 0.7, "size": 8, "spacing": 0.05}}


class Shown:
    """Stands for the server: keeps what it was given, and is interrupted at once."""

    url = "http://127.0.0.1:1/"

    def __init__(self) -> None:
        self.stance: Any = None
        self.fragment = ""
        self.closed = False

    def __call__(self, stance: Any, *, fragment: str = "", open_browser: bool = True) -> Shown:
        self.stance, self.fragment = stance, fragment
        return self

    def wait(self) -> None:
        raise KeyboardInterrupt

    def close(self) -> None:
        self.closed = True


@pytest.fixture
def shown(monkeypatch: pytest.MonkeyPatch) -> Shown:
    server = Shown()
    monkeypatch.setattr(viz, "show", server, raising=False)
    monkeypatch.setattr(viz, "serve", server, raising=False)
    return server


def test_a_robot_stands_on_flat_ground(shown: Shown, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["view", "rocker_bogie", "--no-browser", "--param", "track=1.1"]) == 0
    assert shown.closed
    assert shown.stance.settled
    assert shown.stance.rover.parameters["track"] == 1.1
    assert "http://127.0.0.1:1/ (Ctrl-C ends it)" in capsys.readouterr().out


@pytest.fixture
def failing(capsys: pytest.CaptureFixture[str]) -> Any:
    def told(*words: str) -> str:
        assert main(list(words)) == 2
        return capsys.readouterr().err

    return told


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, xr.Dataset]:
    out = tmp_path_factory.mktemp("view") / "out.nc"
    vary = {"x": "map", "y": "map", "yaw_deg": [0, 360]}
    study = Study("rocker_bogie", ROUGH, cases={"n": 6}, vary=vary, measures=["loads", "tip"])
    return out, study.run(out=out)


def test_one_case_alone_and_the_worst_one(
    shown: Shown, result: tuple[Path, xr.Dataset], failing: Any
) -> None:
    out, data = result
    assert main(["view", str(out), "--stance", "--case", "2"]) == 0
    assert shown.stance.position[2] == pytest.approx(float(data.z_m[2]), abs=1e-8)
    assert main(["view", str(out), "--stance"]) == 0
    worst = int(np.argmin(data.tip.values))
    assert shown.stance.position[2] == pytest.approx(float(data.z_m[worst]), abs=1e-8)
    wrong = "error: case: no such case (got 6); give 0 to 5\n"
    assert failing("view", str(out), "--stance", "--case", "6") == wrong
    assert failing("view", str(out), "--case", "6") == wrong


def test_a_result_has_its_page(
    shown: Shown, result: tuple[Path, xr.Dataset], capsys: pytest.CaptureFixture[str]
) -> None:
    out, data = result
    assert main(["view", str(out), "--no-browser"]) == 0
    assert (shown.closed, shown.fragment) == (True, "")
    assert capsys.readouterr().out.startswith(f"{data.attrs['title']}: 6 cases\nhttp://127.0.0.1:1/")
    head = json.loads(re.search(r'id="header">(.*?)</script>', shown.stance)[1])  # type: ignore[index]
    assert (head["cases"], head["first"]) == (6, "tip")
    assert main(["view", str(out), "--case", "4"]) == 0
    assert shown.fragment == "case=4"
    exact = json.loads(re.search(r'id="header">(.*?)</script>', shown.stance)[1])["exact"]  # type: ignore[index]
    load = sum(row[-1] for row in exact["4"]["contacts"])
    assert load == pytest.approx(float(data.load_n[4].sum()), abs=1e-4)


def test_a_robot_has_no_cases(failing: Any) -> None:
    wrong = "error: --stance: cases belong to a study's result (got 'rocker_bogie'); name an OUT.nc\n"
    assert failing("view", "rocker_bogie", "--stance") == wrong
