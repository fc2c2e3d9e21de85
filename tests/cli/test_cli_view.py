"""`view`: a robot on flat ground, or a case of a result, as `settle` and the study had it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rover_pin import viz
from rover_pin.analysis import Study
from rover_pin.cli import main

ROUGH = {"rough": {"seed": 3, "rms": 0.06, "hurst": 0.7, "size": 8, "spacing": 0.05}}


class Shown:
    """Stands for the server: keeps what it was given, and is interrupted at once."""

    url = "http://127.0.0.1:1/"

    def __init__(self) -> None:
        self.stance: Any = None
        self.closed = False

    def __call__(self, stance: Any, *, open_browser: bool = True) -> Shown:
        self.stance = stance
        return self

    def wait(self) -> None:
        raise KeyboardInterrupt

    def close(self) -> None:
        self.closed = True


@pytest.fixture
def shown(monkeypatch: pytest.MonkeyPatch) -> Shown:
    server = Shown()
    monkeypatch.setattr(viz, "show", server, raising=False)
    return server


def test_a_robot_stands_on_flat_ground(shown: Shown, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["view", "rocker_bogie", "--no-browser", "--param", "track=1.1"]) == 0
    assert shown.closed
    assert shown.stance.settled
    assert shown.stance.rover.parameters["track"] == 1.1
    assert "http://127.0.0.1:1/ (Ctrl-C ends it)" in capsys.readouterr().out


def test_a_case_and_the_worst_one(shown: Shown, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out.nc"
    vary = {"x": "map", "y": "map", "yaw_deg": [0, 360]}
    data = Study("rocker_bogie", ROUGH, cases={"n": 6}, vary=vary, measures=["loads", "tip"]).run(out=out)
    assert main(["view", str(out), "--case", "2"]) == 0
    assert shown.stance.position[2] == pytest.approx(float(data.z_m[2]), abs=1e-8)
    assert main(["view", str(out)]) == 0
    assert shown.stance.position[2] == pytest.approx(
        float(data.z_m[int(np.argmin(data.tip.values))]), abs=1e-8
    )
    assert main(["view", str(out), "--case", "6"]) == 2
    assert capsys.readouterr().err == "error: case: no such case (got 6); give 0 to 5\n"
