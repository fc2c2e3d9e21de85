"""A comparison as the object and the tables that `compare` prints."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rover_pin.analysis.comparison.names import letters, lone
from rover_pin.cli.output import figure, line, new_table, print_table

if TYPE_CHECKING:
    from rover_pin.analysis.comparison import Comparison
    from rover_pin.analysis.comparison.result import Pair

NAMED = 20
"""Case numbers that a line names."""


def comparison_object(
    found: Comparison, kept: Mapping[str, Path], html: Path | None, seconds: float
) -> dict[str, Any]:
    """What `compare --json` prints; SI units, differences second minus first."""
    return {
        **found.as_dict(),
        "seconds": seconds,
        "out": {label: str(path) for label, path in kept.items()},
        "html": None if html is None else str(html),
    }


def print_comparison(found: Comparison, seconds: float) -> None:
    """The result for people: each design, its measures, and every pair."""
    first = next(iter(found.datasets.values()))
    line(
        f"{len(found.labels)} designs on {first.attrs['terrain']}: "
        f"the same {found.cases} cases, {seconds:.1f} s"
    )
    letter = letters(found.labels)
    for each in found.designs:
        ended = "  ".join(f"{word} {_share(count / found.cases)}" for word, count in each.status.items())
        low, high = each.tipping_interval
        line(
            f"{letter[each.label]}  {each.label}: {ended}; tips {_share(each.tipping)} "
            f"({_share(low)} to {_share(high)})"
        )
    for a, b in found.same:
        line(f"note: {letter[a]} and {letter[b]} are the same design")
    for label, why in found.left_out.items():
        for name, reason in why.items():
            line(f"note: {name} is left out: {letter[label]} has none, {reason}")
    _print_measures(found, letter)
    for pair in found.pairs:
        _print_pair(found, pair, letter)


def _share(share: float) -> str:
    return f"{100 * share:.1f} %"


def _print_measures(found: Comparison, letter: Mapping[str, str]) -> None:
    heads = [f"{word} {letter[each]}" for word in ("median", "worst", "answers") for each in found.labels]
    table = new_table("each design over the cases it answers", "measure", "unit", "better", *heads, left=3)
    for name, unit in found.units.items():
        spreads = [each.measures[name] for each in found.designs]
        table.add_row(
            name,
            unit,
            found.better[name],
            *(figure(each.median) for each in spreads),
            *(
                f"{figure(each.worst)}" + (f" at {each.worst_case}" if each.worst_case >= 0 else "")
                for each in spreads
            ),
            *(_share(each.answered) for each in spreads),
        )
    print_table(table)


def _print_pair(found: Comparison, pair: Pair, letter: Mapping[str, str]) -> None:
    a, b = letter[pair.first], letter[pair.second]
    table = new_table(
        f"{b} less {a}, case by case ({pair.both} settle in both, {pair.neither} in neither)",
        "measure", "unit", f"median {b} - {a}", "95 % from", "to", f"{a} better", f"{b} better", "equal",
        "better", left=2,
    )  # fmt: skip
    for name, each in pair.measures.items():
        table.add_row(
            name,
            found.units[name],
            *(figure(value, 3) for value in (each.median, each.low, each.high)),
            *(
                "-" if not each.cases else _share(s)
                for s in (each.first_better, each.second_better, each.equal)
            ),
            letter.get(each.winner, "-"),
        )
    print_table(table)
    for told in lone(pair, letter, NAMED):
        line(told)
