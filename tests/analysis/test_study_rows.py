"""Rows of a study: joined alike whatever the cuts, words as codes."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from rows_double import rows, same

from rover_pin.analysis.rows import joined, words
from rover_pin.analysis.vocabulary import Words, joined_words


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


@given(
    said=st.lists(st.text(alphabet="ab é\N{GREEK SMALL LETTER PI}", max_size=6), min_size=1),
    data=st.data(),
)
@settings(max_examples=60, deadline=None, derandomize=True)
def test_words_come_back_and_join_alike(said: list[str], data: st.DataObject) -> None:
    at = data.draw(st.integers(0, len(said)))
    whole, parts = Words.of(said), [Words.of(said[:at]), Words.of(said[at:])]
    joint = joined_words(parts)
    picked = Words.picked(np.array([3, 1, 1]), ["b", "a", "never", "b"])
    assert (list(picked.known), list(picked.code)) == (["a", "b"], [1, 0, 0])
    assert list(whole.spelled()) == said == list(joint.spelled())
    assert (list(joint.known), joint.code.dtype) == (list(whole.known), whole.code.dtype)
    letters = whole.letters(12)
    assert letters.shape == (len(said), 12)
    assert [row.tobytes().rstrip(b"\0").decode() for row in letters] == said


def test_a_failed_row_has_words_and_no_numbers() -> None:
    columns = rows([{}])
    told = [words(columns, name).spelled()[0] for name in ("status", "reason", "tip_limiting")]
    assert told == ["tips", "over b", ""]
    assert columns["plain_path"][0] == 1
    assert np.isnan(columns["tip"][0])
    assert np.isnan(columns["load_n"]).all()
