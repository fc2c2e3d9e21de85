"""Generated references are whole, and the site's checks find what is wrong."""

from __future__ import annotations

import contextlib
import dataclasses
import io
import json
import os
import re
import shutil
import subprocess
import sys
import types
import typing
from collections.abc import Iterator
from pathlib import Path

import pytest

import rover_pin as rp
from docs_build import commands, hooks, links, mathml, repository, sources, tables
from docs_build.annotations import slug
from docs_build.blocks import run_page
from docs_build.keys import SIDECAR, STUDY, Reference, SilentKeyError
from rover_pin.analysis.chance import FORMS
from rover_pin.analysis.ground import KINDS
from rover_pin.analysis.measures import known_measures
from rover_pin.analysis.schema import ABOUT
from rover_pin.analysis.spec import CHEAP, CasesSpec, StudySpec
from rover_pin.analysis.words import GRAVITIES
from rover_pin.cli import main
from rover_pin.stability.registry import MEASURES
from rover_pin.statics.stance import Status

ROOT = Path(__file__).parents[2]
BY_HAND = ROOT / "docs" / "commands"
QUICK = ("settle", "info", "robots", "slopes", "study", "compare", "traverse")
"""Commands whose example takes no time."""


@pytest.mark.parametrize("name", commands.commands())
def test_every_command_has_a_page_with_all_its_options(name: str) -> None:
    command = commands.commands()[name]
    page = commands.page(name)
    assert commands.summary(command), f"{name} has no docstring"
    assert commands.summary(command) in page
    assert "## Exit status" in page
    for each in command.params:
        assert each.help, f"{name}: {each.name} says nothing"
        assert all(f"`{option}`" in page for option in each.opts if option.startswith("-")), each.name
    assert f"[`{name}`]({name}.md)" in commands.index()


def test_the_pages_by_hand_belong_to_commands() -> None:
    assert {path.stem for path in BY_HAND.glob("*.md")} <= set(commands.commands())


@pytest.mark.parametrize("name", QUICK)
def test_the_keys_that_a_page_lists_are_those_of_the_object(name: str, tmp_path: Path) -> None:
    text = (BY_HAND / f"{name}.md").read_text(encoding="utf-8")
    example = re.search(r"^```sh\nrover-pin (.*)$", text, re.M)
    assert example is not None
    run_page(text, tmp_path)
    out = io.StringIO()
    with _folder(tmp_path), contextlib.redirect_stdout(out):
        assert main([*example[1].split(), "--json"]) == 0
    found = json.loads(out.getvalue())
    told = found[0] if isinstance(found, list) else found
    rows = re.findall(r"^\| (`.*?) \|", text.partition("## The object")[2], re.M)
    listed = {key for row in rows for key in re.findall(r"`(\w+)`", row)}
    assert listed <= set(told)
    assert set(told) - listed <= UNLISTED, "keys that the page does not list"


UNLISTED = {"payload", "gravity", "probabilities", "posture"}
"""What every command says of the question, and what only some studies have."""


@contextlib.contextmanager
def _folder(path: Path) -> Iterator[None]:
    before = Path.cwd()
    os.chdir(path)
    try:
        yield
    finally:
        os.chdir(before)


@pytest.mark.parametrize("reference", [SIDECAR, STUDY], ids=["sidecar", "study"])
def test_every_key_of_a_file_is_explained(reference: Reference) -> None:
    reference.check_words()
    text = reference.markdown()
    for model, key, _ in reference.entries():
        assert f"| `{key}` |" in text, f"{model.__name__}.{key}"
    anchors = {slug(reference.title(model)) for model in reference.nested} | {"all-measures"}
    assert set(re.findall(r"#([\w-]+)\)", text)) <= anchors


def test_the_references_are_of_the_whole_files() -> None:
    sidecar = {key for model, key, _ in SIDECAR.entries() if model is SIDECAR.root}
    assert {"couplings", "loops", "springs", "tracks", "wheels", "retype", "srdf"} <= sidecar
    study = {key for model, key, _ in STUDY.entries() if model is STUDY.root}
    assert study == set(StudySpec.model_fields)
    assert all(f"{kind}:" in STUDY.words["takes"]["StudySpec.terrain"] for kind in KINDS if kind != "file")
    assert all(f"`{world}`" in STUDY.words["keys"]["StudySpec.gravity"] for world in GRAVITIES)
    assert set(CHEAP) == {name for name, measure in MEASURES.items() if measure.cheap}
    page = (ROOT / "docs" / "files" / "study.md").read_text(encoding="utf-8")
    samplers = typing.get_args(CasesSpec.model_fields["sampler"].annotation)
    assert all(f"| `{sampler}` |" in page for sampler in samplers)
    assert all(f"| `{{{kind}: " in page for kind in FORMS)


def test_every_public_name_is_in_the_python_reference() -> None:
    pages = [path.read_text(encoding="utf-8") for path in (ROOT / "docs" / "api").glob("*.md")]
    told = {name for page in pages for name in re.findall(r"^::: (?:\w+\.)*(\w+)$", page, re.M)}
    for package in (rp, rp.analysis, rp.viz):
        rooms = {"analysis", "control", "kinematics", "simulation", "viz"}
        assert set(package.__all__) - rooms <= told, package.__name__


def test_a_key_without_words_and_words_without_a_key_are_refused() -> None:
    def changed(keys: dict[str, str]) -> Reference:
        reference = dataclasses.replace(SIDECAR)
        vars(reference)["words"] = {**SIDECAR.words, "keys": keys}
        return reference

    keys = SIDECAR.words["keys"]
    silent = {name: text for name, text in keys.items() if name != "LoopSpec.axis"}
    with pytest.raises(SilentKeyError, match=r"LoopSpec\.axis is not explained"):
        changed(silent).check_words()
    with pytest.raises(SilentKeyError, match=r"LoopSpec\.axes is no key"):
        changed({**keys, "LoopSpec.axes": "no"}).check_words()


def test_every_measure_and_variable_is_listed_and_every_measure_has_its_formula() -> None:
    assert all(f"| `{name}` |" in tables.measures() for name in known_measures())
    page = (ROOT / "docs" / "mechanics" / "stability.md").read_text(encoding="utf-8")
    assert all(f"| `{name}` |" in page for name in MEASURES), "say by which formula, after whom"
    assert all(f"| `{name}` |" in tables.variables() for name in ABOUT)


def test_the_statuses_on_the_page_are_those_there_are() -> None:
    page = (
        (ROOT / "docs" / "mechanics" / "standing.md")
        .read_text(encoding="utf-8")
        .partition("## How it ends")[2]
    )
    assert re.findall(r"^\| `(\w+)` \|", page, re.M) == [str(status) for status in Status]


def test_pages_that_the_list_does_not_name_get_a_place() -> None:
    config = types.SimpleNamespace(
        docs_dir=str(ROOT / "docs"), nav=[{"Many cases": ["clusters.md"]}, {"Commands": []}, "index.md"]
    )
    hooks.on_config(config)
    assert "clusters.md" not in config.nav[0]["Many cases"][1:]
    assert {"motion.md", "start.md"} < set(config.nav[0]["Many cases"])
    assert {"settle": "commands/settle.md"} in config.nav[1]["Commands"]


def test_a_line_about_several_arguments_becomes_one_for_each() -> None:
    text = '"""A.\n\nArgs:\n    a, b: what\n        goes on.\n    c: Z[i] [m]\n"""\nx, y = 1, 2\n'
    each = "    {}: what\n        goes on.\n"
    split = text.replace(each.format("a, b"), each.format("a") + each.format("b"))
    assert sources.readable(text) == split.replace("] [", "]&#32;[")


def test_links_that_lead_nowhere_are_found(tmp_path: Path) -> None:
    (tmp_path / "a.html").write_text(
        '<p id="x"><a href="b.html#y">1</a><a href="#x">2</a><a href="c.html">3</a>'
    )
    (tmp_path / "b.html").write_text(
        '<a href="a.html#x">1</a><script src="https://cdn.example/m.js"></script>'
    )
    assert links.faults(tmp_path) == [
        "a.html: b.html#y: no such anchor",
        "a.html: c.html: no such file",
        "b.html: loads https://cdn.example/m.js from the network",
    ]


def test_links_to_files_of_the_repository_become_copies() -> None:
    text, copies = repository.with_copies("[a](../urdf/rocker_bogie) `x` [b](start.md)", "motion.md")
    assert text == "[a](repository/urdf/rocker_bogie/README.md.txt) `x` [b](start.md)"
    assert (
        copies["repository/urdf/rocker_bogie/README.md.txt"] == ROOT / "urdf" / "rocker_bogie" / "README.md"
    )
    with pytest.raises(repository.MissingFileError, match=r"docs/files/a\.md: link to \.\./\.\./nothing\.py"):
        repository.with_copies("[a](../../nothing.py)", "files/a.md")


@pytest.mark.parametrize("name", ["README.md", "CONTRIBUTING.md"])
def test_links_of_the_readmes_lead_to_files(name: str) -> None:
    text = (ROOT / name).read_text(encoding="utf-8")
    for target in re.findall(r"\]\(([^)#\s]+)", text):
        assert "://" in target or (ROOT / target).exists(), target


def test_formulas_become_mathml_and_unknown_commands_are_refused() -> None:
    drawn = mathml.with_mathml(r'<span class="arithmatex">\(x \ge 0\)</span>')
    assert "<math" in drawn
    assert "&#x02265;" in drawn or "≥" in drawn
    with pytest.raises(ValueError, match="nonsense"):
        mathml.with_mathml(r'<span class="arithmatex">\(\nonsense x\)</span>')


def test_the_site_builds_strictly(tmp_path: Path) -> None:
    """Every link and anchor, every formula, every docstring of the public surface."""
    shutil.rmtree(ROOT / "out" / "docs_sources", ignore_errors=True)  # as in a fresh clone
    environment = {
        **os.environ,
        "PYTHONPATH": str(ROOT),
        "NO_MKDOCS_2_WARNING": "1",
    }
    done = subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "-q", "--strict", "-d", str(tmp_path / "site")],
        cwd=ROOT, env=environment, capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    site = tmp_path / "site"
    assert {f"{name}.html" for name in commands.commands()} <= {p.name for p in (site / "commands").iterdir()}
    assert "arithmatex" not in (site / "mechanics" / "standing.html").read_text(encoding="utf-8")
