"""Studies larger than memory: what streams to the file is what a small study has in memory."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
from batch_double import double_study
from test_study_run import _with_path, assert_same_bits, rough_study

from rover_pin.analysis import trial
from rover_pin.analysis.job import Chunk
from rover_pin.analysis.rows import Columns, Rows

STREAM = """
import json, resource, sys
sys.path.insert(0, {tests!r})
import batch_double
batch_double.install(left=False)
from rover_pin.analysis import Study
from rover_pin.analysis.summary import measures, spread, statuses
vary = {{"x": [-3, 3], "y": [-3, 3], "yaw_deg": [0, 360], "posture": ["home"]}}
study = Study("rocker_bogie", {{"slope": 3}}, cases={{"n": {n}}}, vary=vary, measures=["tip", "loads"])
peak = lambda: resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
first = Study("rocker_bogie", {{"slope": 3}}, cases={{"n": 40_000}}, vary=vary, measures=["tip", "loads"])
first.run(out={small!r}, chunk=20_000)
before = peak()
data = study.run(out={out!r}, chunk=20_000)
told = statuses(data), [spread(data, name).percentiles for name in measures(data)]
json.dump({{"before": before, "after": peak(), "told": told}}, sys.stdout)
"""


@pytest.mark.slow  # a million rows, written twice
def test_memory_does_not_grow_with_the_number_of_cases(tmp_path: Path) -> None:
    out, small = str(tmp_path / "out.nc"), str(tmp_path / "small.nc")
    script = tmp_path / "stream.py"
    script.write_text(STREAM.format(tests=str(Path(__file__).parent), n=1_000_000, out=out, small=small))
    done = subprocess.run(
        [sys.executable, str(script)],
        cwd=Path(__file__).parents[2],
        env=_with_path(),
        capture_output=True,
        text=True,
        check=True,
    )
    result = json.loads(done.stdout)
    assert sum(result["told"][0].values()) == 1_000_000
    assert Path(out).stat().st_size > 3e8
    assert result["after"] - result["before"] < 150  # MB; the file alone is over 300
    assert result["after"] < 2200  # MB; what the kernels' compilation takes, where it is cold, is in it


@pytest.mark.parametrize("chunk", [None, 7_001, 65_536, 150_000])
def test_a_streamed_result_is_the_one_in_memory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, chunk: int | None
) -> None:
    study = double_study(monkeypatch, 150_000)
    assert_same_bits(study.run(), study.run(out=tmp_path / "out.nc", chunk=chunk))


@pytest.mark.parametrize(
    ("each", "count", "workers", "chunk"),
    [
        (0.75 / 300, 10**6, 2, 300),
        (1e-5, 100_000, 2, 50_000),
        (1e-5, 10**6, 2, 71_429),
        (1e-6, 10**7, 2, 100_000),
        (1e-5, 1000, 4, 250),
        (9.0, 1000, 4, 1),
    ],
)
def test_chunks_take_most_of_a_second(each: float, count: int, workers: int, chunk: int) -> None:
    assert trial.Trial({}, each).chunk(count, workers) == chunk


def test_a_trial_goes_on_until_it_says_something(monkeypatch: pytest.MonkeyPatch) -> None:
    now, runs = 0.0, []
    layout = rough_study(1).plan.job.layout

    class Steady:
        """A runner that takes 10 us a case."""

        def run(self, chunk: Chunk) -> Columns:
            nonlocal now
            runs.append(chunk[1])
            now += 1e-5 * chunk[1]
            return Rows(layout, chunk[1]).columns()

    monkeypatch.setattr("time.perf_counter", lambda: now)
    tried = trial.trial(Steady(), 10**6)  # type: ignore[arg-type]
    assert tried.seconds == pytest.approx(1e-5)
    assert runs[:3] == [1, 4, 32]
    assert 25_000 < runs[-1] <= 50_000
    runs.clear()
    trial.trial(Steady(), 10**6, 20)  # type: ignore[arg-type]
    assert runs == [1, 4, 20]
