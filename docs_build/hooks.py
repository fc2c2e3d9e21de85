"""What MkDocs calls while it builds the site."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File, Files

from docs_build import commands, links, mathml, repository, sources, tables
from docs_build.keys import SIDECAR, STUDY, Reference

_copies: dict[str, Path] = {}


def _keys(reference: Reference) -> str:
    reference.check_words()
    return reference.markdown()


GENERATED = {
    "<!-- sidecar keys -->": lambda: _keys(SIDECAR),
    "<!-- study keys -->": lambda: _keys(STUDY),
    "<!-- measures -->": tables.measures,
    "<!-- variables -->": tables.variables,
}
"""What stands in a page in the place of a comment."""

LATER = "Many cases"
"""The part of the list of pages that takes those at the top of `docs` which the list does not name."""


def on_startup(**_: Any) -> None:
    """The sources are laid out for mkdocstrings, which looks for their folder when it reads its settings."""
    sources.mirror(sources.ROOT / "out" / "docs_sources")


def on_config(config: Any) -> Any:
    """Every command gets its place in the list of pages, and every page that has none."""
    listed = set(_listed(config.nav))
    for part in config.nav:
        if LATER in part:
            pages = sorted(path.name for path in Path(config.docs_dir).glob("*.md"))
            part[LATER] += [page for page in pages if page not in listed]
        if "Commands" in part:
            part["Commands"] = [
                "commands/index.md",
                *({name: f"commands/{name}.md"} for name in commands.commands()),
            ]
    return config


def _listed(nav: Any) -> list[str]:
    """Paths that a list of pages names, at any depth."""
    if isinstance(nav, str):
        return [nav]
    return [path for each in (nav.values() if isinstance(nav, dict) else nav) for path in _listed(each)]


def on_files(files: Files, config: Any) -> Files:
    """Pages of commands that have none written by hand; those of commands that are not there are left out."""
    known = commands.commands()
    for file in list(files):
        folder, _, page = file.src_uri.rpartition("/")
        if folder == "commands" and page.removesuffix(".md") not in known:
            files.remove(file)
    for name in ("index", *known):
        if files.get_file_from_path(f"commands/{name}.md") is None:
            content = commands.index() if name == "index" else ""
            files.append(File.generated(config, f"commands/{name}.md", content=content))
    return files


def on_page_markdown(markdown: str, page: Any, config: Any, files: Files) -> str:
    """Generated parts, and links to files of the repository."""
    folder, _, name = page.file.src_uri.rpartition("/")
    name = name.removesuffix(".md")
    if folder == "commands" and name != "index":
        markdown = commands.page(name, markdown)
    for mark, made in GENERATED.items():
        if mark in markdown:
            markdown = markdown.replace(mark, made())
    try:
        markdown, copies = repository.with_copies(markdown, page.file.src_uri)
    except repository.MissingFileError as error:
        raise PluginError(str(error)) from error
    for place, source in copies.items():
        if files.get_file_from_path(place) is None:
            files.append(File.generated(config, place, abs_src_path=str(source)))
    _copies.update(copies)
    return markdown


def on_page_content(html: str, page: Any, **_: Any) -> str:
    """Formulas."""
    try:
        return mathml.with_mathml(html)
    except ValueError as error:
        raise PluginError(f"{page.file.src_uri}: {error}") from error


def on_post_build(config: Any) -> None:
    """Copies of files that pages link to, then all links."""
    site = Path(config.site_dir)
    for place, source in _copies.items():
        (site / place).parent.mkdir(parents=True, exist_ok=True)
        (site / place).write_bytes(source.read_bytes())
    found = links.faults(site)
    if found:
        raise PluginError("links that lead nowhere:\n" + "\n".join(found))
