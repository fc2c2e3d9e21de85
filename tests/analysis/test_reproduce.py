"""`reproduce`: verdicts, the registry, the command, and Polibot's rows computed from the robot."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rover_pin as rp
from rover_pin.analysis import papers as registry
from rover_pin.analysis.papers import (
    IN_SAMPLE,
    NOT_REPRODUCED,
    PARTLY,
    REPRODUCED,
    VERDICTS,
    Chart,
    Curve,
    Finding,
    Mark,
    Panel,
    Paper,
    Results,
    paper,
    papers,
    reproduce,
)
from rover_pin.analysis.papers.finding import claimed, compared, fitted
from rover_pin.analysis.papers.polibot import comparison, ground, sweeps, tables, wall
from rover_pin.analysis.papers.polibot.reading import front_wheel, read, rear_wheel
from rover_pin.cli import main
from rover_pin.errors import StudyError

KEYS = {"quantity", "unit", "paper", "ours", "verdict", "reason"}


def verdict(ours: float, **others: Any) -> str:
    return compared("x", "mm", 10.0, ours, within=0.5, where="Table 1", **others).verdict


def test_a_number_is_judged_by_what_the_statement_leaves_open() -> None:
    assert verdict(10.5) == REPRODUCED
    assert verdict(9.5, used=True) == IN_SAMPLE
    assert verdict(10.5, at_most=PARTLY) == PARTLY
    assert verdict(11.4) == verdict(11.4, used=True) == PARTLY
    assert verdict(8.4) == verdict(8.4, used=True) == NOT_REPRODUCED


def test_what_does_not_come_out_is_not_reproduced() -> None:
    row = compared("x", "mm", 10.0, math.nan, within=0.5, where="Table 1", why="it tips")
    assert (row.ours, row.verdict, row.reason) == (None, NOT_REPRODUCED, "no value comes out; it tips")
    assert claimed("x", "", "four", None, True, where="Fig. 1", why="-").verdict == NOT_REPRODUCED


def test_statements_in_words_hold_or_do_not() -> None:
    def judged(holds: bool, **others: Any) -> str:
        return claimed("x", "", "falls", -1.0, holds, where="Fig. 1", why="slope", **others).verdict

    assert judged(True) == REPRODUCED
    assert judged(True, used=True) == IN_SAMPLE
    assert judged(True, at_most=PARTLY) == PARTLY
    assert judged(False) == judged(False, used=True) == NOT_REPRODUCED


def test_fitted_values_are_never_reproduced() -> None:
    assert fitted("x", "mm", 10.0, 10.0, where="Table 1", why="fitted").verdict == IN_SAMPLE
    assert fitted("x", "mm", 10.0, 99.0, where="Table 1", why="fitted").verdict == IN_SAMPLE


def test_a_row_says_how_far_it_is_off() -> None:
    row = Finding("x", "deg", -2.0, -1.5, PARTLY, "near", "Table 1", measured=-2.5).as_row()
    assert set(row) >= KEYS
    assert row["error"] == 0.5
    assert row["error_percent"] == 25.0
    assert row["error_to_measured_percent"] == 40.0
    assert Finding("x", "", "falls", 1.0, REPRODUCED, "it does").as_row()["error_percent"] is None


def test_findings_refuse_other_verdicts_and_silence() -> None:
    with pytest.raises(
        ValueError, match="x: 'good' is none of reproduced, partly, not reproduced, in sample"
    ):
        Finding("x", "", 1.0, 1.0, "good", "because")
    with pytest.raises(ValueError, match="a verdict needs its reason"):
        Finding("x", "", 1.0, 1.0, REPRODUCED, "")


def test_papers_are_found_by_their_files() -> None:
    assert list(papers()) == sorted(papers())
    found = paper("polibot")
    assert found.key == "polibot"
    assert found.robots == ("polibot_half", "x_suspension")
    with pytest.raises(StudyError, match=r"PAPER: no such paper \(got 'polybot'\); did you mean 'polibot'\?"):
        paper("polybot")


# The command, with a paper of two rows.


def _little(robots: Mapping[str, Any]) -> Results:
    x = np.linspace(0.0, 1.0, 5)
    panel = Panel("z [mm]", (Curve("ours", x, x**2),), (Mark(0.5, None, "paper: here"),))
    rows = (
        Finding("height", "mm", 1.0, 1.0, REPRODUCED, "equal <&>", "Table 1", measured=1.1),
        Finding("width", "mm", 2.0, None, NOT_REPRODUCED, "not computed", "Fig. 2"),
    )
    return Results(rows, (Chart("fig_2", "Fig. 2: width", "x [mm]", (panel,), "a note"),))


@pytest.fixture
def little(monkeypatch: pytest.MonkeyPatch) -> Paper:
    made = Paper("little", "A little paper", "Nobody, 1999", (), _little, ("a remark",))
    monkeypatch.setattr(registry, "papers", lambda: {"little": made})
    monkeypatch.setattr("rover_pin.cli.reproduce_report.papers", lambda: {"little": made})
    return made


def test_the_command_prints_rows_as_json(little: Paper, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["reproduce", "little", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert all(set(row) >= KEYS for row in rows)
    assert [row["ours"] for row in rows] == [1.0, None]
    assert [row["verdict"] for row in rows] == [REPRODUCED, NOT_REPRODUCED]


def test_the_command_prints_a_table_and_why(little: Paper, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["reproduce", "little"]) == 0
    told = capsys.readouterr().out
    assert told.startswith("A little paper\nNobody, 1999\n")
    for words in ("Table 1", "measured", "not computed", "- a remark"):
        assert words in told
    assert "2 rows: 1 reproduced, 0 partly, 1 not reproduced, 0 in sample" in told


def test_the_command_writes_a_page_and_pictures(
    little: Paper, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page, pictures = tmp_path / "p.html", tmp_path / "pictures"
    assert main(["reproduce", "little", "--html", str(page), "--png", str(pictures)]) == 0
    assert [each.name for each in pictures.iterdir()] == ["fig_2.png"]
    assert (pictures / "fig_2.png").read_bytes().startswith(b"\x89PNG")
    text = page.read_text(encoding="utf-8")
    assert "{{" not in text
    assert "equal &lt;&amp;&gt;" in text
    assert "data:image/svg+xml;base64," in text
    assert "<script" not in text
    assert f"wrote {page}" in capsys.readouterr().err


def test_the_command_lists_papers(little: Paper, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["reproduce"]) == 0
    assert "little" in capsys.readouterr().out
    assert main(["reproduce", "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == [
        {"paper": "little", "title": "A little paper", "citation": "Nobody, 1999"}
    ]


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["littel"], "error: PAPER: no such paper (got 'littel'); did you mean 'little'?\n"),
        (
            ["--html", "x.html"],
            "error: a page or pictures of which paper; rover-pin reproduce PAPER --html FILE\n",
        ),
        (["little", "--html", "none/x.html"], "error: none: there is no such folder; make it first\n"),
    ],
)
def test_bad_input_is_one_line(
    little: Paper, capsys: pytest.CaptureFixture[str], words: list[str], told: str
) -> None:
    assert main(["reproduce", *words]) == 2
    assert capsys.readouterr().err == told


def test_pictures_do_not_go_into_a_file(
    little: Paper, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "taken").write_text("")
    assert main(["reproduce", "little", "--png", str(tmp_path / "taken")]) == 2
    assert "is not a folder; name a folder for the pictures" in capsys.readouterr().err


# Polibot.


@pytest.fixture(scope="module")
def half() -> rp.Rover:
    return rp.load("polibot_half")


@pytest.fixture(scope="module")
def section_5_1(half: rp.Rover) -> dict[str, Finding]:
    return {row.quantity: row for row in tables.findings(tables.Stances(half))}


def test_tables_6_to_8_are_in_sample_and_near(section_5_1: dict[str, Finding]) -> None:
    rows = [row for row in section_5_1.values() if row.where.startswith("Table")]
    assert len(rows) == 13
    for row in rows:
        assert row.verdict == IN_SAMPLE
        assert row.measured is not None
        assert row.error is not None
        assert abs(row.error) < (0.15 if row.unit == "mm" else 0.05)


def test_misprints_in_the_prose_are_not_reproduced(section_5_1: dict[str, Finding]) -> None:
    for name in ("55 mm under W3: pitch in the prose", "55 mm under W6: rise of pitch in the prose"):
        assert section_5_1[name].verdict == NOT_REPRODUCED
    assert section_5_1["55 mm under W6: rise of pitch in the prose"].ours == pytest.approx(2.90, abs=0.01)


def test_rows_are_computed_from_the_robot(half: rp.Rover, section_5_1: dict[str, Finding]) -> None:
    other = tables.findings(tables.Stances(half.with_parameters(com_x=0.06)))
    for row in other:
        if row.where.startswith("Table"):
            assert row.ours != section_5_1[row.quantity].ours
            assert row.verdict == IN_SAMPLE
            assert row.paper == section_5_1[row.quantity].paper


def test_readings_are_the_papers(half: rp.Rover) -> None:
    assert (front_wheel(half), rear_wheel(half)) == ("w3", "w6")
    found = read(rp.settle(half, rp.Terrain.flat()))
    loads = np.array(list(found.loads.values()))
    assert found.touching == 4
    assert found.spread == pytest.approx(math.sqrt(np.mean((loads - loads.mean()) ** 2)) / loads.mean())
    assert sum(found.loads.values()) == pytest.approx(48.1 * 9.81)


def test_an_obstacle_is_under_one_wheel_only(half: rp.Rover) -> None:
    rest = rp.settle(half, rp.Terrain.flat())
    stance = ground.on_obstacle(half, "w3", 0.055, rest)
    heights = {contact.wheel: contact.point[2] for contact in stance.contacts}
    assert heights == pytest.approx({"w3": 0.055, "w4": 0.0, "w5": 0.0, "w6": 0.0}, abs=1e-9)
    assert stance.tensions["track"] == pytest.approx(237.3, abs=0.1)


def test_what_lifts_a_wheel_is_the_nearest_change() -> None:
    change = np.linspace(-2.0, 2.0, 5)
    flat = np.zeros(5)
    s = sweeps.Sweep("p", change, flat, np.array([3.0, 3, 4, 4, 3]), flat, flat, flat)
    assert s.lifted(-1.0) == -1.0
    assert s.lifted(1.0) == 2.0
    assert math.isnan(sweeps.Sweep("p", change, flat, np.full(5, 4.0), flat, flat, flat).lifted(1.0))


def test_sweeps_say_what_the_text_says(half: rp.Rover) -> None:
    mass = sweeps.sweep(half, "mass", 0.0, 80.0, 17)
    assert mass.change == pytest.approx(np.linspace(0.0, 80.0, 17))
    heavier = rp.settle(half.with_parameters(mass=48.1 * 1.2), rp.Terrain.flat())
    assert mass.at(20.0, "tension") == pytest.approx(heavier.tensions["track"], abs=1e-5)
    rows = {row.quantity: row for row in sweeps._mass(mass)}
    assert rows["mass +20 %: fall of pitch"].verdict == IN_SAMPLE
    assert rows["mass +65 %: tension, of the baseline's"].verdict == IN_SAMPLE
    assert rows["mass at which sigma_N is largest"].verdict == NOT_REPRODUCED
    assert "first rise" in rows["mass at which sigma_N is largest"].reason


def test_the_first_height_without_tension_and_the_crossing() -> None:
    height = np.linspace(0.0, 65.0, 66)
    flat = np.full(66, 4.0)
    ours = comparison.Climb(65.0, height, flat, flat, 0.5 - 0.002 * height, np.full(66, 200.0))
    tension = np.maximum(300.0 - 300.0 * height / 20.5, 0.0)
    theirs = comparison.Climb(65.0, height, flat, flat, 0.4 + 0.003 * height, tension)
    rows = {row.quantity: row for row in comparison._findings(ours, theirs)}
    ends = rows["X-shaped: height at which the tension ends, of the radius"]
    assert ends.ours == pytest.approx(100.0 * 20.5 / 65.0)
    crossing = rows["height at which Polibot's sigma_N becomes the lower, of the radius"]
    assert crossing.ours == pytest.approx(100.0 * 20.0 / 65.0)
    assert crossing.verdict == PARTLY
    assert rows["Polibot: least tension up to 65 mm, of the first"].verdict == REPRODUCED


@pytest.mark.slow  # every figure of the paper, some thousand stances
def test_the_whole_of_polibot(half: rp.Rover) -> None:
    found = reproduce("polibot", {"polibot_half": half})
    rows = found.findings
    places = {row.where for row in rows}
    assert places >= {"Table 6", "Table 7", "Table 8", *(f"Fig. {k}" for k in (*range(12, 19), 20, 21))}
    assert all(row.verdict in VERDICTS and row.reason for row in rows)
    assert all(row.verdict == NOT_REPRODUCED for row in rows if row.where == "Fig. 12")
    assert {chart.key for chart in found.charts} >= {f"fig_{k}" for k in (*range(12, 19), 20, 21)}
    assert sum(found.verdicts.values()) == len(rows)
    assert len({(row.where, row.quantity) for row in rows}) == len(rows)


@pytest.mark.slow  # ledges that lift the robot far
def test_the_wall_climb_is_left_out_honestly(half: rp.Rover) -> None:
    rows, charts = wall.results(half, rp.settle(half, rp.Terrain.flat()))
    assert [row.verdict for row in rows] == [NOT_REPRODUCED] * 4
    assert rows[-1].ours is None
    assert charts[0].key == "fig_12"
    assert -45.0 < float(rows[1].ours or 0.0) < -35.0
