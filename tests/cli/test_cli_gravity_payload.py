"""`--gravity` and `--payload` on every command that stands a rover somewhere."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
import pytest
import xarray as xr

import rover_pin as rp
from rover_pin import viz
from rover_pin.analysis import Study
from rover_pin.cli import main

Run = tuple[int, str, str]

STUDY = """\
robot: rocker_bogie
terrain: {slope: 8}
cases: {n: 3}
vary: {yaw_deg: [0, 360]}
measures: [tip]
payload: [{kg: 2, at: [0, 0, 0]}]
"""


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Any:
    def call(*words: object) -> Run:
        status = main([str(word) for word in words])
        told = capsys.readouterr()
        return status, told.out, told.err

    return call


def test_loads_scale_with_gravity_and_angles_do_not_change() -> None:
    rover, ground = rp.load("rocker_bogie"), rp.Terrain.slope(12.0)
    earth, moon = (rp.settle(rover, ground, yaw=0.7, gravity=g) for g in (9.81, 1.62))
    assert moon.rpy == pytest.approx(earth.rpy, abs=1e-10)
    assert moon.joints == pytest.approx(earth.joints, abs=1e-9)
    for name, load in earth.loads.items():
        assert moon.loads[name] == pytest.approx(load * 1.62 / 9.81, rel=1e-9)
    tips = [rp.stability(stance, ["tip"])["tip"].value for stance in (earth, moon)]
    assert tips[0] == pytest.approx(tips[1], abs=1e-9)


def test_a_payload_moves_the_centre_of_mass_as_by_hand() -> None:
    bare = rp.load("rocker_bogie")
    wheel = bare.wheels[0].link
    laden = bare.with_payload([(12.0, (0.3, -0.1, 0.4)), (7.0, wheel)])
    assert laden.mass == pytest.approx(bare.mass + 19.0)
    stance = rp.settle(laden, rp.Terrain.flat())
    data, q = bare.model.createData(), np.array(stance.configuration)
    own = pin.centerOfMass(bare.model, data, q)
    pin.updateFramePlacements(bare.model, data)
    root, axle = (data.oMf[bare.model.getFrameId(name, pin.FrameType.BODY)] for name in (bare.root, wheel))
    by_hand = (
        bare.mass * own + 12.0 * root.act(np.array([0.3, -0.1, 0.4])) + 7.0 * axle.translation
    ) / laden.mass
    assert stance.com == pytest.approx(by_hand, abs=1e-9)
    assert sum(stance.loads.values()) == pytest.approx((bare.mass + 19.0) * 9.81, rel=1e-9)


def test_a_joint_stands_for_the_link_it_moves_and_survives_other_parameters() -> None:
    bare = rp.load("rocker_bogie")
    by_joint, by_link = (bare.with_payload([(3.0, name)]) for name in ("rocker_l", "rocker_l_link"))
    assert by_joint.recipe.payload == by_link.recipe.payload == ((3.0, "rocker_l_link"),)
    assert by_link.with_parameters(track=1.1).mass == pytest.approx(bare.mass + 3.0)


def test_compiled_designs_carry_a_payload_on_a_link_like_the_plain_path() -> None:
    study = Study(
        "rocker_bogie",
        {"slope": 8},
        cases={"n": 4},
        vary={"yaw_deg": [0, 360], "parameters": {"track": [1.0, 1.4]}},
        measures=["tip"],
        payload=[{"kg": 20, "at": "bogie_l"}],
        gravity="mars",
    )
    data = study.run()
    assert not data["plain_path"].any()
    for case in range(4):
        stance = study.stance(case)
        assert data["load_n"].values[case] == pytest.approx(list(stance.loads.values()), abs=1e-5)
    assert data["load_n"].values.sum(axis=1) == pytest.approx(4 * [152 * 3.71], rel=1e-8)


def test_settle_and_info_tell_them(run: Any) -> None:
    words = ["--gravity", "Mars", "--payload", "10@rocker_l", "--payload", "5", "--json"]
    status, out, _ = run("settle", "rocker_bogie", *words)
    told = json.loads(out)
    assert status == 0
    assert (told["gravity"], told["payload"]) == (3.71, "10.0@rocker_l_link; 5.0@0.0,0.0,0.0")
    assert sum(w["load_n"] for w in told["wheels"].values()) == pytest.approx(147 * 3.71, rel=1e-9)
    facts = json.loads(run("info", "rocker_bogie", *words)[1])
    assert facts["mass_kg"] == pytest.approx(147)
    assert facts["weight_n"] == pytest.approx(147 * 3.71)
    out = run("info", "rocker_bogie", *words[:-1])[1]
    assert out.startswith("rocker_bogie: 147 kg (545.37 N at 3.71 m/s2), mobility")
    assert "payload: 10.0@rocker_l_link; 5.0@0.0,0.0,0.0\n" in out


def test_a_study_takes_them_over_its_file_and_its_result_says_so(run: Any, tmp_path: Path) -> None:
    spec, out = tmp_path / "s.yaml", tmp_path / "o.nc"
    spec.write_text(STUDY)
    words = ["--gravity", "moon", "--payload", "8@0,0,0.5", "--engine", "serial", "--json"]
    status, told, _ = run("study", spec, "-o", out, *words)
    told = json.loads(told)
    assert status == 0
    assert (told["gravity"], told["payload"]) == (1.62, "2.0@0.0,0.0,0.0; 8.0@0.0,0.0,0.5")
    with xr.open_dataset(out, engine="h5netcdf") as data:
        assert data["load_n"].values.sum(axis=1) == pytest.approx(3 * [142 * 1.62], rel=1e-8)
    again = Study.from_dataset(out).stance(1)
    assert (again.gravity, again.rover.mass) == (1.62, pytest.approx(142))


def test_slopes_and_mobility_record_them(run: Any, tmp_path: Path) -> None:
    rigid = Path(__file__).parents[1] / "fixtures" / "rigid4" / "rigid4.urdf"
    words = ["--gravity", "moon", "--payload", "1@0,0,0.1", "--json"]
    told = json.loads(run("slopes", rigid, "--headings", 1, *words)[1])
    assert (told["gravity"], told["payload"]) == (1.62, "1.0@0.0,0.0,0.1")
    out = ["-o", tmp_path / "m.nc", "--engine", "serial", "--headings", 1, "--every", 20, "--robot", rigid]
    status, told, err = run("mobility", "rough:1,0.01,0.8", *out, *words)
    assert (status, json.loads(told)["payload"]) == (0, "1.0@0.0,0.0,0.1"), err


def test_view_takes_them_for_a_robot(monkeypatch: pytest.MonkeyPatch, run: Any) -> None:
    seen: list[Any] = []

    def show(stance: Any, *, open_browser: bool = True) -> Any:
        seen.append(stance)
        raise rp.errors.InputError("seen")

    monkeypatch.setattr(viz, "show", show, raising=False)
    run("view", "rocker_bogie", "--gravity", "moon", "--payload", "8@0,0,0.5")
    assert sum(seen[0].loads.values()) == pytest.approx(140 * 1.62, rel=1e-9)


@pytest.mark.parametrize(
    ("words", "line"),
    [
        (["info", "rocker_bogie", "--gravity", "mecury"], "did you mean 'mercury'"),
        (["info", "rocker_bogie", "--gravity", "nan"], "gravity is not a finite number (got 'nan')"),
        (["info", "rocker_bogie", "--payload", "x"], "--payload: is not a finite number (got 'x')"),
        (["info", "rocker_bogie", "--payload", "0@arm"], "--payload: mass must be more than zero"),
        (
            ["info", "rocker_bogie", "--payload", "5@1,2"],
            "--payload: is not KG@X,Y,Z or KG@FRAME (got '5@1,2')",
        ),
        (["info", "rocker_bogie", "--payload", "5@1"], "--payload: is not KG@X,Y,Z or KG@FRAME (got '5@1')"),
        (["info", "rocker_bogie", "--payload", "5@bogie_left"], "did you mean 'bogie_l'"),
        (["view", "o.nc", "--gravity", "moon"], "--gravity: a result has its own (got 'o.nc')"),
        (["view", "o.nc", "--payload", "5"], "--payload: a result has its own (got 'o.nc')"),
    ],
)
def test_bad_words_are_one_line(run: Any, words: list[str], line: str) -> None:
    status, out, err = run(*words)
    assert (status, out) == (2, "")
    assert line in err
    assert err.count("\n") == 1
