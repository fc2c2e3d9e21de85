"""What MkDocs calls while it builds the site."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File, Files

from docs_build import commands, links, mathml, repository, sidecar, sources

_KEYS = "<!-- keys -->"
_copies: dict[str, Path] = {}


def on_startup(**_: Any) -> None:
    """The sources are laid out for mkdocstrings, which looks for their folder when it reads its settings."""
    sources.mirror(sources.ROOT / "out" / "docs_sources")


def on_config(config: Any) -> Any:
    """Every command gets its place in the list of pages."""
    for part in config.nav:
        if "Commands" in part:
            part["Commands"] = [
                "commands/index.md",
                *({name: f"commands/{name}.md"} for name in commands.commands()),
            ]
    return config


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
    if _KEYS in markdown:
        sidecar.check_words()
        markdown = markdown.replace(_KEYS, sidecar.reference())
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
