"""A sheet: one offline HTML file of cards without scripts; tables, bars, figures as vectors."""

from __future__ import annotations

import base64
import html
import io
import re
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from rover_pin.viz.page.html import HERE

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def sheet(title: str, subtitle: str, cards: Iterable[str]) -> str:
    """The whole file's text; `cards` are of `card`."""
    styles = "\n".join((HERE / f"{part}.css").read_text(encoding="utf-8") for part in ("common", "sheet"))
    pieces = {
        "title": html.escape(title),
        "subtitle": html.escape(subtitle),
        "styles": styles,
        "body": "\n".join(cards),
    }
    template = (HERE / "sheet.html").read_text(encoding="utf-8")
    return re.sub(r"\{\{(\w+)\}\}", lambda found: pieces[found.group(1)], template)


def card(title: str, body: str, note: str = "") -> str:
    """A card: `body` is HTML, the others are words."""
    said = f'<p class="dim">{html.escape(note)}</p>' if note else ""
    return f'<section class="card"><h2>{html.escape(title)}</h2>{said}{body}</section>'


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table of words; the first column stands left, the others right."""
    top = "".join(f"<th>{html.escape(word)}</th>" for word in head)
    lines = ("".join(f"<td>{html.escape(word)}</td>" for word in row) for row in rows)
    return f"<table><tr>{top}</tr>{''.join(f'<tr>{line}</tr>' for line in lines)}</table>"


def drawing(figure: Figure, told: str) -> str:
    """A matplotlib figure as a picture within the page; `told` says what it shows."""
    stream = io.BytesIO()
    figure.savefig(stream, format="svg")
    data = base64.b64encode(stream.getvalue()).decode("ascii")
    return f'<figure><img alt="{html.escape(told)}" src="data:image/svg+xml;base64,{data}"></figure>'


def preformatted(text: str) -> str:
    """A text as it stands."""
    return f"<pre>{html.escape(text)}</pre>"
