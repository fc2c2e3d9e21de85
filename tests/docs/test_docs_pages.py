"""What the pages tell a reader to type runs, and prints what they show."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from docs_build.blocks import run_page, titles

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
HOW_TO = ("measure", "reader", "robot", "element")
INTO_PACKAGES = ("measure", "reader")
PAGES = (
    "files/terrain.md",
    "files/others.md",
    "files/study.md",
    "results.md",
    "api/index.md",
    "howto/robot.md",
    "howto/element.md",
)
LONG = re.compile(r"^\$ rover-pin study.*?(?=^```)", re.M | re.S)


@pytest.mark.parametrize("page", PAGES)
def test_the_blocks_of_a_page_print_what_it_shows(page: str, tmp_path: Path) -> None:
    differences, _ = run_page((DOCS / page).read_text(encoding="utf-8"), tmp_path)
    assert not differences, differences


def test_start_here_prints_what_it_shows_but_for_a_smaller_study(tmp_path: Path) -> None:
    text = (DOCS / "start.md").read_text(encoding="utf-8").replace("2000", "20")
    study = "$ rover-pin study yard.yaml --engine serial --html yard.html\n"
    study += "...\nsettled 20 (100.0 %)\n...\nwrote yard.html\n"
    text, count = LONG.subn(study, text)
    differences, _ = run_page(text, tmp_path)
    assert count == 1
    assert not differences, differences
    assert {"stance.html", "yard.html", "yard.nc", "guessed.yaml"} <= {
        path.name for path in tmp_path.iterdir()
    }


def test_what_the_how_tos_add_is_found_and_runs() -> None:
    """In a process of its own: it finds modules that the pages put into packages."""
    pages = [str(DOCS / "howto" / f"{name}.md") for name in INTO_PACKAGES]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, "-m", "docs_build.blocks", *pages],
        cwd=ROOT,
        env=environment,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr


def test_a_page_that_shows_something_else_is_told(tmp_path: Path) -> None:
    page = '```python\nprint(6 * 7)\n```\n\n```text title="prints"\n43\n```\n'
    differences, real = run_page(page, tmp_path)
    assert [(each.line, each.shown, each.printed) for each in differences] == [(5, "43\n", "42\n")]
    assert real == page.replace("43", "42")
    command = "```console\n$ rover-pin settle nowhere\nerror: all is well\n```\n"
    assert "error: " in run_page(command, tmp_path)[0][0].printed


def test_every_how_to_and_start_has_blocks_that_run() -> None:
    for page in ("start.md", *(f"howto/{name}.md" for name in HOW_TO)):
        text = (DOCS / page).read_text(encoding="utf-8")
        assert titles(text), page
        assert '```text title="prints"\n' in text, page
