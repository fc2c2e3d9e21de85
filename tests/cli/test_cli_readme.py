"""The README's own rover: its files and commands do what the README shows."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from rover_pin.cli import main

README = Path(__file__).parents[2] / "README.md"


def blocks(kind: str) -> list[str]:
    """Fenced blocks of one kind."""
    return re.findall(rf"^```{kind}\n(.*?)^```$", README.read_text(encoding="utf-8"), re.M | re.S)


@pytest.fixture
def rover(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The README's files, in a folder of their own that is the current one."""
    sidecar, study = blocks("yaml")
    (tmp_path / "my_rover.urdf.xacro").write_text(blocks("xml")[0])
    (tmp_path / "rover.yaml").write_text(sidecar)
    (tmp_path / "yard.yaml").write_text(study)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_settle_prints_what_the_readme_shows(rover: Path, capsys: pytest.CaptureFixture[str]) -> None:
    shown = next(text for text in blocks("console") if "rover-pin settle" in text).splitlines()
    assert main(shown[0].removeprefix("$ rover-pin ").split()) == 0
    told = [line.split() for line in capsys.readouterr().out.splitlines()]
    for line in shown[1:]:
        if not line.startswith("residuals"):
            assert line.split() in told


def test_the_readmes_study_runs(rover: Path, capsys: pytest.CaptureFixture[str]) -> None:
    spec = rover / "yard.yaml"
    spec.write_text(spec.read_text().replace("n: 2000", "n: 4"))
    assert main(["study", "yard.yaml", "--html", "yard.html", "--engine", "serial"]) == 0
    assert "settled 4 (100.0 %)" in capsys.readouterr().out
    assert (rover / "yard.nc").is_file()
    assert (rover / "yard.html").is_file()


def test_the_readmes_python_runs(rover: Path) -> None:
    spec = rover / "yard.yaml"
    spec.write_text(spec.read_text().replace("n: 2000", "n: 4"))
    names: dict[str, object] = {}
    exec(blocks("python")[0], names)
    assert str(getattr(names["stance"], "status", "")) == "settled"
    assert getattr(names["data"], "sizes", {})["case"] == 4


def test_the_readme_names_every_command_and_robot() -> None:
    text = README.read_text(encoding="utf-8")
    for name in ("robots", "info", "settle", "study", "view"):
        assert f"rover-pin {name}" in text
    folders = (README.parent / "urdf").iterdir()
    for robot in (folder.name for folder in folders if (folder / "rover.yaml").is_file()):
        assert f"urdf/{robot}" in text
