"""Engines: which there are, what they refuse, chunks handed out few at a time, a worker process that dies."""

from __future__ import annotations

import multiprocessing
import os
import re
import signal
import weakref
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rover_pin.analysis import Study
from rover_pin.analysis.engines import Resources, engine, engine_names
from rover_pin.analysis.engines._alike import SOURCES, makings, refuse_answers
from rover_pin.analysis.engines._feeding import feed
from rover_pin.analysis.engines._local import ONE_THREAD, one_thread
from rover_pin.analysis.job import Chunk
from rover_pin.analysis.rows import Columns
from rover_pin.errors import SolverError, StudyError

ROUGH = {"rough": {"seed": 3, "rms": 0.06, "hurst": 0.7, "size": 8, "spacing": 0.05}}


def test_engines_there_are() -> None:
    assert engine_names() == ["dask", "process", "serial"]
    message = "engine: no such engine (got 'dusk'); did you mean 'dask'?"
    with pytest.raises(StudyError, match=f"^{re.escape(message)}$"):
        engine("dusk", Resources())
    with pytest.raises(StudyError, match=r"^scheduler: the engine serial takes no scheduler \(got 'a:1'\)"):
        engine("serial", Resources(scheduler="a:1"))
    with pytest.raises(StudyError, match=r"^workers: must be at least 1 \(got 0\)$"):
        engine("process", Resources(workers=0))


class Pool:
    """Threads that answer a chunk with its numbers, and count what is out and what is still held."""

    def __init__(self, threads: int, fails_from: int | None = None) -> None:
        self.threads = ThreadPoolExecutor(threads)
        self.fails_from = fails_from
        self.out = self.most_out = self.most_held = 0
        self.made: list[weakref.ref[np.ndarray[Any, Any]]] = []
        self.taken: list[int] = []

    def begin(self, chunk: Chunk) -> Future[Columns]:
        self.out += 1
        self.most_out = max(self.most_out, self.out)
        return self.threads.submit(self._rows, chunk)

    def _rows(self, chunk: Chunk) -> Columns:
        if self.fails_from is not None and chunk[0] >= self.fails_from:
            raise SolverError("failed", element=f"case {chunk[0]}")
        rows = np.arange(*chunk)
        self.made.append(weakref.ref(rows))
        return {"row": rows}

    def done(self, chunk: Chunk, columns: Columns) -> None:
        self.out -= 1
        self.most_held = max(self.most_held, sum(rows() is not None for rows in self.made))
        self.taken += columns["row"].tolist()


@settings(deadline=None, max_examples=40)
@given(count=st.integers(0, 60), ahead=st.integers(1, 9), threads=st.integers(1, 4))
def test_few_are_out_at_a_time_and_none_is_kept(count: int, ahead: int, threads: int) -> None:
    pool = Pool(threads)
    with pool.threads:
        feed([(3 * k, 3 * k + 3) for k in range(count)], pool.begin, lambda: ahead, pool.done)
    assert sorted(pool.taken) == list(range(3 * count))
    assert pool.most_out <= ahead
    assert pool.most_held <= ahead + 1


def test_chunks_are_drawn_as_they_are_needed() -> None:
    pool, drawn = Pool(1), 0

    def endless() -> Any:
        nonlocal drawn
        while True:
            drawn += 1
            yield (drawn, drawn + 1)

    def stop(chunk: Chunk, columns: Columns) -> None:
        raise KeyboardInterrupt

    with pool.threads, pytest.raises(KeyboardInterrupt):
        feed(endless(), pool.begin, lambda: 4, stop)
    assert drawn == 4


def test_more_workers_are_handed_more() -> None:
    pool = Pool(1)
    room = iter([1, 1, 1, 1, 5])
    with pool.threads:
        feed([(k, k + 1) for k in range(20)], pool.begin, lambda: next(room, 5), pool.done)
    assert pool.most_out == 5


@pytest.mark.parametrize("ahead", [1, 4, 30])
def test_what_is_finished_at_a_failure_is_taken_in(ahead: int) -> None:
    pool = Pool(1, fails_from=12)
    with pool.threads, pytest.raises(SolverError, match=r"^case 12: failed$"):
        feed([(k, k + 1) for k in range(20)], pool.begin, lambda: ahead, pool.done)
    assert sorted(pool.taken) == list(range(12))


def test_workers_have_one_thread_and_this_process_keeps_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OMP_NUM_THREADS", "7")
    monkeypatch.delenv("MKL_NUM_THREADS", raising=False)
    with one_thread():
        assert [os.environ[name] for name in ONE_THREAD] == ["1"] * 4
    assert os.environ["OMP_NUM_THREADS"] == "7"
    assert "MKL_NUM_THREADS" not in os.environ


def test_a_killed_worker_process_ends_the_run_and_keeps_what_is_done(tmp_path: Path) -> None:
    study = Study("rocker_bogie", ROUGH, cases={"n": 800}, measures=["tip"])
    out, told, others = tmp_path / "out.nc", [], set(multiprocessing.active_children())

    def kill_one(finished: int, count: int) -> None:
        told.append(finished)
        if len(told) == 3:
            victim = (set(multiprocessing.active_children()) - others).pop()
            os.kill(victim.pid or 0, signal.SIGKILL)

    message = (
        "engine process: a worker process died; in a script, put what runs the study under `if __name__ == "
        "'__main__':`; else look at the memory it takes; what is finished is kept for --resume"
    )
    with pytest.raises(SolverError, match=f"^{re.escape(message)}$"):
        study.run(engine="process", workers=2, chunk=4, out=out, progress=kill_one)
    assert set(multiprocessing.active_children()) <= others
    assert not out.exists()
    told.clear()
    resumed = study.run(out=out, resume=True, progress=lambda finished, count: told.append(finished))
    assert told[0] >= 8
    for name, values in study.run().variables.items():
        np.testing.assert_array_equal(values.values, resumed[name].values, err_msg=str(name))


def test_makings_are_the_same_in_the_same_place_and_tell_of_an_edited_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import rover_pin
    from rover_pin.analysis.engines import _alike

    here = makings()
    assert set(here) == {"rover_pin", "pin", "proxsuite", "numpy", "scipy", "numba", "python", SOURCES}
    assert here["numpy"] == np.__version__
    assert here[SOURCES] == _alike._sources()
    package = tmp_path / "rover_pin"
    (package / "sub").mkdir(parents=True)
    (package / "__init__.py").write_text("")
    (package / "sub" / "a.py").write_text("x = 1\n")
    monkeypatch.setattr(rover_pin, "__file__", str(package / "__init__.py"))
    before = _alike._sources()
    (package / "sub" / "notes.txt").write_text("x")
    assert _alike._sources() == before
    (package / "sub" / "a.py").write_text("x = 2\n")
    assert _alike._sources() != before


def test_workers_that_differ_are_named() -> None:
    here, cure = makings(), "; let all workers use one environment, the one that the study is started from"
    refuse_answers({"tcp://a:1": here, "tcp://b:1": dict(here), "tcp://gone:1": OSError("left")})
    cases: list[tuple[Any, str]] = [
        (
            {**here, "numpy": "1.0", "numba": ""},
            f"has numpy 1.0 (here {here['numpy']}), numba none (here {here['numba']})",
        ),
        ({**here, SOURCES: "0123"}, f"has rover_pin's sources 0123 (here {here[SOURCES]})"),
        (Exception("ModuleNotFoundError(...)"), "cannot run rover_pin: ModuleNotFoundError(...)"),
        (RuntimeError("no room"), "cannot run rover_pin: RuntimeError: no room"),
    ]
    for answer, message in cases:
        with pytest.raises(StudyError, match=f"^{re.escape(f'worker tcp://b:1: {message}')}") as caught:
            refuse_answers({"tcp://a:1": here, "tcp://b:1": answer})
        assert str(caught.value).endswith(cure)
