"""The study file: what it means, and what it says to mistakes."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from rover_pin.analysis import Study
from rover_pin.analysis.quantities import MAP, Choice, Span, quantity
from rover_pin.analysis.spec import DEFAULT_STUDY, StudySpec
from rover_pin.errors import StudyError

BASE = "robot: rocker_bogie\nterrain: flat\n"


def read(text: str, file: str = "s.yaml") -> StudySpec:
    return Study.from_text(text, file=file).spec


def test_the_default_study_reads_as_it_is_documented() -> None:
    spec = Study.default().spec
    assert Study.default().text == DEFAULT_STUDY
    assert spec.robot == "rocker_bogie"
    assert (spec.cases.sampler, spec.cases.n, spec.cases.seed) == ("sobol", 10000, 0)
    assert (spec.vary.x, spec.vary.y, spec.vary.yaw_deg) == (MAP, MAP, Span(0.0, 360.0))
    assert spec.vary.parameters == {"track": Span(1.0, 1.4)}
    assert spec.vary.friction == Choice((0.5,))
    assert spec.measures == ("loads", "polygon", "tip", "force_angle", "energy", "zmp", "clearance")


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        (0.5, Choice((0.5,))),
        ([0.5], Choice((0.5,))),
        ([0.3, 0.8], Span(0.3, 0.8)),
        ([1, 2, 3], Choice((1.0, 2.0, 3.0))),
        ({"values": [1, 2]}, Choice((1.0, 2.0))),
        ("1e-3", Choice((0.001,))),
        ({"from": 1, "to": 2, "by": 0.25}, Choice((1.0, 1.25, 1.5, 1.75, 2.0))),
        ({"from": 0, "to": 1, "by": 0.4}, Choice((0.0, 0.4, 0.8))),
        ({"from": 0, "to": 3, "count": 4}, Choice((0.0, 1.0, 2.0, 3.0))),
    ],
)
def test_quantities(written: object, meant: object) -> None:
    assert quantity(written) == meant


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (BASE + "cases: {n: 0}", "s.yaml: cases.n: should be greater than or equal to 1 (got 0)"),
        (BASE + "cases: {n: -5}", "s.yaml: cases.n: should be greater than or equal to 1 (got -5)"),
        (
            BASE + "cases: {sampler: sobal, n: 4}",
            "s.yaml: cases.sampler: should be 'sobol', 'random', 'saltelli', 'grid' or 'sensitivity' "
            "(got 'sobal')",
        ),
        (BASE + "case: {n: 4}", "s.yaml: case: unknown key; did you mean 'cases' or 'measures'?"),
        (BASE + "vary: {yaw: [0, 1]}", "s.yaml: vary.yaw: unknown key; did you mean 'yaw_deg' or 'y'?"),
        (
            BASE + "measures: [lods]",
            "s.yaml: measures: no such measure (got 'lods'); did you mean 'loads' or 'bounds'?",
        ),
        (BASE + "measures: [tip, tip]", "s.yaml: measures: names a measure twice (got 'tip, tip')"),
        (BASE + "gravity: .nan", "s.yaml: gravity: gravity is not a finite number (got nan); give m/s2"),
        (
            BASE + "gravity: -9.81",
            "s.yaml: gravity: gravity must be more than zero (got -9.81); give m/s2 or earth, moon, mars",
        ),
        (
            BASE + "gravity: mers",
            "s.yaml: gravity: gravity is not a number (got 'mers');"
            " did you mean 'mars' or 'ceres' or 'mercury'?",
        ),
        (
            BASE + "vary: {x: [5, 1]}",
            "s.yaml: vary.x: range is upside down (got [5.0, 1.0]); write the lesser number first",
        ),
        (
            BASE + "vary: {x: {from: 1, to: 0, by: 0.1}}",
            "s.yaml: vary.x: range is upside down (got [1.0, 0.0]); write the lesser number as `from`",
        ),
        (
            BASE + "vary: {x: {from: 0, to: 1}}",
            "s.yaml: vary.x: is no quantity (got {'from': 0, 'to': 1}); write [lo, hi], "
            "{values: [a, b, ...]}, {from: lo, to: hi, by: step} or {normal: {mean: 1, sd: 0.1}}",
        ),
        (
            BASE + "vary: {x: {from: 0, to: 1, by: 0}}",
            "s.yaml: vary.x.by: is no step (got 0); a positive step that makes at most 10000 values",
        ),
        (
            BASE + "vary: {x: {from: 0, to: 1, count: 1}}",
            "s.yaml: vary.x.count: is no count of values (got 1); at least 2",
        ),
        (
            BASE + "cases: {sampler: sensitivity, n: 5}",
            "s.yaml: cases.n: does not say how many cases sensitivities take; leave it out: there are "
            "four cases a parameter, and one",
        ),
        (
            BASE + "cases: {sampler: sobol, step: 0.1}",
            "s.yaml: cases.step: needs the sampler sensitivity (got 'sobol')",
        ),
        (BASE + "search: {trials: 5}", "s.yaml: search: has no goal; write minimise: load_spread, say"),
        (
            BASE + "search: {minimise: a, maximise: b}",
            "s.yaml: search: has two goals (got 'minimise and maximise'); keep one",
        ),
        (
            BASE + "search: {minimise: a, subject to: {b: 4}}",
            "s.yaml: search.subject_to.b: is no pair of bounds (got 4); write [least, most], or [null, most]",
        ),
        (BASE + "vary: {x: [.nan, 1]}", "s.yaml: vary.x: is not a finite number (got nan)"),
        (BASE + "vary: {friction: [0, 1]}", "s.yaml: vary.friction: must be more than zero (got 0.0)"),
        (
            BASE + "vary: {posture: []}",
            "s.yaml: vary.posture: names no posture; write [home], or leave it out",
        ),
        (
            BASE + "vary: {posture: [height=3]}",
            "s.yaml: vary.posture.posture: no such goal (got 'height=3'); write clearance=M, or a name",
        ),
        (
            BASE + "payload: [{kg: -1, at: [0, 0, 0]}]",
            "s.yaml: payload.0.kg: should be greater than 0 (got -1)",
        ),
        (BASE + "cases: {n: 4, n: 5}", "s.yaml:3: cases.n: stated twice, first in line 3; keep one"),
        (
            BASE + "cases: {n: 4, grid: {x: 2}}",
            "s.yaml: cases.n: n and grid both say how many (got 4); keep one",
        ),
        (
            "robot: r\nterrain: {rouf: {}}",
            "s.yaml: terrain: names no kind of terrain (got 'rouf'); did you mean 'rough'?",
        ),
        (
            "robot: r\nterrain: {slope: 3, flat: 0}",
            "s.yaml: terrain: names two terrains (got 'slope and flat'); keep one",
        ),
        (
            "robot: r\nterrain: {file: a.tif, spaceing: 1}",
            "s.yaml: terrain.spaceing: unknown key; did you mean 'spacing'?",
        ),
        ("robot: r\nterrain: {rough: {hurst: 0.5}}", "s.yaml: terrain.rough.rms: is missing"),
        ("terrain: flat", "s.yaml: robot: is missing"),
        ("robot: 5\nterrain: flat", "s.yaml: robot: should be a word (got 5)"),
        (BASE + "cases: 3", "s.yaml: cases: should be a mapping of keys to values (got 3)"),
        (BASE + "payload: 3", "s.yaml: payload: should be a list (got 3)"),
        ("", "s.yaml: is no mapping of keys to values (got 'nothing'); start with `robot: NAME`"),
        (
            "a: [1",
            "s.yaml:1: not YAML: did not find expected ',' or ']'; check indentation, colons and brackets",
        ),
    ],
)
def test_mistakes_get_one_line(text: str, message: str) -> None:
    with pytest.raises(StudyError, match=f"^{re.escape(message)}$"):
        read(text)


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    path = tmp_path / "none.yaml"
    with pytest.raises(StudyError, match=f"^{re.escape(str(path))}: no such file$"):
        Study.from_file(path)
    with pytest.raises(StudyError, match=r"is a folder, not a study file$"):
        Study.from_file(tmp_path)


def test_a_binary_file_is_no_study(tmp_path: Path) -> None:
    path = tmp_path / "s.yaml"
    path.write_bytes(b"\xff\xfe\x00robot")
    with pytest.raises(StudyError, match=r"is not text in UTF-8; give a study file in YAML$"):
        Study.from_file(path)


def test_yaml_is_read_safely() -> None:
    with pytest.raises(StudyError, match=r"^s\.yaml:1: not YAML: could not determine a constructor"):
        read("robot: !!python/object/apply:os.system ['true']\nterrain: flat")


def test_python_words_mean_the_same_as_the_file() -> None:
    made = Study("rocker_bogie", {"slope": 5}, cases={"n": 8}, vary={"x": [0, 1]}, measures=["tip"])
    read_back = Study.from_text(made.text)
    assert made.spec == read_back.spec


def test_python_mistakes_name_the_argument() -> None:
    with pytest.raises(
        StudyError, match=r"^study\.cases\.n: should be greater than or equal to 1 \(got 0\)$"
    ):
        Study("rocker_bogie", "flat", cases={"n": 0})
