"""Running a study: the same rows whatever the engine and the cuts, failures as rows, a killed run resumed."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from rover_pin import Terrain, load, load_bounds, settle, stability
from rover_pin.analysis import Study
from rover_pin.analysis.job import INVALID, Runner
from rover_pin.analysis.plan import wheel_reach
from rover_pin.analysis.summary import measures, spread, statuses
from rover_pin.errors import InputError, SolverError, StudyError

ROUGH = {"rough": {"seed": 3, "rms": 0.06, "hurst": 0.7, "size": 8, "spacing": 0.05}}
EVERYWHERE = {"x": "map", "y": "map", "yaw_deg": [0, 360], "friction": [0.5]}


def rough_study(n: int = 24, **others: Any) -> Study:
    given: dict[str, Any] = {"cases": {"n": n}, "vary": EVERYWHERE, "measures": ["tip", "clearance", "loads"]}
    return Study("rocker_bogie", ROUGH, **{**given, **others})


def assert_same_bits(one: xr.Dataset, other: xr.Dataset) -> None:
    xr.testing.assert_equal(one, other)
    assert set(one.variables) == set(other.variables)
    for name, values in one.variables.items():
        assert _bits(values.values) == _bits(other[name].values), name


def _bits(values: Any) -> bytes:
    """Words come as objects from a file."""
    return (values.astype(np.str_) if values.dtype.kind == "O" else values).tobytes()


@pytest.fixture(scope="module")
def plain() -> xr.Dataset:
    """Two dozen places on rough ground, one after the other."""
    return rough_study().run()


@pytest.mark.parametrize("which", ["plain", "compiled"])
def test_rows_are_what_settle_says(plain: xr.Dataset, which: str) -> None:
    """To the last bit on the plain path (`bounds` has no other), else to what the two paths agree to."""
    data = rough_study(measures=["tip", "bounds"]).run() if which == "plain" else plain
    assert set(data.plain_path.values) == {1 if which == "plain" else 0}
    assert data.attrs["plain_path_cases"] == (24 if which == "plain" else 0)
    length, load_n = (0.0, 0.0) if which == "plain" else (1e-8, 1e-5)
    rover = load("rocker_bogie")
    terrain = Terrain.rough(seed=3, rms=0.06, hurst=0.7, size=8, spacing=0.05)
    assert data.attrs["terrain_digest"] == terrain.digest
    for i in (0, 7, 23):
        row = data.sel(case=i)
        stance = settle(rover, terrain, x=float(row.x_m), y=float(row.y_m), yaw=float(row.yaw_rad))
        assert str(row.status.values) == str(stance.status) == "settled"
        near(row.z_m, stance.position[2], length)
        near([row.roll_rad, row.pitch_rad], stance.rpy[:2], length)
        near(row.load_n, [stance.loads[str(name)] for name in row.wheel.values], load_n)
        near(row.joint_rad, [stance.joints[str(name)] for name in row.joint.values], length)
        margin = stability(stance, ["tip"])["tip"]
        near(row.tip, margin.value, length)
        assert str(row.tip_limiting.values) == margin.limiting
        near(row.tip_edge.sel(edge=margin.limiting), margin.value, length)
        assert np.isfinite(row.tip_edge.values).sum() == len(margin.edges)


def near(ours: Any, wanted: Any, within: float) -> None:
    np.testing.assert_allclose(ours, wanted, rtol=0, atol=within)


def test_loads_carry_the_weight_and_residuals_are_told(plain: xr.Dataset) -> None:
    weight = load("rocker_bogie").mass * 9.81
    np.testing.assert_allclose(plain.load_n.sum("wheel"), weight, rtol=1e-9)
    for name in ("equilibrium", "gap_m", "loop_m", "complementarity"):
        assert float(plain[name].max()) < 1e-6


def test_the_dataset_says_units_and_whence(plain: xr.Dataset) -> None:
    assert set(plain.sizes) == {"case", "wheel", "edge", "joint"}
    assert (plain.tip.attrs["units"], plain.tip.attrs["better"]) == ("rad", "high")
    assert plain.load_n.attrs["units"] == "N"
    assert (plain.x_m.attrs["varied"], plain.friction_given.attrs["varied"]) == (1, 0)
    assert (plain.clearance_edge.dims, plain.loads_wheel.dims) == (("case", "edge"), ("case", "wheel"))
    attributes = plain.attrs
    assert attributes["seed"] == 0
    assert Study.from_text(attributes["study"]).spec == rough_study().spec
    wanted = (
        "numpy_version",
        "pin_version",
        "python_version",
        "git_commit",
        "git_state",
        "created",
        "terrain",
    )
    assert all(isinstance(attributes[name], str) for name in wanted)


@pytest.mark.parametrize("chunk", [1, 7, 24, 100])
def test_chunks_do_not_matter(plain: xr.Dataset, chunk: int) -> None:
    assert_same_bits(plain, rough_study().run(chunk=chunk))


def test_engines_and_files_do_not_matter(plain: xr.Dataset, tmp_path: Path) -> None:
    out = tmp_path / "out.nc"
    result = rough_study().run(engine="process", workers=2, chunk=5, out=out)
    assert_same_bits(plain, result)
    same_day = {"created": plain.attrs["created"]}
    xr.testing.assert_identical(plain, result.assign_attrs(same_day))
    xr.testing.assert_equal(plain, xr.open_dataset(out, engine="h5netcdf"))
    assert bool((xr.open_dataset(out)["status"] == "settled").all())
    assert [entry.name for entry in tmp_path.iterdir()] == ["out.nc"]


def test_a_case_does_not_hang_on_those_before_it() -> None:
    study = rough_study(8, vary={**EVERYWHERE, "parameters": {"track": [1.0, 1.4]}})
    alone = Runner(study.plan.job).run((5, 6))
    together = Runner(study.plan.job).run((0, 8))
    for name in ("z_m", "load_n", "tip"):
        assert alone[name][0].tobytes() == together[name][5].tobytes()


def test_parameters_make_other_rovers() -> None:
    data = rough_study(6, vary={"parameters": {"track": [1.0, 1.4]}, "x": 0, "y": 0}).run()
    assert len(np.unique(data.track)) == 6
    i = int(np.argmax(data.track.values))
    stance = settle(load("rocker_bogie", track=float(data.track[i])), rough_study().plan.job.terrain)
    near(data.z_m[i], stance.position[2], 1e-8)


def test_bounds_are_intervals_around_the_loads() -> None:
    study = rough_study(2, measures=["bounds"])
    data = study.run()
    assert (data.load_low_n <= data.load_n + 1e-6).all()
    assert (data.load_n <= data.load_high_n + 1e-6).all()
    bounds = load_bounds(study.stance(1), friction=0.5)
    assert data.load_low_n.sel(case=1).values.tolist() == [bounds[str(name)][0] for name in data.wheel.values]


@pytest.mark.parametrize("measures_asked", [[], ["loads"], ["bounds"]])
def test_a_result_without_edges_comes_back_from_its_file(tmp_path: Path, measures_asked: list[str]) -> None:
    out = tmp_path / "out.nc"
    result = rough_study(2, measures=measures_asked).run(out=out)
    assert result.sizes["edge"] == 0
    again = rough_study(2, measures=measures_asked).run()
    xr.testing.assert_equal(result, again)
    xr.testing.assert_equal(result, xr.open_dataset(out, engine="h5netcdf"))


def test_off_the_map_is_a_row() -> None:
    data = rough_study(3, vary={"x": {"values": [0.0, 3.9]}, "y": 0}, cases={"sampler": "grid", "n": 2}).run()
    assert data.status.values.tolist() == ["settled", "off_map"]
    assert str(data.reason.values[1])
    assert np.isnan(data.load_n.values[1]).all()
    assert np.isnan(data.tip.values[1])


def test_what_the_rover_cannot_do_is_a_row_and_the_first_one_an_error(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    study = rough_study(3, measures=["bounds"])
    pose = Runner.stance

    def sometimes(self: Runner, i: int) -> Any:
        if i == 1:
            raise InputError("joint jams", element="posture")
        return pose(self, i)

    monkeypatch.setattr(Runner, "stance", sometimes)
    data = study.run()
    assert data.status.values.tolist() == ["settled", INVALID, "settled"]
    assert str(data.reason.values[1]) == "posture: joint jams"
    monkeypatch.setattr(Runner, "stance", lambda self, i: sometimes(self, 1))
    with pytest.raises(InputError, match=r"^posture: joint jams$"):
        study.run()


def test_a_broken_case_is_named_and_what_is_done_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "out.nc"
    study, pose = rough_study(6, measures=["bounds"]), Runner.stance

    def breaks(self: Runner, i: int) -> Any:
        if i == 4:
            raise ZeroDivisionError("no lever")
        return pose(self, i)

    with monkeypatch.context() as patch:
        patch.setattr(Runner, "stance", breaks)
        with pytest.raises(SolverError, match=r"^case 4: failed: ZeroDivisionError: no lever$"):
            study.run(chunk=2, out=out)
    assert not out.exists()
    assert_same_bits(study.run(out=out, resume=True), rough_study(6, measures=["bounds"]).run())


def test_a_killed_run_goes_on_bit_for_bit(tmp_path: Path) -> None:
    spec = tmp_path / "s.yaml"
    spec.write_text(rough_study(240, measures=["tip", "bounds"]).text)
    out = tmp_path / "out.nc"
    script = tmp_path / "run.py"
    script.write_text(
        "import sys\nfrom rover_pin.analysis import Study\n"
        "if __name__ == '__main__':\n"
        f"    Study.from_file({str(spec)!r}).run(engine='process', workers=2, chunk=4, out={str(out)!r})\n"
    )
    child = subprocess.Popen([sys.executable, str(script)], cwd=Path(__file__).parents[2], env=_with_path())
    parts = tmp_path / "out.nc.parts"
    deadline = time.monotonic() + 120
    while len(list(parts.glob("*-*.npz"))) < 3:
        assert child.poll() is None
        assert time.monotonic() < deadline
        time.sleep(0.005)
    child.send_signal(signal.SIGKILL)
    child.wait()
    kept = len(list(parts.glob("*-*.npz")))
    assert 3 <= kept < 60
    assert not out.exists()
    study = Study.from_file(spec)
    with pytest.raises(StudyError, match=r"an unfinished run lies here; add --resume"):
        study.run(out=out)
    told: list[int] = []
    resumed = study.run(out=out, resume=True, progress=lambda finished, count: told.append(finished))
    assert told[0] >= 4 * kept
    assert told[-1] == 240
    assert not parts.exists()
    assert_same_bits(resumed, Study.from_file(spec).run())


def test_a_changed_study_is_not_resumed(tmp_path: Path) -> None:
    out = tmp_path / "out.nc"
    study = rough_study(4)
    (tmp_path / "out.nc.parts").mkdir()
    ready = study.plan
    from rover_pin.analysis.parts import Parts

    Parts(out, ready.fingerprint, resume=True).begin()
    other = rough_study(4, gravity="mars")
    with pytest.raises(StudyError, match=r"belongs to another study: changed is gravity, payload or locks; "):
        other.run(out=out, resume=True)


def test_the_map_is_shrunk_by_the_wheels() -> None:
    rover = load("rocker_bogie")
    job = rough_study(512).plan.job
    reach = wheel_reach(rover)
    assert 0.5 < reach < 1.5
    x = job.cases.drawer().run(0, 512).x
    assert abs(x).max() <= 4 - reach
    assert abs(x).max() > 3.95 - reach


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"vary": {"x": "map"}, "terrain": "flat"},
            "vary.x: this terrain has no edge (got 'map'); give a range",
        ),
        ({"vary": {"posture": ["hom"]}}, "vary.posture: no such posture (got 'hom'); did you mean 'home'?"),
        (
            {"vary": {"parameters": {"trak": 1}}},
            "vary.parameters.trak: no such parameter; did you mean 'track'?",
        ),
        (
            {"vary": {"joints": {"steer_f": 0.1}}},
            "vary.joints.steer_f: no such joint; did you mean 'steer_fr'",
        ),
        ({"vary": {"joints": {"steer_fl": [-9, 9]}}}, "vary.joints.steer_fl: goes beyond the joint's limits"),
        ({"vary": {"parameters": {"track": [0, 1]}}}, "vary.parameters.track: out of bounds (got 0.0); stay"),
        ({"locks": ["bogie"]}, "locks: no such passive joint (got 'bogie'); did you mean 'bogie_"),
        (
            {"terrain": {"rough": {"rms": 0.01, "hurst": 0.5, "size": 1}}},
            "terrain: is too small for the rover",
        ),
        (
            {"robot": "rocker_bogy"},
            "no bundled robot of that name (got 'rocker_bogy'); did you mean 'rocker_bogie'?",
        ),
    ],
)
def test_names_and_ranges_are_checked_before_anything_runs(
    changes: dict[str, Any], message: str, tmp_path: Path
) -> None:
    given: dict[str, Any] = {"robot": "rocker_bogie", "terrain": ROUGH, "cases": {"n": 2}, **changes}
    with pytest.raises(InputError, match=f"^{re.escape(message)}"):
        Study(**given).run(out=tmp_path / "out.nc")
    assert list(tmp_path.iterdir()) == []


def test_rovers_and_terrains_as_objects() -> None:
    rover = load("rocker_bogie", track=1.1).with_payload([(5.0, (0.0, 0.0, 0.3))])
    study = Study(rover, Terrain.flat(), cases={"n": 1}, vary={"x": 0, "y": 0}, measures=["tip"])
    data = study.run()
    stance = settle(rover, Terrain.flat())
    near(data.load_n[0], [stance.loads[str(name)] for name in data.wheel.values], 1e-5)
    assert float(data.track[0]) == 1.1


def test_a_result_leads_back_to_its_stances(tmp_path: Path) -> None:
    out = tmp_path / "out.nc"
    data = rough_study(4).run(out=out)
    stance = Study.from_dataset(out).stance(2)
    near(data.z_m[2], stance.position[2], 1e-8)
    with pytest.raises(StudyError, match=r"^case: no such case \(got 4\); give 0 to 3$"):
        Study.from_dataset(out).stance(4)
    (tmp_path / "no.nc").write_text("no")
    with pytest.raises(StudyError, match=r"is no netCDF file"):
        Study.from_dataset(tmp_path / "no.nc")


def test_the_summary_names_the_worst(plain: xr.Dataset) -> None:
    assert statuses(plain) == {"settled": 24}
    assert measures(plain) == ["tip", "clearance", "loads"]
    tip = spread(plain, "tip", 3)
    assert tip.worst[0].case == int(np.argmin(plain.tip.values))
    assert tip.worst[0].value == float(plain.tip.min()) == min(w.value for w in tip.worst)
    assert tip.percentiles[50] in plain.tip.values


def _with_path() -> dict[str, str]:
    root = str(Path(__file__).parents[2])
    return {**os.environ, "PYTHONPATH": os.pathsep.join([root, os.environ.get("PYTHONPATH", "")])}
