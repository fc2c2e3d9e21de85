"""A paper's figures as pictures, and its page: the table of findings, the figures, what to know."""

from __future__ import annotations

import base64
import html
import io
import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.viz.page.html import HERE, write_whole
from rover_pin.viz.plots import STYLE, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rover_pin.analysis.papers import Chart, Curve, Finding, Mark, Panel, Paper, Results

OURS, OTHER, SAID = "#0b57a4", "0.25", "#d95f02"
LINES = {"solid": "-", "dashed": "--", "dotted": ":"}
POLICY = "default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'"
COLUMNS = 9


def plot_chart(chart: Chart) -> Figure:
    """A figure of a paper as we compute it, with what the paper's text says of it in orange.

    Returns:
        A matplotlib Figure; `figure.savefig("fig.png")` writes it.
    """
    import matplotlib as mpl

    count = len(chart.panels)
    with mpl.rc_context(STYLE):
        if chart.beside:
            figure = new_figure(2.6 * count, 2.3)
            made: Any = figure.subplots(1, count, squeeze=False, sharey=True)
        else:
            figure = new_figure(3.7, 1.0 + 1.35 * count if count > 1 else 2.6)
            made = figure.subplots(count, 1, squeeze=False, sharex=True)
        axes: list[Axes] = list(made.ravel())
        for each, panel in zip(axes, chart.panels, strict=True):
            _draw_panel(each, panel, titled=chart.beside)
            if chart.beside:
                each.set_xlabel(chart.x_label)
        axes[-1].set_xlabel(chart.x_label)
        if chart.beside:
            axes[0].set_ylabel("z [mm]")
        figure.suptitle(chart.title, fontsize=8.5)
    return figure


def _draw_panel(axes: Axes, panel: Panel, *, titled: bool) -> None:
    from matplotlib.ticker import MaxNLocator

    if titled:
        axes.set_title(panel.label, fontsize=8)
    else:
        axes.set_ylabel(panel.label)
    if panel.equal:
        axes.set_aspect("equal")
    for curve in panel.curves:
        _draw_curve(axes, curve)
    for mark in panel.marks:
        _draw_mark(axes, mark)
    if any(curve.steps for curve in panel.curves):
        low, high = axes.get_ylim()
        axes.set_ylim(np.floor(low) - 0.3, np.ceil(high) + 0.3)
        axes.yaxis.set_major_locator(MaxNLocator(integer=True))
    if panel.marks or any(curve.label for curve in panel.curves):
        axes.legend(frameon=False, fontsize=7, handlelength=2.4)


def _draw_curve(axes: Axes, curve: Curve) -> None:
    colour = "0.6" if curve.faint else OURS if curve.style == "solid" else OTHER
    look: dict[str, Any] = {"color": colour, "linewidth": 0.7 if curve.faint else 1.3}
    if len(curve.x) < 20:
        look |= {"marker": "o", "markersize": 2.5}
    look |= {"drawstyle": "steps-mid"} if curve.steps else {}
    axes.plot(curve.x, curve.y, LINES[curve.style], label=curve.label or None, **look)


def _draw_mark(axes: Axes, mark: Mark) -> None:
    look: dict[str, Any] = {"color": SAID, "linewidth": 0.9, "label": mark.label}
    if mark.x is None and mark.y is not None:
        axes.axhline(mark.y, linestyle=":", **look)
    elif mark.y is None and mark.x is not None:
        axes.axvline(mark.x, linestyle=":", **look)
    elif mark.x is not None and mark.y is not None:
        axes.plot([mark.x], [mark.y], "x", markersize=5, **look)


def save_paper_pictures(results: Results, folder: str | Path) -> list[Path]:
    """Write every figure as `<key>.png` into a folder, which is made where it is not there.

    Raises:
        OSError: they could not be written.
    """
    place = Path(folder)
    place.mkdir(parents=True, exist_ok=True)
    return [write_whole(place / f"{chart.key}.png", _drawn(chart, "png")) for chart in results.charts]


def save_paper_page(paper: Paper, results: Results, path: str | Path) -> Path:
    """Write the page: one file without scripts that needs no network.

    Raises:
        InputError: the place cannot be written to.
    """
    styles = "\n".join((HERE / f"{part}.css").read_text(encoding="utf-8") for part in ("common", "paper"))
    pieces = {
        "policy": POLICY,
        "title": html.escape(paper.title),
        "styles": styles,
        "citation": html.escape(paper.citation),
        "summary": " ".join(_tag(word, f"{n} {word}") for word, n in results.verdicts.items()),
        "rows": _rows(results.findings),
        "charts": "\n".join(_figure(chart) for chart in results.charts),
        "remarks": "\n".join(f"<li>{html.escape(remark)}</li>" for remark in paper.remarks),
    }
    template = (HERE / "paper.html").read_text(encoding="utf-8")
    whole = re.sub(r"\{\{(\w+)\}\}", lambda found: pieces[found.group(1)], template)
    return write_whole(path, whole.encode("utf-8"))


def _drawn(chart: Chart, kind: str) -> bytes:
    file = io.BytesIO()
    plot_chart(chart).savefig(file, format=kind)
    return file.getvalue()


def _figure(chart: Chart) -> str:
    picture = base64.b64encode(_drawn(chart, "svg")).decode("ascii")
    wide = ' class="wide"' if chart.beside else ""
    note = f"<figcaption>{html.escape(chart.note)}</figcaption>" if chart.note else ""
    image = f'<img alt="{html.escape(chart.title)}" src="data:image/svg+xml;base64,{picture}">'
    return f"<figure{wide}>{image}{note}</figure>"


def _rows(findings: Sequence[Finding]) -> str:
    """Findings under a heading each for where they stand in the paper."""
    places = list(dict.fromkeys(each.where for each in findings))
    parts = []
    for place in places:
        head = f'<tr><th colspan="{COLUMNS}">{html.escape(place)}</th></tr>'
        parts.append(f"<tbody>{head}{''.join(_row(f) for f in findings if f.where == place)}</tbody>")
    return "\n".join(parts)


def _row(finding: Finding) -> str:
    cells = [
        f"<td>{html.escape(finding.quantity)}</td>",
        f"<td>{html.escape(finding.unit)}</td>",
        _value(finding.paper),
        _value(finding.ours),
        _value(_percent(finding.error_percent)),
        _value(finding.measured, ""),
        _value(_percent(finding.error_to_measured_percent)),
        f"<td>{_tag(finding.verdict, finding.verdict)}</td>",
        f'<td class="why">{html.escape(finding.reason)}</td>',
    ]
    return f"<tr>{''.join(cells)}</tr>"


def _value(value: float | str | None, none: str = "-") -> str:
    if isinstance(value, str):
        return f'<td class="n words">{html.escape(value)}</td>'
    text = none if value is None else f"{value:.5g}" if abs(value) > 1e-9 else "0"
    return f'<td class="n">{text}</td>'


def _percent(value: float | None) -> str:
    return "" if value is None else f"{round(value, 1) + 0.0:+.1f} %"


def _tag(verdict: str, text: str) -> str:
    return f'<span class="tag {verdict.split()[0]}">{html.escape(text)}</span>'
