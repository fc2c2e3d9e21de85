"""Faults of disk and files: what is refused, what is said, and that a resumed study has the same bits."""

from __future__ import annotations

import errno
import gc
import os
import re
import shutil
from collections import namedtuple
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from batch_double import double_study
from test_study_run import assert_same_bits, rough_study

from rover_pin.analysis import Study, netcdf
from rover_pin.analysis.disk import told
from rover_pin.analysis.job import Chunk, Runner
from rover_pin.analysis.patient import PatientFile
from rover_pin.analysis.rows import Columns
from rover_pin.errors import StudyError

Usage = namedtuple("Usage", "total used free")


def free(monkeypatch: pytest.MonkeyPatch, size: float) -> None:
    monkeypatch.setattr(shutil, "disk_usage", lambda _: Usage(1e12, 1e12 - size, int(size)))


def test_more_disk_than_there_is_is_refused_before_anything_is_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    free(monkeypatch, 5e4)
    with pytest.raises(StudyError) as caught:
        rough_study(400).run(out=tmp_path / "out.nc", chunk=4)
    message = (
        rf"^{re.escape(str(tmp_path))}: needs more disk than there is "
        r"\(got '(\d+) kB for 400 cases, 50 kB free'\); "
        "make room, name another place for the result, or ask for fewer cases or measures$"
    )
    found = re.match(message, str(caught.value))
    assert found, str(caught.value)
    assert list(tmp_path.iterdir()) == []
    assert told(9.87e9) == "9.87 GB"


def test_what_is_needed_is_about_what_is_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from rover_pin.analysis import disk, parts

    wanted: list[float] = []
    monkeypatch.setattr(disk, "check_room", lambda folder, size, count: wanted.append(size))
    monkeypatch.setattr("rover_pin.analysis.result.check_room", disk.check_room)
    sizes: list[int] = []
    finish = parts.Parts.finish

    def weighed(self: parts.Parts, write: Any) -> None:
        sizes.append(sum(each.stat().st_size for each in self.folder.glob("*.npz")))
        finish(self, write)

    monkeypatch.setattr(parts.Parts, "finish", weighed)
    out = tmp_path / "out.nc"
    double_study(monkeypatch, 60_000).run(out=out, chunk=20_000)
    assert wanted[0] == pytest.approx(sizes[0] + out.stat().st_size, rel=0.05)


def test_a_disk_that_fills_up_keeps_what_is_finished(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    out = tmp_path / "out.nc"
    study, savez, saved = rough_study(12), np.savez, 0

    def fills(*words: Any, **others: Any) -> None:
        nonlocal saved
        saved += 1
        if saved > 2:
            raise OSError(errno.ENOSPC, "No space left on device")
        savez(*words, **others)

    message = f"^{re.escape(str(out))}.parts: the disk is full; what is finished is kept: make room and go on"
    with monkeypatch.context() as patch:
        patch.setattr(np, "savez", fills)
        with pytest.raises(StudyError, match=message):
            study.run(out=out, chunk=3)

    def full(*_: Any) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    finished: list[int] = []
    with monkeypatch.context() as patch:
        patch.setattr("rover_pin.analysis.result.write", full)
        with pytest.raises(StudyError, match=message):
            study.run(out=out, resume=True, progress=lambda done, _: finished.append(done))
    assert (finished[0], finished[-1]) == (6, 12)
    assert not out.exists()
    assert_same_bits(study.run(out=out, resume=True), rough_study(12).run())
    assert [entry.name for entry in tmp_path.iterdir()] == ["out.nc"]


def test_a_disk_that_fills_up_under_hdf5_is_told_and_the_file_closed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out, room = tmp_path / "out.nc", 6_000_000
    study = double_study(monkeypatch, 70_000)

    def fills(descriptor: int, data: memoryview) -> int:
        nonlocal room
        if not room:
            raise OSError(errno.ENOSPC, "No space left on device")
        written = os.write(descriptor, data[:room])
        room -= written
        return written

    with monkeypatch.context() as patch:
        patch.setattr("rover_pin.analysis.patient.os", SimpleNamespace(write=fills, fsync=os.fsync))
        with pytest.raises(StudyError, match="the disk is full; what is finished is kept"):
            study.run(out=out, chunk=35_000)
    assert room == 0
    gc.collect()  # what HDF5 still holds would complain here
    names = [entry.name for entry in (tmp_path / "out.nc.parts").iterdir()]
    assert sorted(names) == ["0000000000-0000035000.npz", "0000035000-0000070000.npz", "study.json"]
    assert_same_bits(study.run(out=out, resume=True), study.run())


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a disk that is always full")
def test_a_file_keeps_its_trouble_until_it_is_asked() -> None:
    file = PatientFile(Path("/dev/full"))
    file.check()
    assert file.write(b"four") == 4
    for ask in (file.check, file.keep):
        with pytest.raises(OSError, match="No space left on device"):
            ask()
    file.close()


def test_an_interrupt_while_the_result_is_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    out = tmp_path / "out.nc"
    study, store = rough_study(6), netcdf._store

    def interrupted(made: Any, each: Any, *others: Any) -> None:
        store(made, each, *others)
        if each.name == "load_n":
            raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(netcdf, "_store", interrupted)
        with pytest.raises(KeyboardInterrupt):
            study.run(out=out, chunk=2)
    assert len(list((tmp_path / "out.nc.parts").glob("*.npz"))) == 3
    assert not (tmp_path / "out.nc.parts" / "result.nc").exists()
    assert_same_bits(study.run(out=out, resume=True), rough_study(6).run())


def test_a_terrain_that_changed_since_the_start_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ground = tmp_path / "yard.npy"
    np.save(ground, np.zeros((80, 80)))
    terrain = {"file": str(ground), "spacing": 0.1}

    def made() -> Study:
        return Study("rocker_bogie", terrain, cases={"n": 6}, measures=["tip"])

    carry_out = Runner.run

    def stopped(self: Runner, chunk: Chunk) -> Columns:
        if chunk[0] == 4:
            raise KeyboardInterrupt
        return carry_out(self, chunk)

    with monkeypatch.context() as patch:
        patch.setattr(Runner, "run", stopped)
        with pytest.raises(KeyboardInterrupt):
            made().run(out=tmp_path / "out.nc", chunk=2)
    np.save(ground, np.full((80, 80), 0.5))
    parts = tmp_path / "out.nc.parts"
    message = (
        f"{parts}: belongs to another study: changed is the terrain; "
        f"put it back, or delete {parts} to start anew"
    )
    with pytest.raises(StudyError, match=f"^{re.escape(message)}$"):
        made().run(out=tmp_path / "out.nc", resume=True)
    np.save(ground, np.zeros((80, 80)))
    assert made().run(out=tmp_path / "out.nc", resume=True).sizes["case"] == 6
