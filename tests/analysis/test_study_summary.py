"""A result in numbers, gathered in blocks: as a sort of the whole column says."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from batch_double import double_study
from hypothesis import given, settings
from hypothesis import strategies as st

from rover_pin.analysis.dataset import read
from rover_pin.analysis.ranks import ranked
from rover_pin.analysis.summary import SHARES, largest_residuals, measures, spread, statuses

numbers = st.floats(allow_nan=False) | st.sampled_from([0.0, -0.0, 1.0, -1.0, np.inf, -np.inf])


def test_the_summary_of_a_file_is_that_of_its_columns(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("rover_pin.analysis.summary.BLOCK", 700)
    double_study(monkeypatch, 5000).run(out=tmp_path / "out.nc")
    data = read(tmp_path / "out.nc")
    words, counts = np.unique(data.status.values.astype(str), return_counts=True)
    assert statuses(data) == dict(zip(words.tolist(), counts.tolist(), strict=True))
    settled = data.status.values == "settled"
    assert measures(data) == ["tip", "loads"]
    tip = spread(data, "tip", 7)
    values = data.tip.values[settled]
    assert list(tip.percentiles.values()) == np.percentile(values, SHARES, method="lower").tolist()
    order = np.argsort(data.tip.values, kind="stable")[:7]
    assert [worst.case for worst in tip.worst] == order.tolist()
    assert [worst.limiting for worst in tip.worst] == data.tip_limiting.values[order].tolist()
    assert largest_residuals(data)["gap_m"] == data.gap_m.values[settled].max()


def test_a_lazily_opened_file_reads_no_table_before_it_is_asked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    data = double_study(monkeypatch, 5000).run(out=tmp_path / "out.nc")
    statuses(data)
    spread(data, "tip")
    assert not any(data[name].variable._in_memory for name in data.data_vars)
    assert int(data.sel(case=4321).case) == 4321
    assert data.isel(case=[5, 7]).case.values.tolist() == [5, 7]


@given(values=st.lists(numbers, min_size=1), cut=st.integers(0, 50), data=st.data())
@settings(max_examples=80, deadline=None, derandomize=True)
def test_ranks_are_those_of_a_sort(values: list[float], cut: int, data: st.DataObject) -> None:
    ranks = data.draw(st.lists(st.integers(0, len(values) - 1), min_size=1, max_size=4))
    column = np.array(values)
    found = ranked(lambda: [block for block in (column[:cut], column[cut:]) if len(block)], ranks)
    assert found == np.sort(column)[ranks].tolist()


@given(
    values=st.lists(st.sampled_from([-np.inf, 0.0, 1.0, 2.0, np.nan]), min_size=1, max_size=30),
    count=st.integers(1, 8),
    better=st.sampled_from(["high", "low"]),
)
@settings(max_examples=60, deadline=None, derandomize=True)
def test_of_equally_bad_cases_the_first_come_first(values: list[float], count: int, better: str) -> None:
    words = [f"edge {i}" for i in range(len(values))]
    variables = {"tip": ("case", values, {"better": better}), "tip_limiting": ("case", words)}
    data = xr.Dataset(variables, coords={"case": np.arange(len(values))})
    sign = 1.0 if better == "high" else -1.0
    keys = {i: sign * value for i, value in enumerate(values) if not np.isnan(value)}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("rover_pin.analysis.summary.BLOCK", 4)
        worst = spread(data, "tip", count).worst
    assert [each.case for each in worst] == sorted(keys, key=lambda i: (keys[i], i))[:count]
    assert [each.limiting for each in worst] == [f"edge {each.case}" for each in worst]
