"""The example of inverse kinematics, and the README's: short, and they do what they say."""

import re
import runpy
import sys
from pathlib import Path

import numpy as np
import pytest

from rover_pin.kinematics import Sliding

TOP = Path(__file__).parents[2]
EXAMPLE = TOP / "examples" / "inverse_kinematics.py"
WHEEL = 0.13
"""m: radius of rocker_bogie's wheels."""


@pytest.mark.parametrize("words", [[], ["hit_mrii"], [str(TOP / "tests/fixtures/trailing4/trailing4.urdf")]])
def test_the_example(monkeypatch, capsys, words):
    monkeypatch.setattr(sys, "argv", [str(EXAMPLE), *words])
    left = runpy.run_path(str(EXAMPLE))
    told = capsys.readouterr().out.splitlines()
    assert len(told) == 5
    assert left["step"].solved
    at = left["at"]
    assert at.q[0] == pytest.approx(5.0 + 0.05 * 0.02 * 201, abs=2e-3)
    assert np.max(np.abs(at.contacts[:, 0])) < 1e-5
    if not words:
        drives = [float(rate) for rate in re.findall(r"drive_\w+ ([+-][\d.]+)", told[-1])]
        assert len(drives) == 6
        assert np.mean(drives) == pytest.approx(0.05 / WHEEL, rel=0.03)  # rough ground is a little longer


def test_the_example_is_short():
    assert len([line for line in EXAMPLE.read_text().splitlines() if line]) <= 20


def test_the_readmes_inverse_kinematics():
    blocks = re.findall(r"^```python\n(.*?)^```$", (TOP / "README.md").read_text(), re.M | re.S)
    block = next(text for text in blocks if "InverseKinematics" in text)
    watched = block.replace("for _ in range(500):", "slid = Slid(at)\nfor _ in range(500):")
    watched = watched.replace("step = inverse", "slid.look(at)\n    step = inverse")
    names = {"Slid": Slid}
    exec(watched, names)
    assert names["step"].solved
    assert names["at"].q[0] == pytest.approx(0.5, abs=0.01)
    assert names["slid"].most < 1e-3


class Slid:
    """How far wheels slid."""

    def __init__(self, at):
        self.sliding, self.most = Sliding(at), 0.0

    def look(self, at):
        self.most = float(np.max(self.sliding.step(at)))
