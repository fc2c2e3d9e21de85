"""`bench`: a list of rows for machines, tables for people."""

from __future__ import annotations

import json
from typing import Any

import pytest

from rover_pin.analysis.benchmarks import Report, Row
from rover_pin.cli import main

ROWS = [
    Row(
        "settle", "one", "moderate", "rough:1,0.05,0.8", "compiled", 100_000, per_second=150_000.4,
        per_cpu_second=160_000.0, to_plain_path=0.004, agreement={"m": 2e-10, "N": float("inf")},
        per_second_with_plain=100_000.0, compared=20, other_status=2,
    ),
    Row("settle", "one", "moderate", "rough:1,0.05,0.8", "mujoco", 20, per_second=70.0, unsettled=3),
    Row("slowest case", "one", "moderate", "rough:1,0.05,0.8", "compiled", 10, slowest_ms=7.25),
    Row("settle", "8 wheels", "moderate", "rough:1,0.05,0.8", "compiled", 10, per_second=5.0, wheels=8),
    Row("settle", "one", "moderate", "rough:1,0.05,0.8", "compiled", 10, per_second=5.0, nodes=64),
    Row("study", "one", "moderate", "rough:1,0.05,0.8", "compiled", 10**7, peak_mb=700.0, disk_mb=900.0),
]  # fmt: skip


@pytest.fixture
def measured(monkeypatch: pytest.MonkeyPatch) -> list[dict[str, Any]]:
    """What the command asked of the benchmark, which takes no time here."""
    asked: list[dict[str, Any]] = []

    def fake(**words: Any) -> Report:
        asked.append(words)
        return Report(
            ROWS, ["mujoco: it is not installed"], {"processor": "a chip", "system": "Linux", "pin": "4"}
        )

    monkeypatch.setattr("rover_pin.analysis.benchmarks.bench", fake)
    return asked


def test_a_list_of_rows(measured: list[dict[str, Any]], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", "--quick", "--json"]) == 0
    told = capsys.readouterr()
    rows = json.loads(told.out)
    assert len(rows) == len(ROWS)
    assert rows[0]["agreement"] == {"m": 2e-10, "N": None}
    assert (rows[0]["per_second"], rows[0]["compared"]) == (150_000.4, 20)
    assert "slowest_ms" not in rows[0]
    assert rows[2]["slowest_ms"] == 7.25
    assert rows[5]["peak_mb"] == 700.0
    assert told.err == "left out: mujoco: it is not installed\n"
    assert measured[0]["quick"] is True


def test_tables(measured: list[dict[str, Any]], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench"]) == 0
    told = capsys.readouterr().out
    assert told.startswith("a chip, Linux; pin 4\n")
    for words in (
        "one on moderate ground (rough:1,0.05,0.8)",
        "150 000",
        "0.4 %",
        "2e-10 m  inf N  other status 2",
        "restless 3",
        "7.25",
        "settles by wheels, moderate ground",
        "64 x 64",
        "studies of one on rough:1,0.05,0.8, measure tip, one process, streamed to a file",
        "10 000 000",
        "left out: mujoco: it is not installed",
    ):
        assert words in told
    assert measured[0]["quick"] is False
