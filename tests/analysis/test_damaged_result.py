"""A study's result with bits flipped or its end cut off: refused in one line, or every value as it was."""

import random
import shutil

import h5py
import numpy as np
import pytest

import rover_pin as rp
from rover_pin.analysis.dataset import read
from rover_pin.cli import main
from rover_pin.errors import StudyError

STUDY = """
robot: rocker_bogie
terrain: flat
cases: {n: 40}
vary: {x: [-1, 1], y: [-1, 1], yaw_deg: [0, 360]}
measures: [tip, loads]
"""


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    out = tmp_path_factory.mktemp("result") / "out.nc"
    rp.analysis.Study.from_text(STUDY).run(engine="serial", out=out)
    with read(out) as data:
        return out, data.load()


def refusal(path):
    """The words with which a result is refused; None, and its values, where it is taken."""
    try:
        with read(path) as data:
            return None, data.load()
    except StudyError as error:
        return str(error), None


def test_flipped_bits_are_told_or_harmless(result, tmp_path):
    path, whole = result
    raw, rng, refused = path.read_bytes(), random.Random(3), 0
    for k in range(24):
        damaged = bytearray(raw)
        at = rng.randrange(len(raw))
        if k % 5:
            damaged[at] ^= 1 << rng.randrange(8)
        else:
            damaged = damaged[:at]
        copy = tmp_path / "a.nc"
        copy.write_bytes(damaged)
        words, data = refusal(copy)
        if words is None:
            assert data.identical(whole)
        else:
            refused += 1
            assert "\n" not in words
    assert refused > 8


@pytest.mark.parametrize("keep", [0, 300, 0.5])
@pytest.mark.parametrize("command", [["view", "cut.nc", "--case", "1"], ["compare", "whole.nc", "cut.nc"]])
def test_commands_say_so_in_one_line(result, tmp_path, monkeypatch, capsys, keep, command):
    raw = result[0].read_bytes()
    monkeypatch.chdir(tmp_path)
    shutil.copy(result[0], "whole.nc")
    (tmp_path / "cut.nc").write_bytes(raw[: keep if isinstance(keep, int) else int(keep * len(raw))])
    assert main(command) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("error: cut.nc: is no netCDF file, or a damaged one: ")
    assert err.count("\n") == 1


@pytest.mark.parametrize(
    ("gone", "told"),
    [
        ("loop_m", "variable loop_m: is missing or of another kind: the result is damaged; run the study "),
        ("tip_limiting", "variable tip_limiting: is missing or of another kind: the result is damaged; run "),
        ("status", "is not the result of a study; make one with rover-pin study -o"),
    ],
)
def test_a_missing_variable_is_named(result, tmp_path, gone, told):
    copy = tmp_path / "a.nc"
    shutil.copy(result[0], copy)
    with h5py.File(copy, "r+") as file:
        del file[gone]
    assert refusal(copy)[0].removeprefix(f"{copy}: ").startswith(told)


@pytest.mark.parametrize(
    ("name", "value", "told"),
    [
        ("title", None, "attribute title: is missing or no text: the result is damaged; "),
        ("plain_path_cases", "abc", "attribute plain_path_cases: is missing or no whole number: the result "),
        ("study", np.array([1, 2]), "attribute study: is missing or no text: the result is damaged; "),
    ],
)
def test_attributes_are_looked_at(result, tmp_path, name, value, told):
    copy = tmp_path / "a.nc"
    shutil.copy(result[0], copy)
    with h5py.File(copy, "r+") as file:
        del file.attrs[name]
        if value is not None:
            file.attrs[name] = value
    assert refusal(copy)[0].removeprefix(f"{copy}: ").startswith(told)
