"""The benchmark as tables for people."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rover_pin.cli.output import line, new_table, print_table

if TYPE_CHECKING:
    from rover_pin.analysis.benchmarks import Report, Row

COLUMNS = (
    "work", "method", "processes", "cases", "a second", "with plain", "a cpu second", "to plain",
    "slowest ms", "agreement",
)  # fmt: skip
WORDS = (
    "settle: pose, loads, residuals; row: settle and every cheap measure; the best of several turns counts.",
    "moderate and rough are random squares of 20 m, nodes 0.05 m apart; rough has an rms of half the wheel's",
    "radius. Every method is asked the same places; agreement is the largest difference from the plain path.",
    "a second: on the wall, of the cases that the method itself answers; with plain: those that it leaves",
    "to the plain path answered too; a cpu second: of the processor, of all processes' where there are more.",
    "mujoco: wheels as meshes, locked, on a height field sampled twice a spacing; noslip_iterations 5,",
    "impratio 10, implicitfast, steps of 4 ms; drops that come to rest (every speed below 1e-4) are timed.",
)


def print_bench(report: Report) -> None:
    """Machine, tables, what the words mean, what was left out."""
    known = {name: text for name, text in report.machine.items() if text}
    processor, system = known.pop("processor", ""), known.pop("system", "")
    line(f"{processor}, {system}; " + ", ".join(f"{name} {text}" for name, text in known.items()))
    grown = [row for row in report.rows if _grows(row)]
    _print_methods([row for row in report.rows if not _grows(row)])
    _print_growth("wheels", [row for row in grown if row.wheels is not None])
    _print_growth("map nodes", [row for row in grown if row.nodes is not None])
    _print_studies([row for row in grown if row.work == "study"])
    line("")
    for words in WORDS:
        line(words)
    for why in report.left_out:
        line(f"left out: {why}")


def _grows(row: Row) -> bool:
    return row.wheels is not None or row.nodes is not None or row.work == "study"


def _print_methods(rows: Sequence[Row]) -> None:
    """Every method, a table a scene."""
    scenes: dict[tuple[str, str, str], list[Row]] = {}
    for row in rows:
        scenes.setdefault((row.robot, row.terrain, row.ground), []).append(row)
    for (robot, terrain, ground), own in scenes.items():
        line(f"\n{robot} on {terrain} ground ({ground})")
        table = new_table("", *COLUMNS, left=2)
        for row in own:
            table.add_row(*_cells(row))
        print_table(table)


def _cells(row: Row) -> list[str]:
    return [
        row.work, row.method, str(row.processes), _number(row.cases), _number(row.per_second),
        _number(row.per_second_with_plain), _number(row.per_cpu_second), _share(row.to_plain_path),
        "" if row.slowest_ms is None else f"{row.slowest_ms:.2f}", _agreement(row),
    ]  # fmt: skip


def _print_growth(what: str, rows: Sequence[Row]) -> None:
    if not rows:
        return
    line(f"\nsettles by {what}, {rows[0].terrain} ground")
    table = new_table("", what, "a second", "a cpu second", "to plain", "agreement", left=0)
    for row in rows:
        size = str(row.wheels) if row.wheels is not None else f"{row.nodes} x {row.nodes}"
        table.add_row(
            size,
            _number(row.per_second),
            _number(row.per_cpu_second),
            _share(row.to_plain_path),
            _agreement(row),
        )
    print_table(table)


def _print_studies(rows: Sequence[Row]) -> None:
    if not rows:
        return
    line(f"\nstudies of {rows[0].robot} on {rows[0].ground}, measure tip, one process, streamed to a file")
    table = new_table("", "cases", "a second", "a cpu second", "peak memory MB", "result MB", left=0)
    for row in rows:
        figures = ("" if value is None else f"{value:.0f}" for value in (row.peak_mb, row.disk_mb))
        table.add_row(_number(row.cases), _number(row.per_second), _number(row.per_cpu_second), *figures)
    print_table(table)


def _number(value: float | None) -> str:
    """Thousands apart, three digits or more."""
    if value is None or value == 0:
        return ""
    return f"{value:,.0f}".replace(",", " ") if value >= 100 else f"{value:.3g}"


def _share(value: float | None) -> str:
    return "" if value is None else f"{100 * value:.2g} %"


def _agreement(row: Row) -> str:
    """Largest differences, and what did not end as by the plain path or did not come to rest."""
    told = [f"{value:.0e} {unit}" for unit, value in (row.agreement or {}).items()]
    if row.other_status:
        told.append(f"other status {row.other_status}")
    if row.unsettled:
        told.append(f"restless {row.unsettled}")
    return "  ".join(told)
