"""Distributions, masses that vary, Sobol indices, probabilities: by closed forms and the plain path."""

from __future__ import annotations

import re
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pinocchio as pin
import pytest
import xarray as xr
from scipy import stats

from rover_pin import Terrain, load, settle
from rover_pin.analysis import Study, probabilities, sobol_indices
from rover_pin.analysis.cases import Questions
from rover_pin.analysis.draw import draw
from rover_pin.analysis.quantities import quantity
from rover_pin.analysis.spec import CasesSpec
from rover_pin.description.masses import Masses
from rover_pin.errors import StudyError
from rover_pin.viz.page.matters import matters_of

BASE = "robot: rocker_bogie\nterrain: flat\n"
LAWS = {
    "a": ({"normal": {"mean": 3, "sd": 0.5}}, stats.norm(3, 0.5)),
    "b": ({"triangular": {"low": 0, "mode": 1, "high": 4}}, stats.triang(0.25, 0, 4)),
    "c": ({"lognormal": {"s": 0.3, "scale": 2}}, stats.lognorm(0.3, scale=2)),
    "d": ({"normal": {"mean": 0, "sd": 1, "bounds": [-1, 2]}}, stats.truncnorm(-1, 2)),
    "e": ({"uniform": {"low": -1, "high": 2}}, stats.uniform(-1, 3)),
}
WEIGHT = {"a": 1.0, "b": 0.5, "c": 1.5, "d": -0.7, "e": 0.2}


def drawn(sampler: str, n: int) -> dict[str, np.ndarray]:
    asked = {name: quantity(raw) for name, (raw, _) in LAWS.items()}
    place = {name: quantity(0) for name in ("y", "x", "yaw_deg")}
    source = draw(Questions(place, None, asked, {}, ()), CasesSpec(sampler=sampler, n=n, seed=3))
    whole = source.drawer().run(0, len(source)).parameters
    part = source.drawer().run(5, 9).parameters
    for name in asked:
        np.testing.assert_array_equal(part[name], whole[name][5:9])
    return dict(whole)


@pytest.mark.parametrize("sampler", ["sobol", "random"])
def test_draws_follow_their_distributions(sampler: str) -> None:
    values = drawn(sampler, 4096)
    for name, (_, law) in LAWS.items():
        assert stats.kstest(values[name], law.cdf).pvalue > 0.01, name


def test_a_bounded_lognormal_is_the_conditional_one() -> None:
    law = stats.lognorm(0.5, scale=2)
    asked = quantity({"lognormal": {"s": 0.5, "scale": 2, "bounds": [1, 3]}})
    unit = np.linspace(0.01, 0.99, 21)
    mass = law.cdf(3) - law.cdf(1)
    np.testing.assert_allclose((law.cdf(asked.spread(unit)) - law.cdf(1)) / mass, unit, atol=1e-12)


def test_indices_of_an_additive_model() -> None:
    values = drawn("saltelli", 2048)
    y = sum(WEIGHT[name] * values[name] for name in LAWS)
    part = {name: WEIGHT[name] ** 2 * law.var() for name, (_, law) in LAWS.items()}
    known = np.array(list(part.values())) / sum(part.values())
    status = ("case", np.full(len(y), "settled"))
    data = xr.Dataset({"status": status}, attrs={"sampler": "saltelli", "inputs": "\n".join(LAWS), "seed": 0})
    found = sobol_indices(data, {"y": y, "still": np.ones_like(y)})
    np.testing.assert_allclose(found["first"].sel(figure="y"), known, atol=0.02)
    np.testing.assert_allclose(found["total"].sel(figure="y"), known, atol=0.02)
    assert (found.first_conf.sel(figure="y") < 0.1).all()
    assert np.isnan(found["first"].sel(figure="still")).all()

    y[[0, 1, 50]] = np.nan
    gappy = sobol_indices(data, {"y": y})
    assert (int(gappy.blocks[0]), int(gappy.dropped[0])) == (2046, 2)
    y[::7] = np.nan
    with pytest.raises(StudyError, match=r"too many blocks .* 2048 of 2048 blocks dropped"):
        sobol_indices(data, {"y": y})
    with pytest.raises(StudyError, match="is no result of a Saltelli sample"):
        sobol_indices(data.assign_attrs(sampler="sobol"))


def result(status: list[str], sampler: str = "random", **columns: list[float]) -> xr.Dataset:
    made = {name: ("case", np.array(v), {"better": "high", "units": "-"}) for name, v in columns.items()}
    made |= {f"{name}_limiting": ("case", np.full(len(status), "")) for name in columns}
    attrs = {"sampler": sampler, "inputs": "a\nb"}
    return xr.Dataset({"status": ("case", np.array(status)), **made}, attrs=attrs)


def test_probabilities_count_what_tips_and_slips() -> None:
    nan = np.nan
    data = result(
        ["settled"] * 5 + ["tips", "off_map"],
        tip=[0.3, -0.1, 0.05, 0.2, 0.4, nan, nan],
        friction=[0.1, 0.1, -0.2, -np.inf, 0.3, nan, nan],
    )
    tipping, slipping = probabilities(data)
    assert (tipping.count, tipping.cases, tipping.silent) == (2, 6, 1)
    assert (slipping.count, slipping.cases, slipping.silent) == (2, 5, 2)
    assert tipping.low == pytest.approx(stats.beta.ppf(0.025, 2, 5))  # Clopper and Pearson's closed form
    assert tipping.high == pytest.approx(stats.beta.ppf(0.975, 3, 4))
    assert "exact binomial" in tipping.interval
    assert probabilities(data, "tip", 0.1)[0].count == 3
    assert "conservative" in probabilities(data.assign_attrs(sampler="sobol"))[0].interval
    assert probabilities(data.assign_attrs(sampler="grid")) == []
    with pytest.raises(StudyError, match="no such measure"):
        probabilities(data, "tipp")


def test_of_a_saltelli_block_only_its_ends_are_draws() -> None:
    data = result(["tips", "settled", "settled", "settled", "settled", "tips", "tips", "settled"], "saltelli")
    tipping = probabilities(data)[0]
    assert (tipping.count, tipping.cases) == (1, 4)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("mass: {normal: {mean: 10, sd: 0}}", "mass.robot: normal.sd: must be more than zero (got 0)"),
        ("mass: {normal: {mean: 10, sd: 1}}", "mass.robot: may be zero or less (got -inf); give bounds"),
        ("mass: {mast: [-1, 2]}", "mass.mast: may be zero or less (got -1.0); give bounds"),
        ("friction: {normal: {mean: 0.5, sd: 0.1}}", "friction: must be more than zero (got -inf)"),
        (
            "friction: {uniform: {low: 1, high: 1}}",
            "friction.uniform: low must be less than high (got [1.0, 1.0])",
        ),
        (
            "friction: {nornal: {mean: 1, sd: 1}}",
            "friction: no such distribution (got 'nornal'); did you mean 'normal'",
        ),
        ("x: {normal: {mean: 1}}", "x.normal.sd: is missing; write {normal:"),
        ("x: {normal: {mean: 1, sd: .nan}}", "x.normal.sd: is not a finite number (got nan)"),
        (
            "x: {triangular: {low: 0, mode: 3, high: 2}}",
            "x.triangular.mode: lies outside low and high (got 3.0)",
        ),
        (
            "x: {normal: {mean: 0, sd: 1, bounds: [50, 60]}}",
            "x.normal.bounds: hold 0.0e+00 of the distribution",
        ),
        ("payload: {kg: [-1, 2]}", "payload.kg: may be below zero (got -1.0)"),
        ("payload: {x: 1}", "payload.kg: is missing"),
    ],
)
def test_mistakes_name_file_and_key(text: str, message: str) -> None:
    with pytest.raises(StudyError) as failure:
        Study.from_text(f"{BASE}vary: {{{text}}}", file="s.yaml")
    told = str(failure.value)
    assert told.replace("robot: normal", "robot.normal").startswith(
        f"s.yaml: vary.{message}".replace("robot: normal", "robot.normal")
    )
    assert "\n" not in told


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("vary: {mass: {base_lnk: [1, 2]}}", "vary.mass.base_lnk: no such link .*did you mean 'base_link'"),
        ("vary: {com: {robt: {x: 1}}}", "vary.com.robt: no such link .*'robot'"),
        (
            "vary: {x: [0, 1]}\ncases: {sampler: saltelli, n: 100}",
            "cases.n: must be a power of two .*give 64 or 128",
        ),
        ("vary: {x: 1}\ncases: saltelli", "vary: nothing varies"),
        ("vary: {x: {normal: {mean: 0, sd: 1}}}\ncases: grid", "vary.x: a grid cannot cut a distribution"),
    ],
)
def test_what_the_robot_or_the_sampler_cannot_do(tmp_path: Path, text: str, message: str) -> None:
    file = tmp_path / "s.yaml"
    file.write_text(BASE + text)
    with pytest.raises(StudyError, match=f"^{re.escape(str(file))}: {message}"):
        Study.from_file(file).run()


@pytest.fixture(scope="module")
def weighed() -> SimpleNamespace:
    vary = {
        "x": [-3, 3],
        "yaw_deg": [0, 360],
        "mass": {"robot": [25, 35], "rocker_l_link": {"normal": {"mean": 3, "sd": 0.5, "bounds": [1, 5]}}},
        "com": {
            "robot": {"x": {"normal": {"mean": 0, "sd": 0.03}}, "z": [0, 0.1]},
            "rocker_r_link": {"z": 0.1},
        },
        "payload": {"kg": {"lognormal": {"s": 0.4, "scale": 3}}, "y": [-0.1, 0.1], "z": 0.3},
    }
    rough = {"rough": {"seed": 1, "rms": 0.05, "hurst": 0.8, "size": 10, "spacing": 0.05}}
    payload = [{"kg": 2, "at": [0.1, 0, 0.2]}, {"kg": 1, "at": "bogie_l_link"}]
    cases = {"sampler": "saltelli", "n": 16}
    study = Study("rocker_bogie", rough, cases=cases, vary=vary, measures=["tip"], payload=payload)
    return SimpleNamespace(study=study, data=study.run())


def test_masses_that_vary_are_compiled_and_weigh_what_was_asked(weighed: SimpleNamespace) -> None:
    data = weighed.data
    assert data.attrs["plain_path_cases"] == 0
    carried = data.load_n.sum("wheel").values / 9.81
    np.testing.assert_allclose(carried, data.mass_robot + data.payload_kg + 3.0, rtol=1e-9)
    for i in range(0, len(data.case), 17):
        stance = weighed.study.stance(i)
        loads = np.array(list(stance.loads.values()))
        np.testing.assert_allclose(data.load_n.values[i], loads, atol=1e-8 * loads.sum())
        assert abs(stance.rpy[0] - float(data.roll_rad[i])) < 1e-8
        assert abs(stance.position[2] - float(data.z_m[i])) < 1e-8


def test_the_weight_is_an_additive_model_of_the_study(weighed: SimpleNamespace) -> None:
    found = sobol_indices(weighed.data, {"n": weighed.data.load_n.sum("wheel").values})
    idle = ["com/robot/x", "com/robot/z", "payload/y", "x", "yaw_deg"]
    np.testing.assert_allclose(found.total.sel(figure="n", input=idle), 0.0, atol=1e-9)
    assert 0.5 < float(found.total.sel(figure="n", input="mass/robot")) < 1.2
    told = matters_of(weighed.data)
    assert told is not None
    assert {"tip", "load_n/fl"} <= {each["name"] for each in told["figures"]}
    assert re.match(r"Probability of tipping: 0 % \(95 %: 0 to 10.9 %\), 0 of 32 cases", told["said"][0])


def test_a_shift_moves_the_whole_centre_of_mass(weighed: SimpleNamespace) -> None:
    plain = weighed.study.plan.rover
    link = plain.bodies["rocker_l_link"]
    moved = plain.with_masses(Masses(kg={"rocker_l_link": 3.0}, com={"robot": (0.02, 0.0, -0.01)}))
    q = plain.neutral
    before, after = (
        pin.centerOfMass(each.model, each.model.createData(), np.array(q)) for each in (plain, moved)
    )
    extra = 3.0 - float(link.mass[0])
    data = plain.model.createData()
    pin.forwardKinematics(plain.model, data, np.array(q))
    at = data.oMi[link.joint].act(link.center[0])
    own = moved.mass - 3.0
    expected = plain.mass * before + extra * at + own * np.array([0.02, 0.0, -0.01])
    np.testing.assert_allclose(moved.mass * after, expected, atol=1e-9)
    again = moved.with_masses(Masses(kg={"robot": 10.0}))
    assert again.mass == pytest.approx(13.0)


def test_a_links_mass_and_a_parameter_vary_together() -> None:
    vary = {"x": [-3, 3], "parameters": {"body_mass": [50, 90]}, "mass": {"rocker_l_link": [1, 5]}}
    data = Study(
        "rocker_bogie", "slope:5", cases={"sampler": "random", "n": 6}, vary=vary, measures=["tip"]
    ).run()
    nominal = load("rocker_bogie")
    rest = nominal.mass - nominal.parameters["body_mass"] - float(nominal.bodies["rocker_l_link"].mass[0])
    weight = 9.81 * (rest + data.body_mass + data.mass_rocker_l_link)
    np.testing.assert_allclose(data.load_n.sum("wheel"), weight, rtol=1e-9)
    for i in range(len(data.case)):
        rover = load("rocker_bogie", body_mass=float(data.body_mass[i]))
        rover = rover.with_masses(Masses(kg={"rocker_l_link": float(data.mass_rocker_l_link[i])}))
        stance = settle(rover, Terrain.slope(5.0), x=float(data.x_m[i]))
        loads = [stance.loads[wheel] for wheel in data.wheel.values]
        np.testing.assert_allclose(data.load_n.values[i], loads, atol=1e-8 * rover.mass * 9.81)
