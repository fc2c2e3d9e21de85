"""A paper's findings as the table that `reproduce` prints."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING

from rover_pin.analysis.papers import papers
from rover_pin.cli.output import figure, line, new_table, print_json, print_table

if TYPE_CHECKING:
    from rover_pin.analysis.papers import Finding, Paper, Results

WIDTH = 118


def print_papers(*, as_json: bool) -> None:
    """Which papers there are."""
    known = papers()
    if as_json:
        print_json([{"paper": p.key, "title": p.title, "citation": p.citation} for p in known.values()])
        return
    table = new_table("", "paper", "title", left=2)
    for each in known.values():
        table.add_row(each.key, each.title)
    print_table(table)
    line("rover-pin reproduce PAPER sets a paper's figures beside ours")


def print_results(paper: Paper, results: Results) -> None:
    """Rows by where they stand in the paper, each with its reason, and how many have which verdict."""
    line(paper.title)
    line(paper.citation)
    for group in _groups(results.findings):
        _print_group(group)
    count = ", ".join(f"{number} {word}" for word, number in results.verdicts.items())
    line(f"{len(results.findings)} rows: {count}")
    if paper.remarks:
        line("")
        for remark in paper.remarks:
            line(textwrap.fill(remark, WIDTH, initial_indent="- ", subsequent_indent="  "))


def _groups(findings: Sequence[Finding]) -> list[list[Finding]]:
    """Findings that stand in one place of the paper."""
    found: dict[str, list[Finding]] = {}
    for each in findings:
        found.setdefault(each.where, []).append(each)
    return list(found.values())


def _print_group(group: Sequence[Finding]) -> None:
    measured = any(each.measured is not None for each in group)
    extra = ("measured", "to measured") if measured else ()
    table = new_table(group[0].where, "quantity", "unit", "paper", "ours", "error", *extra, "verdict", left=2)
    table.columns[-1].justify = "left"
    for each in group:
        own = (figure(each.measured), _percent(each.error_to_measured_percent)) if measured else ()
        table.add_row(
            each.quantity, each.unit, _value(each.paper), _value(each.ours), _percent(each.error_percent),
            *own, each.verdict,
        )  # fmt: skip
    print_table(table)
    for text, names in _reasons(group).items():
        told = text if len(names) == len(group) else f"{', '.join(names)}: {text}"
        line(textwrap.fill(told, WIDTH, initial_indent="  ", subsequent_indent="    "))
    line("")


def _reasons(group: Sequence[Finding]) -> dict[str, list[str]]:
    """Each reason once, with the quantities that it is for."""
    found: dict[str, list[str]] = {}
    for each in group:
        found.setdefault(each.reason, []).append(each.quantity)
    return found


def _value(value: float | str | None) -> str:
    return value if isinstance(value, str) else figure(value, 5)


def _percent(value: float | None) -> str:
    return "" if value is None else f"{round(value, 1) + 0.0:+.1f} %"
