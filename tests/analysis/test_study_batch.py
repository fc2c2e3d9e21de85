"""The compiled path in a study: its answers as rows, what it leaves answered by the plain path."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np
import pytest
from batch_double import GROUNDED, OFF_MAP, OPEN, SETTLED, DoubleAnswers, DoubleBatch, double_study, stand_in

from rover_pin.analysis import Study
from rover_pin.analysis.batch import CompiledRows, as_columns
from rover_pin.analysis.dataset import read
from rover_pin.analysis.job import Runner
from rover_pin.analysis.rows import Columns, Layout, Rows
from rover_pin.stability.margin import Margin

LAYOUT = Layout(("fl", "bl", "fr", "br"), ("rocker", "bogie"), ("tip", "loads"))
VARY = {"x": [-3, 3], "y": [-3, 3], "yaw_deg": [0, 360]}


@pytest.fixture(autouse=True)
def codes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "rover_pin.compiled", stand_in())


def made_up(n: int, *, left: bool) -> DoubleAnswers:
    x, y, yaw = np.random.default_rng(1).uniform(-3, 3, (3, n))
    return DoubleAnswers(x, y, yaw, 4, 2, ("tip", "loads"), left)


def one_by_one(answers: DoubleAnswers) -> Columns:
    """The same answers through the rows of the plain path."""
    rows = Rows(LAYOUT, len(answers.code))
    status, reasons = answers.words()
    tables = {name: answers.labelled(name) for name in ("tip", "loads")}
    for i, word in enumerate(status):
        rows.failed(i, word, reasons[i])
        if word != "settled":
            continue
        for name in ("z_m", "roll_rad", "pitch_rad", "redundant", "equilibrium"):
            rows._numbers[name][i] = getattr(answers, name)[i]
        for name in ("gap_m", "loop_m", "complementarity", "load_n", "joint_rad"):
            rows._numbers[name][i] = getattr(answers, name)[i]
        for name, (names, table, limiting) in tables.items():
            edges = {edge: v for edge, v in zip(names, table[i], strict=True) if not np.isnan(v)}
            value = answers.value[name][i]
            rows.margins(i, {name: Margin(name, value, "rad", names[limiting[i]], edges, "high")})
    return rows.columns()


@pytest.mark.parametrize("left", [False, True])
def test_answers_are_the_rows_one_would_write_down(left: bool) -> None:
    answers = made_up(2000, left=left)
    assert set(answers.code) == {SETTLED, GROUNDED, OFF_MAP} | ({OPEN} if left else set())
    ours, wanted = as_columns(answers, LAYOUT), one_by_one(answers)  # type: ignore[arg-type]
    assert not ours.pop("plain_path").any()
    assert wanted.pop("plain_path").all()
    assert set(ours) == set(wanted)
    for name, values in wanted.items():
        assert ours[name].dtype == values.dtype, name
        np.testing.assert_array_equal(ours[name], values, err_msg=name)


def test_a_row_takes_less_than_a_microsecond_or_two() -> None:
    answers = made_up(50_000, left=False)
    answers.code[:] = SETTLED
    as_columns(answers, LAYOUT)  # type: ignore[arg-type]
    start = time.process_time()
    as_columns(answers, LAYOUT)  # type: ignore[arg-type]
    assert (time.process_time() - start) / 50_000 < 2e-6


@pytest.fixture
def study(monkeypatch: pytest.MonkeyPatch) -> Study:
    return double_study(monkeypatch, 150, left=True)


def test_what_is_left_open_is_answered_plainly_and_counted(study: Study, tmp_path: Path) -> None:
    data = study.run()
    runner = Runner(study.plan.job)
    cases = study.plan.job.cases.drawer().run(0, 150)
    answers = DoubleBatch(study.plan.job).answer(cases.x, cases.y, cases.yaw)
    left = np.flatnonzero(answers.code == OPEN)
    assert 0 < len(left) < 50
    assert data.attrs["plain_path_cases"] == len(left)
    assert np.flatnonzero(data.plain_path).tolist() == left.tolist()
    for i in left[:3]:
        stance = runner.stance(int(i))
        row = data.isel(case=i)
        assert str(row.status.values) == str(stance.status) == "settled"
        assert float(row.z_m) == stance.position[2]
        assert row.load_n.values.tolist() == [stance.loads[str(name)] for name in row.wheel.values]
    others = np.flatnonzero(data.plain_path.values == 0)
    np.testing.assert_array_equal(data.z_m.values[others], answers.z_m[others])
    assert data.reason.values[others].tolist() == [answers.words()[1][i] for i in others]


@pytest.mark.parametrize("chunk", [1, 13, 150])
def test_chunks_and_files_do_not_matter_on_two_paths(study: Study, tmp_path: Path, chunk: int) -> None:
    from test_study_run import assert_same_bits

    out = tmp_path / "out.nc"
    assert_same_bits(study.run(), study.run(chunk=chunk, out=out))
    assert read(out).attrs["plain_path_cases"] == study.run().attrs["plain_path_cases"]


def test_measures_beyond_the_compiled_ones_go_the_plain_way(monkeypatch: pytest.MonkeyPatch) -> None:
    module = stand_in()
    module.__dict__.update(COMPILED_MEASURES=("tip",), Batch=lambda *_, **__: DoubleBatch(job))
    monkeypatch.setitem(sys.modules, "rover_pin.compiled", module)
    job = Study("rocker_bogie", "flat", vary={"x": 0, "y": 0}, measures=["tip"]).plan.job
    assert CompiledRows.of(job) is not None
    for measures in (["tip", "bounds"], ["tip", "friction"]):
        other = Study("rocker_bogie", "flat", vary={"x": 0, "y": 0}, measures=measures).plan.job
        assert CompiledRows.of(other) is None
    monkeypatch.setattr(DoubleBatch, "refusal", "a terrain of Python")
    assert CompiledRows.of(job) is None
