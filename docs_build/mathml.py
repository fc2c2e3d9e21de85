"""Formulas: LaTeX between dollars becomes MathML, which browsers draw without a script."""

from __future__ import annotations

import html
import re

from latex2mathml.converter import convert

_FORMULA = re.compile(
    r'<(?P<tag>span|div) class="arithmatex">(?P<open>\\\(|\\\[)(?P<tex>.*?)(?:\\\)|\\\])</(?P=tag)>', re.S
)
_UNKNOWN = re.compile(r"<mi>(\\[A-Za-z]+)</mi>")


def with_mathml(page: str) -> str:
    """The HTML of a page, with MathML in the place of what arithmatex marked.

    Raises:
        ValueError: a command that the converter does not know.
    """
    return _FORMULA.sub(_drawn, page)


def _drawn(found: re.Match[str]) -> str:
    tex = html.unescape(found["tex"]).strip()
    block = found["open"] == r"\["
    drawn = convert(tex, display="block" if block else "inline")
    unknown = _UNKNOWN.search(drawn)
    if unknown:
        raise ValueError(f"formula {tex!r}: {unknown[1]} is unknown to latex2mathml")
    return f'<div class="formula">{drawn}</div>' if block else drawn
