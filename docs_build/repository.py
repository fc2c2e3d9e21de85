"""Links from a page to files of the repository: those become files of the site, so that they work offline."""

from __future__ import annotations

import os
import posixpath
import re
from pathlib import Path

ROOT = Path(__file__).parents[1]
FOLDER = "repository"
"""Where they lie in the site."""

_LINK = re.compile(r"(?<!!)\[([^\]]*)\]\(([^)\s]+)\)")
_FENCE = re.compile(r"^(`{3,}).*?^\1", re.M | re.S)


class MissingFileError(ValueError):
    """A page links to a file of the repository that is not there."""


def outward_links(markdown: str, page: str) -> dict[str, str]:
    """Links of a page that leave the folder `docs`: as written, and the path from the repository's root.

    Args:
        markdown: the page's text.
        page: its path below `docs`.

    Raises:
        MissingFileError: there is no such file.
    """
    found: dict[str, str] = {}
    for _, target in _LINK.findall(_FENCE.sub("", markdown)):
        if "://" in target or target.startswith(("#", "mailto:")):
            continue
        path = posixpath.normpath(posixpath.join("docs", posixpath.dirname(page), target.partition("#")[0]))
        if path.startswith("docs/"):
            continue
        if path.startswith("..") or not (ROOT / path).exists():
            raise MissingFileError(f"docs/{page}: link to {target}: no {path} in the repository")
        found[target] = path
    return found


def with_copies(markdown: str, page: str) -> tuple[str, dict[str, Path]]:
    """A page's text with links into the site's own copies, and what to copy: path in the site, file.

    A link to a folder goes to its `README.md`.

    Raises:
        MissingFileError: there is no such file.
    """
    copies: dict[str, Path] = {}
    for target, path in outward_links(markdown, page).items():
        source = ROOT / path
        if source.is_dir():
            source = source / "README.md"
            if not source.is_file():
                raise MissingFileError(f"docs/{page}: link to {target}: the folder has no README.md")
        place = f"{FOLDER}/{source.relative_to(ROOT).as_posix()}"
        place += "" if source.suffix == ".txt" else ".txt"  # so that a browser shows it
        copies[place] = source
        here = os.path.relpath(place, posixpath.dirname(page) or ".")
        markdown = markdown.replace(f"]({target})", f"]({here})")
    return markdown, copies
