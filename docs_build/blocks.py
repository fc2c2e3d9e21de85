"""The code blocks of a page, run one after the other in one folder, as a reader would.

- A block with a title that is a path (`yaml title="rover.yaml"`) is written there.
- `console`: each `$ rover-pin ...` runs, and must print what stands below it; `...` stands for any lines.
- `python` without a title runs, all of a page in one namespace; a block `text title="prints"` after it is
  what it must print.
- Blocks of other kinds (`sh`, `yml`, `text`) are for the eye.

`python -m docs_build.blocks --write docs/start.md` puts in what was printed; without `--write` differences
are told.
"""

from __future__ import annotations

import argparse
import contextlib
import importlib
import io
import os
import re
import shlex
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

_FENCE = re.compile(r'^```(?P<kind>\w+)(?: title="(?P<title>[^"]+)")?\n(?P<body>.*?)^```$', re.M | re.S)
_VARYING = [
    (re.compile(r"\bin [\d.]+ m?s\b"), "in # s"),
    (re.compile(r"(residuals: ).*"), r"\1#"),
    (re.compile(r" +"), " "),
]
PRINTS = "prints"


@dataclass(frozen=True)
class Difference:
    """A block that did not print what the page shows: the page's line, what was shown, what was printed."""

    line: int
    shown: str
    printed: str


def titles(text: str) -> list[str]:
    """Paths of the files that a page has its reader write."""
    return [found["title"] for found in _FENCE.finditer(text) if found["title"] not in (None, PRINTS)]


def run_page(text: str, folder: Path) -> tuple[list[Difference], str]:
    """Run a page's blocks.

    Args:
        text: the page.
        folder: where its files go; it is the current one while the page runs.

    Returns:
        What differs from the page, and the page with what was printed.
    """
    differences: list[Difference] = []
    parts, end, printed, names = [], 0, "", {"__name__": "page"}
    with _within(folder):
        for found in _FENCE.finditer(text):
            kind, title, body = found["kind"], found["title"], found["body"]
            real = body
            if title == PRINTS:
                real = _kept(body, printed)
            elif title is not None:
                _write(Path(title), body)
            elif kind == "console":
                real = _console(body)
            elif kind == "python":
                printed = _python(body, names)
            if real != body:
                differences.append(Difference(text.count("\n", 0, found.start()) + 1, body, real))
            parts += [text[end : found.start("body")], real]
            end = found.end("body")
    return differences, "".join([*parts, text[end:]])


def extend_packages(paths: list[str], folder: Path) -> None:
    """Let packages of rover_pin find the modules that a page puts into them, below `folder`."""
    for path in paths:
        if path.startswith("rover_pin/"):
            package = importlib.import_module(str(Path(path).parent).replace("/", "."))
            place = str(folder / Path(path).parent)
            if place not in package.__path__:
                package.__path__.append(place)


@contextlib.contextmanager
def _within(folder: Path) -> Iterator[None]:
    before = Path.cwd()
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)


def _write(path: Path, body: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(body, encoding="utf-8")


def _python(body: str, names: dict[str, str]) -> str:
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        exec(compile(body, "page", "exec"), names)
    return out.getvalue()


def _console(body: str) -> str:
    """The block with what its commands print."""
    text = []
    for part in re.split(r"^(?=\$ )", body, flags=re.M):
        first, _, shown = part.partition("\n")
        if first:
            text.append(f"{first}\n{_kept(shown, _command(first.removeprefix('$ ')))}")
    return "".join(text)


def _command(words: str) -> str:
    from rover_pin.cli import main

    name, *arguments = shlex.split(words)
    if name != "rover-pin":
        raise ValueError(f"{words}: only rover-pin runs in a console block")
    out = io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(out):
        main(arguments)
    return out.getvalue()


def _kept(shown: str, printed: str) -> str:
    """What the page shows where that is what was printed, but for what varies from run to run."""
    parts = [re.escape(part) for part in _bare(shown).split("\n...\n")]
    if re.fullmatch(r"\n(?:.*\n)*?".join(parts), _bare(printed)):
        return shown
    return "".join(f"{line.rstrip()}\n" for line in printed.rstrip().splitlines())


def _bare(text: str) -> str:
    for pattern, word in _VARYING:
        text = pattern.sub(word, text)
    lines = [line.rstrip() for line in text.replace("─", "").splitlines()]
    return "\n".join(["", *(line for line in lines if line), ""])


def main(arguments: list[str] | None = None) -> int:
    """Run pages; 1 where one differs and was not to be written."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help="put in what was printed")
    parser.add_argument("pages", nargs="+", type=Path)
    given = parser.parse_args(arguments)
    status = 0
    for page in given.pages:
        text = page.read_text(encoding="utf-8")
        with tempfile.TemporaryDirectory() as folder:
            extend_packages(titles(text), Path(folder))
            differences, real = run_page(text, Path(folder))
        for each in differences:
            sys.stderr.write(f"{page}:{each.line}: shown\n{each.shown}printed\n{each.printed}")
        if differences and given.write:
            page.write_text(real, encoding="utf-8")
        elif differences:
            status = 1
    return status


if __name__ == "__main__":
    raise SystemExit(main())
