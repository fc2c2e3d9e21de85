"""The engine dask on clusters of separate processes: same bits, workers that die, join, lack or differ.

Slow (half a minute): every cluster starts processes that import everything anew.
"""

from __future__ import annotations

import contextlib
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray as xr

from rover_pin.analysis import Study
from rover_pin.analysis.dataset import read
from rover_pin.analysis.engines import Resources, engine
from rover_pin.analysis.job import Runner
from rover_pin.cli import main
from rover_pin.errors import SolverError, StudyError

distributed = pytest.importorskip("distributed")
pytestmark = pytest.mark.slow

ROUGH = {"rough": {"seed": 3, "rms": 0.06, "hurst": 0.7, "size": 8, "spacing": 0.05}}
EVERYWHERE = {"x": "map", "y": "map", "yaw_deg": [0, 360], "parameters": {"track": [1.0, 1.4]}}
COMMAND = "import sys; from distributed.cli.dask_{0} import main; main(sys.argv[1:])"
BARE = "import sys; sys.modules['rover_pin'] = None; " + COMMAND


def rough_study(n: int = 60) -> Study:
    cases = {"n": n}
    return Study("rocker_bogie", ROUGH, cases=cases, vary=EVERYWHERE, measures=["tip", "clearance", "loads"])


def costly_study() -> Study:
    """Of a measure that the compiled path does not have: every case goes the plain path by itself."""
    cases = {"n": 60}
    return Study("rocker_bogie", ROUGH, cases=cases, vary=EVERYWHERE, measures=["tip", "friction"])


def assert_same_bits(one: xr.Dataset, other: xr.Dataset) -> None:
    assert set(one.variables) == set(other.variables)
    for name, values in one.variables.items():
        if values.dtype.kind == "f":
            assert values.values.tobytes() == other[name].values.tobytes(), name
        else:
            np.testing.assert_array_equal(values.values, other[name].values, err_msg=str(name))


@pytest.fixture(scope="module")
def plain() -> xr.Dataset:
    return rough_study().run()


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address="127.0.0.1:0"
    ) as made:
        yield made


@pytest.fixture
def address(cluster: Any) -> str:
    """The cluster's scheduler, once both workers are there (again)."""
    with distributed.Client(cluster, set_as_default=False) as client:
        client.wait_for_workers(2, timeout=60)
    return str(cluster.scheduler_address)


@contextlib.contextmanager
def command(code: str, which: str, *words: str, says: str) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """A scheduler or worker by its command line; entered when it says so, with what it said."""
    words = (*words, "--no-dashboard")
    here = Path(__file__).parent
    path = os.pathsep.join([str(here.parents[1]), str(here), os.environ.get("PYTHONPATH", "")])
    with subprocess.Popen(
        [sys.executable, "-c", code.format(which), *words],
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": path},
    ) as process:
        assert process.stderr is not None
        try:
            found = next(m[1] for line in process.stderr if (m := re.search(says, line)))
            yield process, found
        finally:
            process.kill()


@pytest.mark.parametrize(("chunk", "workers"), [(1, 2), (7, 1), (60, 2)])
def test_the_same_bits_on_any_engine_in_any_chunks(plain: xr.Dataset, chunk: int, workers: int) -> None:
    assert_same_bits(plain, rough_study().run(engine="dask", workers=workers, chunk=chunk))


def test_and_on_processes(plain: xr.Dataset) -> None:
    assert_same_bits(plain, rough_study().run(engine="process", workers=2, chunk=7))


def test_a_scheduler_keeps_nothing_of_a_run(
    plain: xr.Dataset, cluster: Any, address: str, tmp_path: Path
) -> None:
    out = tmp_path / "out.nc"
    assert engine("dask", Resources(scheduler=address)).workers(Resources(scheduler=address)) == 2
    result = rough_study().run(engine="dask", scheduler=address, chunk=9, out=out)
    assert_same_bits(plain, result)
    xr.testing.assert_identical(result, read(out))
    assert [entry.name for entry in tmp_path.iterdir()] == ["out.nc"]
    _wait_until(lambda: not cluster.scheduler.tasks)
    assert [name for name in cluster.scheduler.worker_plugins if name.startswith("rover_pin")] == []


def test_a_killed_worker_is_made_up_for(plain: xr.Dataset, cluster: Any, address: str) -> None:
    victim = cluster.workers[0]
    killed: list[int] = []

    def kill(finished: int, count: int) -> None:
        if finished >= 12 and not killed:
            killed.append(victim.pid)
            os.kill(victim.pid, signal.SIGKILL)

    result = rough_study().run(engine="dask", scheduler=address, workers=2, chunk=2, progress=kill)
    assert_same_bits(plain, result)
    assert killed
    assert killed[0] != victim.pid


def test_a_chunk_that_kills_its_workers_is_named(
    cluster: Any, address: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cluster.scheduler, "allowed_failures", 0)
    with distributed.Client(cluster, set_as_default=False) as client:
        client.run(die_at, 31)
    with pytest.raises(SolverError) as caught:
        costly_study().run(engine="dask", scheduler=address, workers=2, chunk=1, out=tmp_path / "o.nc")
    cure = "look at the memory it takes; what is finished is kept for --resume"
    assert re.match(
        rf"^cases 3\d to 3\d: workers died of them, the last at tcp://127.0.0.1:\d+; {cure}$",
        str(caught.value),
    )
    with distributed.Client(cluster, set_as_default=False) as client:
        client.run(break_at, None, on_error="ignore")
    assert len(list((tmp_path / "o.nc.parts").glob("*.npz"))) >= 25


def test_a_broken_case_is_named_as_by_the_other_engines(cluster: Any, address: str, tmp_path: Path) -> None:
    study, out = costly_study(), tmp_path / "out.nc"
    with distributed.Client(cluster, set_as_default=False) as client:
        client.run(break_at, 31)
    try:
        with pytest.raises(SolverError, match=r"^case 31: failed: ZeroDivisionError: no lever$"):
            study.run(engine="dask", scheduler=address, chunk=4, out=out)
    finally:
        with distributed.Client(cluster, set_as_default=False) as client:
            client.run(break_at, None)
    told: list[int] = []
    resumed = study.run(
        engine="dask", scheduler=address, out=out, resume=True, progress=lambda done, of: told.append(done)
    )
    assert told[0] >= 16
    assert_same_bits(costly_study().run(), resumed)


def test_an_interrupted_run_goes_on(plain: xr.Dataset, cluster: Any, address: str, tmp_path: Path) -> None:
    study, out = rough_study(), tmp_path / "out.nc"

    def interrupt(finished: int, count: int) -> None:
        if finished >= 20:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        study.run(engine="dask", scheduler=address, chunk=4, out=out, progress=interrupt)
    assert not out.exists()
    _wait_until(lambda: not cluster.scheduler.tasks)
    told: list[int] = []
    resumed = study.run(
        engine="dask", scheduler=address, out=out, resume=True, progress=lambda done, of: told.append(done)
    )
    assert 20 <= told[0] < 60
    assert_same_bits(plain, resumed)


def test_a_worker_that_joins_late_is_used_and_one_without_the_package_is_refused(
    plain: xr.Dataset, cluster: Any, address: str
) -> None:
    before = set(cluster.scheduler.workers)
    with contextlib.ExitStack() as stack:

        def join(finished: int, count: int) -> None:
            if finished == 8:
                said = r"Registered to: +(\S+)"
                stack.enter_context(
                    command(COMMAND, "worker", address, "--no-nanny", "--nthreads=1", says=said)
                )

        with distributed.Client(cluster, set_as_default=False) as client:
            result = rough_study().run(engine="dask", scheduler=address, chunk=2, progress=join)
            assert_same_bits(plain, result)
            (late,) = set(cluster.scheduler.workers) - before
            assert client.run(has_worked, workers=[late]) == {late: True}
    _wait_until(lambda: set(cluster.scheduler.workers) == before)
    said = r"Registered to: +(\S+)"
    with command(BARE, "worker", address, "--no-nanny", "--nthreads=1", says=said):
        (bare,) = set(cluster.scheduler.workers) - before
        message = (
            rf"^worker {bare}: cannot run rover_pin: ModuleNotFoundError\(.*'rover_pin' .*\); "
            "let all workers use one environment, the one that the study is started from$"
        )
        with pytest.raises(StudyError, match=message):
            rough_study().run(engine="dask", scheduler=address)
    _wait_until(lambda: set(cluster.scheduler.workers) == before)


def test_a_worker_of_another_version_is_refused(
    cluster: Any,
    address: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    request: pytest.FixtureRequest,
) -> None:
    from rover_pin.analysis.engines import _alike

    here = _alike.versions()
    monkeypatch.setattr(_alike, "versions", lambda: {**here, "numpy": "9.9"})
    _alike.makings.cache_clear()
    request.addfinalizer(_alike.makings.cache_clear)
    message = rf"^worker tcp://127\.0\.0\.1:\d+: has numpy {re.escape(here['numpy'])} \(here 9\.9\); let all"
    with pytest.raises(StudyError, match=message):
        rough_study().run(engine="dask", scheduler=address, out=tmp_path / "o.nc")
    assert list(tmp_path.iterdir()) == []


def test_a_late_worker_of_another_version_ends_the_run_at_its_first_chunk() -> None:
    from rover_pin.analysis.engines._alike import makings
    from rover_pin.analysis.engines._dask_worker import Bench

    bench = Bench(b"not unpacked", {**makings(), "numpy": "9.9"})
    bench.setup(SimpleNamespace(address="tcp://late:1"))
    message = (
        rf"^worker tcp://late:1: has numpy {re.escape(makings()['numpy'])} \(here 9\.9\); let all workers"
    )
    with pytest.raises(StudyError, match=message):
        bench.run((0, 1))


def test_by_the_command_line_and_a_scheduler_that_goes(
    plain: xr.Dataset, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    from rover_pin.analysis.engines import _dask_cluster

    spec, out = tmp_path / "s.yaml", tmp_path / "out.nc"
    spec.write_text(rough_study().text)
    words = ["study", str(spec), "-o", str(out), "--engine", "dask", "--json"]
    scheduler = command(COMMAND, "scheduler", "--host=127.0.0.1", "--port=0", says=r"Scheduler at: +(tcp\S+)")
    with scheduler as (process, address):
        said = r"Registered to: +(\S+)"
        with command(COMMAND, "worker", address, "--nthreads=2", says=said):
            assert main([*words, "--scheduler", address]) == 0
            assert_same_bits(plain, read(out))
            monkeypatch.setattr(_dask_cluster, "CONNECT_SECONDS", 1.0)
            lost = "^engine dask: the scheduler was lost; what is finished is kept for --resume$"
            with pytest.raises(SolverError, match=lost):
                rough_study().run(
                    engine="dask",
                    scheduler=address,
                    chunk=2,
                    progress=lambda finished, count: process.kill() if finished >= 10 else None,
                )
    capsys.readouterr()
    out.unlink()
    assert main([*words, "--scheduler", address]) == 2
    told = capsys.readouterr()
    assert told.out == ""
    assert told.err.startswith("error: scheduler: no Dask scheduler answers: Timed out trying to connect")
    assert told.err.endswith(
        f"(got '{address}'); start one with `dask scheduler` and give the address that it prints, tcp://HOST:8786\n"
    )
    assert [entry.name for entry in tmp_path.iterdir()] == ["s.yaml"]


def test_a_scheduler_without_workers(monkeypatch: pytest.MonkeyPatch) -> None:
    from rover_pin.analysis.engines import _dask_cluster

    monkeypatch.setattr(_dask_cluster, "WORKERS_SECONDS", 0.2)
    with distributed.LocalCluster(n_workers=0, processes=True, dashboard_address="127.0.0.1:0") as empty:
        address = empty.scheduler_address
        message = (
            f"scheduler {address}: has 0 of 3 workers after 0 s; "
            f"start workers with `dask worker {address} --nthreads 1`, or ask for fewer"
        )
        with pytest.raises(StudyError, match=f"^{re.escape(message)}$"):
            rough_study().run(engine="dask", scheduler=address, workers=3)


def test_without_dask_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    message = "engine dask: needs the package distributed; pip install 'rover-pin[dask]'"
    with pytest.raises(StudyError, match=f"^{re.escape(message)}$"):
        rough_study().run(engine="dask")


def _wait_until(holds: Callable[[], bool]) -> None:
    deadline = time.monotonic() + 30
    while not holds():
        assert time.monotonic() < deadline
        time.sleep(0.05)


_pose = Runner.stance


def break_at(case: int | None) -> None:
    """Called in workers: have a case raise what no status describes; None: mend it."""

    def breaks(self: Runner, i: int) -> Any:
        if i == case:
            raise ZeroDivisionError("no lever")
        return _pose(self, i)

    Runner.stance = breaks if case is not None else _pose  # type: ignore[method-assign]


def die_at(case: int) -> None:
    """Called in workers: have a case end the process as a lack of memory would."""

    def dies(self: Runner, i: int) -> Any:
        if i == case:
            os.kill(os.getpid(), signal.SIGKILL)
        return _pose(self, i)

    Runner.stance = dies  # type: ignore[method-assign]


def has_worked(dask_worker: Any) -> bool:
    """Called in a worker: whether it has carried out anything."""
    return bool(dask_worker.state.executed_count)
