"""The page of a comparison: figures of each design, and of every pair case by case."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

from rover_pin.analysis.comparison.names import letters, lone
from rover_pin.viz.comparison import plot_pair, plot_spreads
from rover_pin.viz.page.html import write_whole
from rover_pin.viz.page.sheet import card, drawing, sheet, table
from rover_pin.viz.units import ranked, shown, title_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rover_pin.analysis.comparison import Comparison
    from rover_pin.analysis.comparison.result import Pair

READING = (
    "Figures: distributions with medians; case against case (above the line the second has more); "
    "differences with the interval of their median; where they lie (purple: the second is better, "
    "orange: worse)."
)
NAMED = 60
"""Case numbers that the page names."""


def save_comparison_page(found: Comparison, path: str | Path) -> Path:
    """Write the page of a comparison: one offline HTML file without scripts, whole or not at all.

    Args:
        found: of `rover_pin.analysis.compare` or `paired`.
        path: of the file.

    Raises:
        InputError: the file cannot be written.
    """
    return write_whole(path, comparison_page(found).encode("utf-8"))


def comparison_page(found: Comparison) -> str:
    """The page's HTML text."""
    names = letters(found.labels)
    data = next(iter(found.datasets.values()))
    cards = [_designs(found, names), *(_pair(found, pair, names) for pair in found.pairs)]
    cards += [_measure(found, measure, names) for measure in ranked(found.units)]
    title = " beside ".join(found.labels[:3]) + (" ..." if len(found.labels) > 3 else "")
    subtitle = (
        f"{data.attrs['terrain']}: the same {found.cases} cases; {str(data.attrs.get('created', ''))[:10]}"
    )
    return sheet(title, subtitle, cards)


def _designs(found: Comparison, names: Mapping[str, str]) -> str:
    """How each design's cases ended."""
    rows = []
    for each in found.designs:
        low, high = each.tipping_interval
        ended = ", ".join(f"{word} {count}" for word, count in each.status.items())
        attrs = found.datasets[each.label].attrs
        tips = f"{_share(each.tipping)} ({_share(low)} to {_share(high)})"
        more = (f"{float(attrs['gravity']):g} m/s²", str(attrs.get("payload", "")) or "–")
        rows.append([f"{names[each.label]}  {each.label}", ended, tips, *more])
    head = ["design", "cases ended", "tips (95 %)", "gravity", "payload"]
    notes = [f"{names[a]} and {names[b]} are the same design." for a, b in found.same]
    notes += [
        f"{name} is left out: {names[label]} has none, {reason}."
        for label, why in found.left_out.items()
        for name, reason in why.items()
    ]
    return card("Designs", table(head, rows), " ".join([*notes, READING]))


def _pair(found: Comparison, pair: Pair, names: Mapping[str, str]) -> str:
    """A pair's table, and the cases in which one alone settles."""
    a, b = names[pair.first], names[pair.second]
    head = ["measure", f"median {b} - {a}", "95 %", "unit", f"{a} better", f"{b} better", "equal", "better"]
    rows = []
    for measure in ranked(found.units):
        told = pair.measures[measure]
        unit, factor = shown(found.units[measure])
        numbers = [_number(factor * value) for value in (told.median, told.low, told.high)]
        shares = [_share(value) for value in (told.first_better, told.second_better, told.equal)]
        winner = names.get(told.winner, "–")
        rows.append([title_of(measure), numbers[0], f"{numbers[1]} to {numbers[2]}", unit, *shares, winner])
    notes = [f"{pair.both} cases settle in both, {pair.neither} in neither."]
    notes += [f"{told[0].upper()}{told[1:]}." for told in lone(pair, names, NAMED)]
    return card(f"{b} less {a}, case by case", table(head, rows), " ".join(notes))


def _measure(found: Comparison, measure: str, names: Mapping[str, str]) -> str:
    """A measure's figures: all designs, then every pair."""
    attrs = found.datasets[found.labels[0]][measure].attrs
    pictures = [drawing(plot_spreads(found, measure, names), f"distributions of {measure}")]
    pictures += [
        drawing(plot_pair(found, pair, measure, names), f"{measure}: {pair.second} beside {pair.first}")
        for pair in found.pairs
    ]
    body = f'<div class="pictures">{"".join(pictures)}</div>'
    return card(title_of(measure, attrs), body)


def _share(share: float) -> str:
    return "–" if math.isnan(share) else f"{100 * share:.1f} %"


def _number(value: float) -> str:
    return "–" if math.isnan(value) else f"{value:.3g}" if abs(value) > 1e-9 else "0"
