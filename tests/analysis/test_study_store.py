"""Chunks on disk: whole or not there, theirs or refused; rows joined whatever the cuts."""

from __future__ import annotations

import itertools
import json
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rover_pin.analysis.rows import Columns, Layout, Rows, joined
from rover_pin.analysis.store import Memory, Parts, atomically, missing
from rover_pin.errors import StudyError
from rover_pin.stability.margin import Margin

LAYOUT = Layout(("a", "b"), ("hinge",), ("tip",))
PRINT = {"the terrain": "1", "the robot's description": "2"}


def rows(cases: list[dict[str, float]]) -> Columns:
    """Rows whose tip margin has these edges; an empty case is a failed one."""
    out = Rows(LAYOUT, len(cases))
    for i, edges in enumerate(cases):
        if edges:
            limiting = min(edges, key=edges.__getitem__)
            out.margins(i, {"tip": Margin("tip", edges[limiting], "rad", limiting, edges, "high")})
        else:
            out.failed(i, "tips", "over b")
    return out.columns()


def same(a: Columns, b: Columns) -> bool:
    return list(a) == list(b) and all(
        a[key].dtype.kind == b[key].dtype.kind
        and np.array_equal(a[key], b[key], equal_nan=a[key].dtype.kind == "f")
        for key in a
    )


@given(
    cases=st.lists(
        st.dictionaries(st.sampled_from(["a-b", "b-a", "a", "c-b"]), st.floats(-1, 1)), min_size=1
    ),
    data=st.data(),
)
@settings(max_examples=40, deadline=None, derandomize=True)
def test_rows_join_alike_however_they_are_cut(cases: list[dict[str, float]], data: st.DataObject) -> None:
    cut = data.draw(st.integers(0, len(cases) - 1))
    parts = [part for part in (cases[:cut], cases[cut:]) if part]
    assert same(joined([rows(cases)]), joined([rows(part) for part in parts]))


def test_a_failed_row_has_words_and_no_numbers() -> None:
    columns = rows([{}])
    assert (columns["status"][0], columns["reason"][0], columns["tip_limiting"][0]) == ("tips", "over b", "")
    assert np.isnan(columns["tip"][0])
    assert np.isnan(columns["load_n"]).all()


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
    assert same(again.columns()[0], rows([{"a-b": 1.0}, {}]))
    again.save((2, 3), rows([{"b-a": 2.0}]))
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
    assert Parts(out, PRINT, resume=True).done() == [(0, 1)]


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
    assert store.columns()[0]["tip"][0] == 1.0
