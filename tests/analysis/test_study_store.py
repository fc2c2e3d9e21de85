"""Chunks on disk: whole or not there, theirs or refused; rows joined whatever the cuts."""

from __future__ import annotations

import errno
import itertools
import json
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rows_double import rows, same

from rover_pin.analysis.found import found_in
from rover_pin.analysis.parts import Parts
from rover_pin.analysis.rows import cut, joined, words
from rover_pin.analysis.store import Memory, atomically, missing
from rover_pin.errors import StudyError

PRINT = {"the terrain": "1", "the robot's description": "2"}


@given(
    cuts=st.lists(st.integers(0, 40), min_size=2, max_size=8),
    count=st.integers(1, 40),
    size=st.integers(1, 50),
)
@settings(max_examples=60, deadline=None, derandomize=True)
def test_missing_chunks_cover_the_rest_once(cuts: list[int], count: int, size: int) -> None:
    edges = sorted({min(cut, count) for cut in cuts})
    kept = [(a, b) for a, b in itertools.pairwise(edges)][::2]
    todo = missing(kept, count, size)
    assert all(0 < b - a <= size for a, b in todo)
    assert sorted(i for a, b in [*kept, *todo] for i in range(a, b)) == list(range(count))


def test_parts_survive_and_come_back(tmp_path: Path) -> None:
    out = tmp_path / "out.nc"
    first = Parts(out, PRINT, resume=False)
    first.begin()
    first.save((0, 2), rows([{"a-b": 1.0}, {}]))
    again = Parts(out, PRINT, resume=True)
    assert again.done() == [(0, 2)]
    assert same(next(again.blocks(10)), rows([{"a-b": 1.0}, {}]))
    again.save((2, 3), rows([{"b-a": 2.0}]))
    assert (again.found.edges["tip"], again.found.cases, again.found.plain) == ({"a-b", "b-a"}, 3, 3)
    assert again.found.width == found_in(rows([{"a-b": 1.0}, {}, {"b-a": 2.0}])).width
    again.finish(lambda path: path.write_text("whole") and None)
    assert out.read_text() == "whole"
    assert [entry.name for entry in tmp_path.iterdir()] == ["out.nc"]


def test_parts_lying_there_are_not_overwritten(tmp_path: Path) -> None:
    out = tmp_path / "out.nc"
    Parts(out, PRINT, resume=False).begin()
    message = f"{out}.parts: an unfinished run lies here; add --resume to go on, or delete {out}.parts"
    with pytest.raises(StudyError, match=f"^{re.escape(message)}$"):
        Parts(out, PRINT, resume=False)


def test_parts_of_another_study_name_what_changed(tmp_path: Path) -> None:
    out = tmp_path / "out.nc"
    Parts(out, PRINT, resume=False).begin()
    message = f"{out}.parts: belongs to another study: changed is the terrain; "
    with pytest.raises(StudyError, match=f"^{re.escape(message)}"):
        Parts(out, {**PRINT, "the terrain": "other"}, resume=True)


def test_a_damaged_part_is_run_again(tmp_path: Path) -> None:
    out = tmp_path / "out.nc"
    store = Parts(out, PRINT, resume=False)
    store.begin()
    store.save((0, 1), rows([{}]))
    (tmp_path / "out.nc.parts" / "00000001-00000002.npz").write_bytes(b"PK\x03\x04 cut off")
    again = Parts(out, PRINT, resume=True)
    assert (again.done(), again.found.cases) == ([(0, 1)], 1)


def test_a_part_that_rots_later_is_named(tmp_path: Path) -> None:
    out = tmp_path / "out.nc"
    store = Parts(out, PRINT, resume=False)
    store.begin()
    store.save((0, 2), rows([{"a-b": 1.0}, {"a-b": 1.5}]))
    (path,) = (tmp_path / "out.nc.parts").glob("*.npz")
    whole = bytearray(path.read_bytes())
    at = whole.index(np.array([1.0, 1.5]).tobytes())
    whole[at] ^= 1
    path.write_bytes(whole)
    message = f"^{re.escape(str(path))}: this part cannot be read: .*; delete it and go on with --resume$"
    with pytest.raises(StudyError, match=message):
        list(store.blocks(10))


@given(at=st.floats(0, 1, exclude_max=True), bit=st.integers(0, 7), cut_off=st.booleans())
@settings(max_examples=150, deadline=None, derandomize=True)
def test_damaged_parts_are_run_again_or_named(
    tmp_path_factory: pytest.TempPathFactory, at: float, bit: int, cut_off: bool
) -> None:
    out = tmp_path_factory.mktemp("parts") / "out.nc"
    store = Parts(out, PRINT, resume=False)
    store.begin()
    good = rows([{"a-b": 1.0}, {}])
    store.save((0, 2), good)
    (path,) = store.folder.glob("*.npz")
    damaged = bytearray(path.read_bytes())
    damaged[int(at * len(damaged))] ^= 1 << bit
    path.write_bytes(damaged[: int(at * len(damaged))] if cut_off else damaged)
    again = Parts(out, PRINT, resume=True)
    kept, told = [], ""
    try:
        kept = list(again.blocks(10))
    except StudyError as error:
        told = str(error)
    assert "\n" not in told
    if told:
        assert told.startswith(f"{path}: this part cannot be read: ")
    else:
        assert len(kept) == len(again.done())
        assert all(same(each, good) for each in kept)


@pytest.mark.parametrize("text", ["[1, 2]", "3", "", "{", '"a"'])
def test_parts_whose_fingerprint_is_damaged(tmp_path: Path, text: str) -> None:
    store = Parts(tmp_path / "out.nc", PRINT, resume=False)
    store.begin()
    (store.folder / "study.json").write_text(text)
    message = f"{store.folder}/study.json: cannot be read; delete {store.folder}"
    with pytest.raises(StudyError, match=f"^{re.escape(message)}$"):
        Parts(tmp_path / "out.nc", PRINT, resume=True)


@given(
    cases=st.lists(
        st.dictionaries(st.sampled_from(["a-b", "b-a", "c-b"]), st.floats(-1, 1)), min_size=1, max_size=20
    ),
    sizes=st.lists(st.integers(1, 6), min_size=20, max_size=20),
    block=st.integers(1, 9),
)
@settings(max_examples=25, deadline=None, derandomize=True)
def test_blocks_are_alike_however_the_parts_were_cut(
    tmp_path_factory: pytest.TempPathFactory, cases: list[dict[str, float]], sizes: list[int], block: int
) -> None:
    store = Parts(tmp_path_factory.mktemp("parts") / "out.nc", PRINT, resume=False)
    store.begin()
    start = 0
    for size in sizes:
        if part := cases[start : start + size]:
            store.save((start, start + len(part)), rows(part))
        start += size
    blocks = list(store.blocks(block))
    assert [len(each["status"]) for each in blocks[:-1]] == [block] * (len(blocks) - 1)
    whole = joined([rows(cases)])
    for k, each in enumerate(blocks):
        wanted = cut(whole, slice(k * block, (k + 1) * block))
        assert each["tip"].tobytes() == wanted["tip"].tobytes()
        for name in ("status", "tip_limiting"):
            assert list(words(each, name).spelled()) == list(words(wanted, name).spelled())
    assert store.found.edges["tip"] == {edge for case in cases for edge in case}


def full(*_: object, **__: object) -> None:
    raise OSError(errno.ENOSPC, "No space left on device")


def test_a_full_disk_is_one_error_and_what_is_finished_stays(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "out.nc"
    store = Parts(out, PRINT, resume=False)
    store.begin()
    store.save((0, 1), rows([{"a-b": 1.0}]))
    message = f"{out}.parts: the disk is full; what is finished is kept: make room and go on with --resume"
    with monkeypatch.context() as patch:
        patch.setattr(np, "savez", full)
        with pytest.raises(StudyError, match=f"^{re.escape(message)}$"):
            store.save((1, 2), rows([{}]))
    assert store.done() == Parts(out, PRINT, resume=True).done() == [(0, 1)]

    def half(path: Path) -> None:
        path.write_text("half")
        full()

    with pytest.raises(StudyError, match=f"^{re.escape(message)}$"):
        store.finish(half)
    assert sorted(entry.name for entry in store.folder.iterdir()) == [
        "0000000000-0000000001.npz",
        "study.json",
    ]


def test_other_troubles_of_the_disk_are_told_as_they_are(tmp_path: Path) -> None:
    def breaks(_: Path) -> None:
        raise OSError(errno.EIO, "Input/output error")

    store = Parts(tmp_path / "out.nc", PRINT, resume=False)
    store.begin()
    with pytest.raises(OSError, match="Input/output error"):
        store.finish(breaks)


def test_drafts_of_a_killed_run_are_cleared(tmp_path: Path) -> None:
    store = Parts(tmp_path / "out.nc", PRINT, resume=False)
    store.begin()
    (store.folder / ".0000000000-0000000001.npz.77.tmp").write_text("half a part")
    (store.folder / "result.nc").write_text("half a result")
    again = Parts(tmp_path / "out.nc", PRINT, resume=True)
    assert again.done() == []
    again.begin()
    assert [entry.name for entry in store.folder.iterdir()] == ["study.json"]


def test_parts_without_their_paper_are_refused(tmp_path: Path) -> None:
    out = tmp_path / "out.nc"
    store = Parts(out, PRINT, resume=False)
    store.begin()
    store.save((0, 1), rows([{}]))
    paper = tmp_path / "out.nc.parts" / "study.json"
    assert json.loads(paper.read_text()) == PRINT
    paper.write_text("{")
    with pytest.raises(StudyError, match=r"study\.json: cannot be read; delete"):
        Parts(out, PRINT, resume=True)
    paper.unlink()
    with pytest.raises(StudyError, match=r"says not what it belongs to; delete it$"):
        Parts(out, PRINT, resume=True)


def test_places_that_take_no_file(tmp_path: Path) -> None:
    with pytest.raises(StudyError, match=r"is a folder; name a file$"):
        Parts(tmp_path, PRINT, resume=False)
    with pytest.raises(StudyError, match=r"there is no such folder; make it first$"):
        Parts(tmp_path / "none" / "out.nc", PRINT, resume=False)
    assert list(tmp_path.iterdir()) == []


def test_a_file_is_whole_or_not_there(tmp_path: Path) -> None:
    def fails(_: object) -> None:
        raise OSError("disk full")

    with pytest.raises(OSError, match="disk full"):
        atomically(tmp_path / "x", fails)
    assert list(tmp_path.iterdir()) == []


def test_memory_keeps_chunks_in_order() -> None:
    store = Memory()
    store.save((1, 2), rows([{}]))
    store.save((0, 1), rows([{"a-b": 1.0}]))
    assert store.done() == [(0, 1), (1, 2)]
    assert store.columns()["tip"][0] == 1.0
    assert np.isnan(store.columns()["tip"][1])
