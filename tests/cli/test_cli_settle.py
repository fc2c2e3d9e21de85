"""`settle`, `info` and `robots`: objects, tables, exit statuses, one line for mistakes."""

from __future__ import annotations

import json
import math
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from rover_pin.cli import main
from rover_pin.cli.output import plain

Run = tuple[int, str, str]

LONE_BOX = """<robot name="box"><link name="base"><inertial><mass value="2"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>"""


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Any:
    def call(*words: object) -> Run:
        status = main([str(word) for word in words])
        told = capsys.readouterr()
        return status, told.out, told.err

    return call


def test_settle_prints_the_object_of_the_contract(run: Any) -> None:
    status, out, err = run("settle", "rocker_bogie", "--json")
    told = json.loads(out)
    assert (status, err) == (0, "")
    assert set(told) == {
        *("robot", "status", "base", "joints", "wheels", "tensions_n", "springs_n", "stability", "residuals"),
        *("redundant", "undetermined", "reason", "notes", "gravity", "payload", "unanswered"),
    }
    _, out, _ = run("settle", "rocker_bogie", "--resistance", "30", "--json")
    pulled = json.loads(out)
    assert set(pulled) == {*told, "tight_tensions_n", "tractions_n", "traction_ratio"}
    assert pulled["traction_ratio"] == pytest.approx(30 / (132 * 9.81), rel=1e-9)
    assert sum(pulled["tractions_n"].values()) == pytest.approx(30, rel=1e-9)
    assert (told["robot"], told["status"], told["reason"]) == ("rocker_bogie", "settled", "")
    assert set(told["base"]) == {"position_m", "rpy_rad"}
    assert set(told["wheels"]) == {"fl", "ml", "bl", "fr", "mr", "br"}
    assert set(told["wheels"]["fl"]) == {"load_n", "gap_m", "contacts"}
    assert set(told["wheels"]["fl"]["contacts"][0]) == {"point_m", "normal", "load_n"}
    assert sum(wheel["load_n"] for wheel in told["wheels"].values()) == pytest.approx(132 * 9.81, rel=1e-9)
    assert set(told["residuals"]) == {"equilibrium", "gap_m", "loop_m", "complementarity"}
    names = {"polygon", "tip", "force_angle", "energy", "zmp", "friction", "torque", "loads", "clearance"}
    assert names <= set(told["stability"])
    assert set(told["stability"]["tip"]) >= {"value", "unit", "limiting", "edges"}
    assert told["stability"]["tip"]["unit"] == "rad"


def test_options_reach_settle(run: Any) -> None:
    words = ["settle", "rocker_bogie", "--json", "--terrain", "slope:5", "--at=-1,2,30", "--gravity", "moon"]
    words += [
        "--payload",
        "10@0,0,0.3",
        "--param",
        "track=1.1",
        "--joint",
        "steer_fl=0.2",
        "--posture",
        "home",
    ]
    status, out, _ = run(*words)
    told = json.loads(out)
    assert status == 0
    assert told["base"]["position_m"][:2] == [-1, 2]
    assert told["base"]["rpy_rad"][2] == pytest.approx(math.radians(30))
    assert told["joints"]["steer_fl"] == 0.2
    assert sum(w["load_n"] for w in told["wheels"].values()) == pytest.approx(142 * 1.62, rel=1e-9)


def test_a_place_may_begin_with_a_minus_either_way(run: Any) -> None:
    one = run("settle", "rocker_bogie", "--json", "--at=-1,2,30")
    other = run("settle", "rocker_bogie", "--json", "--at", "-1,2,30")
    assert one == other
    assert one[0] == 0


def test_the_friction_given_reaches_the_measures(run: Any) -> None:
    def asked(mu: str) -> Any:
        words = ["settle", "rocker_bogie", "--terrain", "slope:10", "--friction", mu, "--json"]
        return json.loads(run(*words)[1])["stability"]["friction"]["value"]

    assert asked("0.8") - asked("0.5") == pytest.approx(0.3, abs=1e-6)


def test_not_settled_is_one_and_prints_all_the_same(run: Any) -> None:
    status, out, err = run("settle", "rocker_bogie", "--terrain", "slope:75", "--json")
    told = json.loads(out)
    assert status == 1
    assert err == ""
    assert told["status"] == "tips"
    assert told["reason"]
    assert told["stability"] == told["unanswered"] == {}
    assert all(wheel["load_n"] is None for wheel in told["wheels"].values())


def test_measures_without_an_answer_say_why(run: Any) -> None:
    _, out, _ = run("settle", "rocker_bogie", "--json")
    assert json.loads(out)["unanswered"] == {}
    path = str(Path(__file__).parents[1] / "fixtures" / "trailing4" / "trailing4.urdf")
    told = json.loads(run("settle", path, "--json")[1])["unanswered"]
    assert told == {
        "clearance": "trailing4 declares no belly points",
        "feasible": "the region is a line",
        "region": "the region is a line",
    }
    lines = run("settle", path)[1].splitlines()
    assert {f"{name}: {why}" for name, why in told.items()} <= set(lines)


def test_tables_are_for_people(run: Any) -> None:
    status, out, _ = run("settle", "rocker_bogie")
    assert status == 0
    assert out.startswith("rocker_bogie on flat: settled\n")
    assert re.search(r"fl\s+215\.82\s+16\.7", out)
    assert "tip" in out
    status, out, _ = run("settle", "rocker_bogie", "--terrain", "slope:75")
    assert status == 1
    assert out.startswith("rocker_bogie on slope:75: tips: ")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (
            ["settle", "rocker_bogi"],
            "no bundled robot of that name (got 'rocker_bogi'); did you mean 'rocker_bogie'?",
        ),
        (["settle", "none.urdf"], "none.urdf: no such file"),
        (["settle", "rocker_bogie", "--at", "1"], "--at: is not X,Y,YAW_DEG (got '1'); write --at 1.5,-2,30"),
        (["settle", "rocker_bogie", "--at", "nan,0,0"], "--at: is not a finite number (got 'nan')"),
        (["settle", "rocker_bogie", "--posture", "hme"], "posture: no posture of that name (got 'hme')"),
        (["settle", "rocker_bogie", "--posture", "height=3"], "posture: no such goal (got 'height=3')"),
        (["settle", "rocker_bogie", "--joint", "steer_fl"], "--joint: is not NAME=VALUE (got 'steer_fl')"),
        (["settle", "rocker_bogie", "--joint", "ster_fl=1"], "joint ster_fl: no moving joint of that name"),
        (
            ["settle", "rocker_bogie", "--joint", "a=1", "--joint", "a=2"],
            "--joint a: is given twice; keep one",
        ),
        (["settle", "rocker_bogie", "--param", "trak=1"], "parameter trak: no parameter of that name"),
        (
            ["settle", "rocker_bogie", "--param", "sidecar=1"],
            "--param sidecar: no parameter can have that name",
        ),
        (["settle", "rocker_bogie", "--gravity", "0"], "gravity must be more than zero (got '0')"),
        (["settle", "rocker_bogie", "--gravity", "pluto"], "gravity is not a number (got 'pluto')"),
        (
            ["settle", "rocker_bogie", "--payload", "5@1,2"],
            "--payload: is not KG@X,Y,Z or KG@FRAME (got '5@1,2')",
        ),
        (["settle", "rocker_bogie", "--payload", "-5@0,0,0"], "--payload: mass must be more than zero"),
        (["settle", "rocker_bogie", "--friction", "-1"], "--friction: must be more than zero (got '-1')"),
        (["settle", "rocker_bogie", "--terrain", "flatt"], "did you mean 'flat'"),
        (["settle", "rocker_bogie", "--spacing", "x"], "Invalid value for '--spacing'"),
        (
            ["settle", "rocker_bogie", "--html", "/nowhere/x.html"],
            "/nowhere: there is no such folder; make it first",
        ),
        (["settle"], "Missing argument 'ROBOT'; rover-pin --help lists commands and options"),
        (["setle", "x"], "No such command 'setle'"),
        (["settle", "x", "--bogus"], "No such option: --bogus"),
        (["info", "rocker_bogie", "--sidecar", "no.yaml"], "no.yaml: no such file"),
        (["view", "no.nc"], "no.nc: no such file; make one with rover-pin study -o"),
        (["view", "rocker_bogie", "--case", "3"], "--case: cases belong to a study's result"),
    ],
)
def test_bad_input_is_one_line_and_two(
    run: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, words: list[str], message: str
) -> None:
    monkeypatch.chdir(tmp_path)
    status, out, err = run(*words)
    assert (status, out) == (2, "")
    assert err.startswith("error: ")
    assert err.count("\n") == 1
    assert message in err
    assert list(tmp_path.iterdir()) == []


def test_off_the_map_is_an_error_for_a_start(run: Any) -> None:
    status, out, err = run("settle", "rocker_bogie", "--terrain", "rough:1,0.05,0.8", "--at", "50,0,0")
    assert (status, out) == (2, "")
    assert err.startswith("error: ")
    assert err.count("\n") == 1


def test_a_page_is_written_and_named_beside_the_object(run: Any, tmp_path: Path) -> None:
    page = tmp_path / "stance.html"
    status, out, err = run("settle", "rocker_bogie", "--json", "--html", page)
    assert status == 0
    assert json.loads(out)["status"] == "settled"
    assert err == f"wrote {page}\n"
    assert page.read_text()[:200].lower().lstrip().startswith("<!doctype html")


def test_a_picture_without_a_browser_writes_nothing(
    run: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    status, out, err = run(
        "settle", "rocker_bogie", "--html", tmp_path / "s.html", "--png", tmp_path / "s.png"
    )
    assert (status, out) == (2, "")
    assert err.startswith("error: png: no Chromium or Chrome on PATH")
    assert list(tmp_path.iterdir()) == []


def test_info_tells_and_notes(run: Any, tmp_path: Path) -> None:
    status, out, _ = run("info", "rocker_bogie", "--json")
    told = json.loads(out)
    assert status == 0
    wanted = {"mass_kg", "joints", "wheels", "loops", "couplings", "springs", "mobility", "rank", "notes"}
    assert wanted <= set(told)
    assert told["mass_kg"] == pytest.approx(132)
    assert isinstance(told["notes"], list)
    box = tmp_path / "box.urdf"
    box.write_text(LONE_BOX)
    status, out, _ = run("info", box)
    assert status == 0
    assert out.startswith("box: 2 kg")
    assert "note: no sidecar" in out


def test_robots_lists_what_is_bundled(run: Any) -> None:
    status, out, _ = run("robots", "--json")
    assert status == 0
    assert {"rocker_bogie", "hit_mrii"} <= {each["name"] for each in json.loads(out)}
    assert "rocker_bogie" in run("robots")[1]


def test_help_needs_nothing_heavy() -> None:
    script = (
        "import sys\nfrom rover_pin.cli import main\nmain([])\n"
        "heavy = {'numpy', 'pinocchio', 'numba', 'xarray', 'scipy', 'pydantic', 'matplotlib', 'meshcat'}\n"
        "sys.exit(', '.join(sorted(heavy & set(sys.modules))) or 0)\n"
    )
    root = Path(__file__).parents[2]
    done = subprocess.run(
        [sys.executable, "-c", script],
        capture_output=True,
        text=True,
        cwd=root,
        env=dict(os.environ),
        check=False,
    )
    assert done.stderr == ""
    assert done.returncode == 0
    for name in ("robots", "info", "settle", "study", "view"):
        assert f"\n  {name} " in done.stdout


def test_json_has_no_number_that_is_none() -> None:
    assert plain({"a": math.inf, "b": [math.nan, 1.5], "c": {"d": (True, None, "x")}}) == {
        "a": None,
        "b": [None, 1.5],
        "c": {"d": [True, None, "x"]},
    }
