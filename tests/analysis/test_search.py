"""Searches: worth and bounds, what is repeated, what fails, what is told."""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import rover_pin as rp
from rover_pin.analysis import Study, search
from rover_pin.analysis.dataset import read
from rover_pin.analysis.search_score import FAR, NOTHING, score
from rover_pin.analysis.search_spec import SearchSpec
from rover_pin.cli import main
from rover_pin.errors import InputError, StudyError
from rover_pin.viz.page.search import search_page

VARY = {"parameters": {"com_x": [-0.2, 0.2], "bogie_fraction": [0.4, 0.6]}}
SLOPE = {"slope": 10}
GOAL = {"minimise": "load_spread", "subject to": {"load_n": [None, 250]}, "trials": 40}


def study(terrain: Any = SLOPE, vary: Any = VARY, **goal: Any) -> Study:
    return Study("rocker_bogie", terrain, vary=vary, measures=["tip"], search={**GOAL, **goal})


@pytest.fixture(scope="module")
def data() -> xr.Dataset:
    return search(study())


def test_the_best_keeps_its_bounds_and_beats_the_nominal_design(data: xr.Dataset) -> None:
    kept = data.violation.values <= 0
    best = data.attrs["best_trial"]
    assert data.objective.values[best] == data.objective.values[kept].min()
    assert data.objective.values[best] < 0.8 * data.objective.values[0]
    np.testing.assert_array_equal(kept, (data.load_n <= 250).all("wheel").values)
    np.testing.assert_array_equal(data.objective, data.load_spread)
    assert (data.com_x[0], data.bogie_fraction[0]) == (0.0, 0.5)


def test_the_best_is_what_settle_says(data: xr.Dataset) -> None:
    best = data.isel(case=data.attrs["best_trial"])
    rover = rp.load("rocker_bogie", com_x=float(best.com_x), bogie_fraction=float(best.bogie_fraction))
    loads = list(rp.settle(rover, rp.Terrain.slope(10)).loads.values())
    assert float(best.load_spread) == pytest.approx(np.std(loads) / np.mean(loads), abs=1e-9)


def test_one_seed_one_search(data: xr.Dataset) -> None:
    again, other = search(study(trials=12)), search(study(trials=12, seed=1))
    np.testing.assert_array_equal(again.objective, data.objective[:12])
    assert not np.array_equal(again.objective, other.objective)


def test_several_places_count_by_mean_or_worst() -> None:
    rough = {"rough": {"seed": 1, "rms": 0.05, "hurst": 0.8, "size": 8}}
    vary = {**VARY, "x": [-1, 1], "y": [-1, 1]}
    mean, worst = (search(study(rough, vary, trials=3, over=over)) for over in ("mean", "worst"))
    assert mean.attrs["places"] == 20
    assert mean.sizes["case"] == 60
    spreads = mean.load_spread.values[:20]
    assert float(mean.objective[0]) == pytest.approx(spreads.mean())
    assert float(worst.objective[0]) == spreads.max()


def test_designs_that_never_settle_are_penalised_and_told(tmp_path: Path, capsys: Any) -> None:
    steep = search(study({"slope": 75}, trials=3))
    assert steep.attrs["best_trial"] == -1
    assert steep.objective.values.tolist() == [NOTHING] * 3
    assert steep.violation.values.tolist() == [FAR] * 3
    assert "none keeps every bound" in search_page(steep)
    spec = tmp_path / "s.yaml"
    spec.write_text(
        "robot: rocker_bogie\nterrain: {slope: 75}\nvary: {parameters: {com_x: [-0.1, 0.1]}}\n"
        "search: {minimise: load_spread, trials: 2}\n"
    )
    assert main(["search", str(spec), "-o", str(tmp_path / "s.nc")]) == 1
    assert "no trial keeps every bound; the nearest, trial 0: load_spread -" in capsys.readouterr().out


def test_worth_and_violations_by_hand() -> None:
    spec = SearchSpec.model_validate(
        {"maximise": "tip", "subject to": {"tension_n": [100, 400]}, "over": "worst"}
    )
    figures = {"tip": np.array([0.5, 0.4, np.nan]), "tension_n/a": np.array([150.0, 500.0, np.nan])}
    figures["tension_n/b"] = np.array([90.0, 100.0, np.nan])
    told, broken = score(spec, figures, np.array([True, True, False]))
    assert told == 0.4
    assert broken == pytest.approx([100 / 400, 1 / 3])
    assert score(spec, figures, np.zeros(3, dtype=bool)) == (-NOTHING, [FAR, FAR])


@pytest.mark.parametrize(
    ("goal", "message"),
    [
        (
            {"minimise": "load_spred"},
            "search: no such figure (got 'load_spred'); did you mean 'load_spread' or",
        ),
        ({"subject to": {"tensio": [0, 1]}}, "search.subject_to: no such figure (got 'tensio')"),
    ],
)
def test_unknown_figures(goal: Any, message: str) -> None:
    with pytest.raises(StudyError, match=re.escape(message)):
        search(study(**goal))


def test_nothing_to_search() -> None:
    with pytest.raises(StudyError, match=r"vary\.parameters: no parameter varies; give them ranges"):
        search(study(vary={"x": 0}))
    with pytest.raises(StudyError, match="search: has no search; write search: "):
        search(Study("rocker_bogie", "flat", vary=VARY))
    with pytest.raises(StudyError, match="search: asks for a search; run it with rover-pin search"):
        study().run()


def test_without_optuna_the_cure_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "optuna", None)
    message = "search: Optuna is not installed, which searches; pip install 'rover-pin[search]'"
    with pytest.raises(InputError, match=re.escape(message)):
        search(study())


def test_the_command_writes_a_file_and_a_page(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    spec, out, page = (tmp_path / f"s.{end}" for end in ("yaml", "nc", "html"))
    spec.write_text(
        "robot: rocker_bogie\nterrain: flat\nvary: {parameters: {com_x: [-0.2, 0.2]}}\nmeasures: [tip]\n"
        "search: {maximise: tip, subject_to: {pitch_deg: [-1, 1]}, trials: 6}\n"
    )
    assert main([str(word) for word in ("search", spec, "-o", out, "--html", page, "--json")]) == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["trials"], told["goal"], told["better"]) == (6, "tip", "high")
    assert told["best"]["objective"] >= told["nominal"]["objective"]
    assert set(told["best"]["parameters"]) == {"com_x"}
    again = read(out)
    assert float(again.objective.max()) == told["best"]["objective"]
    assert page.read_text().count("data:image/svg+xml") == 2
