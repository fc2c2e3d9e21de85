"""Sensitivities: the designs that are asked, and slopes against what is known by other means."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import rover_pin as rp
from rover_pin.analysis import Study, sensitivity
from rover_pin.analysis.one_by_one import MOVES, probes
from rover_pin.analysis.quantities import Choice, Span
from rover_pin.analysis.spec import CasesSpec
from rover_pin.cli import main
from rover_pin.errors import StudyError
from rover_pin.viz.page.sensitivity import sensitivity_page

SPEC = CasesSpec(sampler="sensitivity")


def study(**more: Any) -> Study:
    cases = {"sampler": "sensitivity", "step": 0.01, **more}
    return Study("rocker_bogie", {"slope": 8}, cases=cases, vary={}, measures=["loads", "tip"])


@pytest.fixture(scope="module")
def data() -> xr.Dataset:
    return study().run()


@pytest.fixture(scope="module")
def slopes(data: xr.Dataset) -> xr.Dataset:
    return sensitivity(data)


def test_each_parameter_is_moved_alone(data: xr.Dataset) -> None:
    rover = rp.load("rocker_bogie")
    assert data.sizes["case"] == 1 + MOVES * len(rover.parameters)
    for k, (name, value) in enumerate(rover.parameters.items()):
        own = slice(1 + MOVES * k, 1 + MOVES * (k + 1))
        step = 0.01 * value if value else 0.01 * 0.6
        moves = data[name].values - value
        np.testing.assert_allclose(moves[own], np.array([-1, 1, -0.5, 0.5]) * step, rtol=1e-12)
        assert not np.delete(moves, np.arange(own.start, own.stop)).any()


def test_slopes_that_are_known(slopes: xr.Dataset) -> None:
    loads = slopes.slope.sel(figure=[f"load_n/{wheel.name}" for wheel in rp.load("rocker_bogie").wheels])
    np.testing.assert_allclose(loads.sel(parameter="body_mass").sum(), 9.81, rtol=1e-9)
    np.testing.assert_allclose(loads.sel(parameter="com_x").sum(), 0.0, atol=1e-6)
    height = slopes.slope.sel(figure="z_m", parameter="hinge_height")
    np.testing.assert_allclose(height, 1 / np.cos(np.deg2rad(8)), rtol=1e-9)
    np.testing.assert_allclose(
        slopes.per_percent.sel(parameter="body_mass"),
        slopes.slope.sel(parameter="body_mass") * slopes.nominal.sel(parameter="body_mass") / 100,
    )
    assert np.isnan(slopes.per_percent.sel(parameter="com_x")).all()
    assert (slopes.nonlinearity.sel(figure="z_m") < 1e-7).all()


@pytest.mark.parametrize("parameter", ["wheelbase", "com_x"])
def test_slopes_are_those_of_stances(slopes: xr.Dataset, parameter: str) -> None:
    def spread(value: float) -> float:
        rover = rp.load("rocker_bogie", **{parameter: value})
        loads = list(rp.settle(rover, rp.Terrain.slope(8)).loads.values())
        return float(np.std(loads) / np.mean(loads))

    value, step = rp.load("rocker_bogie").parameters[parameter], 1e-4
    wanted = (spread(value + step) - spread(value - step)) / (2 * step)
    ours = float(slopes.slope.sel(figure="load_spread", parameter=parameter))
    assert ours == pytest.approx(wanted, rel=1e-3)


def test_a_kink_and_a_curve_are_told(data: xr.Dataset) -> None:
    bent = data.isel(case=slice(0, 1 + MOVES)).copy(deep=True)
    for name in data.data_vars:
        if data[name].attrs.get("parameter") not in (None, "track"):
            bent = bent.drop_vars(name)
    move = bent.track.values - bent.track.values[0]
    bent["z_m"] = ("case", np.abs(move))
    bent["pitch_rad"] = ("case", move + 1e3 * move**3)
    told = sensitivity(bent).isel(parameter=0)
    assert float(told.slope.sel(figure="z_m")) == pytest.approx(0.0, abs=1e-12)
    assert float(told.kink.sel(figure="z_m")) == pytest.approx(2.0)
    step = 0.012
    far, near = 1 + 1e3 * step**2, 1 + 1e3 * step**2 / 4
    assert float(told.nonlinearity.sel(figure="pitch_rad")) == pytest.approx((far - near) / far)


def test_a_bound_in_the_way_makes_it_one_sided() -> None:
    told = probes(
        SPEC, {}, {"a": 1.0, "b": 2.0, "c": 0.0}, {"a": (1.0, 2.0), "b": (0.0, 2.0), "c": (0.0, 5.0)}
    )
    assert {name: asked.ends for name, asked in told.items()} == {
        "a": (1.0, 1.01),
        "b": (1.98, 2.0),
        "c": (0.0, pytest.approx(0.05)),
    }
    quadratic = np.array([1.0, 1.005, 1.01, 1.0025, 1.005]) ** 2
    from rover_pin.analysis.sensitivity import _slopes

    a = told["a"]
    assert isinstance(a, Choice)
    moves = np.array(a.values[1:]) - 1.0
    far, near, sides = _slopes(moves, (quadratic[1:] - 1.0)[None])
    assert (far[0], near[0]) == (pytest.approx(2.0), pytest.approx(2.0))
    assert np.isnan(sides).all()


@pytest.mark.parametrize(
    ("spec", "given", "bounds", "message"),
    [
        ({"to": ["mas"]}, {}, None, "cases.to: no such parameter (got 'mas'); did you mean 'mass'?"),
        (
            {},
            {"mass": Span(1.0, 2.0)},
            None,
            "vary.parameters.mass: varies (got [1.0, 2.0]); give one number",
        ),
        ({}, {"mass": Choice((0.0,))}, None, "mass: is 0, so that a share of it is no step; give it bounds"),
        (
            {},
            {},
            (3.99, 4.01),
            "mass: has bounds closer than a step (got [3.99, 4.01]); give a smaller cases.step",
        ),
    ],
)
def test_steps_that_cannot_be_taken(spec: Any, given: Any, bounds: Any, message: str) -> None:
    with pytest.raises(StudyError, match=re.escape(message)):
        probes(CasesSpec(sampler="sensitivity", **spec), given, {"mass": 4.0}, {"mass": bounds})


def test_only_some_and_at_another_design() -> None:
    told = study(to="com_x").run()
    assert told.sizes["case"] == 5
    assert list(sensitivity(told).parameter.values) == ["com_x"]
    away = Study(
        "rocker_bogie",
        "flat",
        cases={"sampler": "sensitivity", "to": ["track"]},
        vary={"parameters": {"track": 1.3, "wheelbase": 1.1}},
        measures=[],
    ).run()
    assert away.wheelbase.values.tolist() == [1.1] * 5
    assert float(away.track[0]) == 1.3


@pytest.mark.parametrize(
    "vary", [{"x": [0, 1]}, {"yaw_deg": [0, 10, 20]}, {"posture": ["home", "clearance=0.3"]}]
)
def test_one_place_only(vary: dict[str, Any]) -> None:
    asked = Study("rocker_bogie", "flat", cases="sensitivity", vary=vary)
    with pytest.raises(StudyError, match=rf"vary\.{next(iter(vary))}: varies; give one value"):
        asked.plan  # noqa: B018


def test_other_results_are_refused(data: xr.Dataset) -> None:
    with pytest.raises(StudyError, match="is no result of a study of sensitivity; run a study with cases"):
        sensitivity(data.assign_attrs(sampler="sobol"))
    tipped = data.copy()
    tipped["status"] = ("case", np.full(data.sizes["case"], "tips"))
    with pytest.raises(
        StudyError, match=re.escape("case 0: the nominal design does not settle (got 'tips')")
    ):
        sensitivity(tipped)


def test_the_page_ranks_parameters(slopes: xr.Dataset) -> None:
    text = sensitivity_page(slopes)
    assert "<script" not in text
    cardless = re.search(r"<h2>Height of the root link</h2>(.*?)</section>", text, re.S)
    assert cardless is not None
    assert re.findall(r'<span title="[^"]*">([^<]+)</span>', cardless[1]) == ["hinge height"]
    assert "Nothing moves" in text


def test_the_command_tells_them(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    spec, page = tmp_path / "s.yaml", tmp_path / "s.html"
    spec.write_text(
        "robot: rocker_bogie\nterrain: flat\ncases: {to: [body_mass, com_x]}\nmeasures: [loads]\n"
    )
    words = ["study", spec, "-o", tmp_path / "s.nc", "--engine", "serial", "--html", page]
    assert main([str(word) for word in [*words, "--json"]]) == 0
    told = json.loads(capsys.readouterr().out)
    assert set(told["sensitivities"]["load_spread"]) == {"body_mass", "com_x"}
    assert told["sensitivities"]["z_m"]["com_x"]["slope"] == 0
    assert "sensitivities" in page.read_text()
    assert main([str(word) for word in words]) == 0
    assert re.search(r"load_n/fl +body_mass +84 kg", capsys.readouterr().out)
