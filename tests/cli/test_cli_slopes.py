"""`slopes`: an object, a table, a plot and a page, or one line."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest

from rover_pin.cli import main

RIGID = str(Path(__file__).parents[1] / "fixtures" / "rigid4" / "rigid4.urdf")


def test_an_object_a_plot_and_a_page(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    png, page = tmp_path / "s.png", tmp_path / "s.html"
    words = ["slopes", RIGID, "--headings", "4", "--friction", "0.4", "--png", str(png), "--html", str(page)]
    assert main([*words, "--json"]) == 0
    told = capsys.readouterr()
    found = json.loads(told.out)
    assert (found["robot"], found["friction"], found["gravity"]) == ("rigid4", 0.4, 9.81)
    assert [round(math.degrees(each["heading_rad"])) for each in found["headings"]] == [0, 90, 180, 270]
    for each in found["headings"]:
        assert each["slip_rad"] == pytest.approx(math.atan(0.4), abs=1e-6)
        assert each["tip_rad"] > each["slip_rad"] == each["stands_to_rad"]
        assert each["tip_status"] == "tips"
    assert found["worst"] in found["headings"]
    assert told.err == f"wrote {page}\nwrote {png}\n"
    assert png.read_bytes().startswith(b"\x89PNG")
    text = page.read_text(encoding="utf-8")
    assert "rigid4 on slopes" in text
    assert "data:image/svg+xml" in text
    assert "21.801" in text


def test_a_table_and_where_it_tips_first(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["slopes", RIGID, "--headings", "2", "--friction", "2"]) == 0
    told = capsys.readouterr().out
    rows = [line.split() for line in told.splitlines()]
    # centre of mass 6 / 70 ahead of the middle, 5 / 70 + 0.25 high
    tip = math.degrees(math.atan((0.5 + 6 / 70) / (5 / 70 + 0.25)))
    assert ["0", f"{tip:.3f}"] in [row[:2] for row in rows]
    assert next(row for row in rows if row[:1] == ["0"])[-2:] == ["-", "-"]
    assert "in every heading; least at 180 deg" in told


@pytest.mark.parametrize(
    ("words", "line"),
    [
        (["--friction", "0"], "--friction: must be more than zero"),
        (["--headings", "0"], "headings: must be a whole number from 1 to 3600"),
        (["--payload", "5@"], "--payload: is not KG@X,Y,Z or KG@FRAME"),
        (["--png", "/nowhere/s.png"], "/nowhere"),
    ],
)
def test_bad_input_is_one_line(words: list[str], line: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["slopes", RIGID, *words]) == 2
    told = capsys.readouterr()
    assert told.out == ""
    assert line in told.err
    assert told.err.count("\n") == 1
