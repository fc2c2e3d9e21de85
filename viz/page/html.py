"""One offline HTML file from the folder's own scripts and styles, Meshcat's viewer and a Pack."""

from __future__ import annotations

import html
import os
import re
import tempfile
from functools import cache
from pathlib import Path

from rover_pin.errors import InputError
from rover_pin.viz.page.pack import Pack

HERE = Path(__file__).resolve().parent
_IMPORT = re.compile(r'^import\s*\{[^}]*\}\s*from\s*"\./([\w.]+)";[^\S\n]*\n?', re.M)
_EXPORT = re.compile(r"^export\s+(?=(?:async\s+)?(?:function|class|const))", re.M)


@cache
def bundle(entry: str) -> str:
    """The module `js/<entry>` and what it imports, each once and after its imports, as one strict script."""
    parts: list[str] = []
    seen: set[str] = set()

    def visit(name: str) -> None:
        if name in seen:
            return
        seen.add(name)
        source = (HERE / "js" / name).read_text(encoding="utf-8")
        for used in _IMPORT.findall(source):
            visit(used)
        parts.append(_EXPORT.sub("", _IMPORT.sub("", source)).strip())

    visit(entry)
    return '(() => {\n"use strict";\n' + "\n\n".join(parts) + "\n})();"


@cache
def viewer() -> str:
    """Meshcat's viewer with the licences of all that is in it, as a script."""
    import meshcat

    home = Path(meshcat.__file__).parent / "viewer"
    licences = [(home / "LICENSE").read_text(encoding="utf-8")]
    for name in ("main.min.js.LICENSE.txt", "main.min.js.THIRD_PARTY_LICENSES.json"):
        licences.append((home / "dist" / name).read_text(encoding="utf-8"))
    notice = "\n".join(licences).replace("*/", "* /").replace("<", "&lt;")
    source = (home / "dist" / "main.min.js").read_text(encoding="utf-8")
    return f"/* MeshCat viewer\n{notice}\n*/\n{source}"


def page(name: str, title: str, pack: Pack, *, connect: str = "'none'") -> str:
    """The whole file.

    Args:
        name: `stance` or `study`: `<name>.html`, `<name>.css` and `js/<name>.js` of this folder.
        title: of the browser's tab.
        pack: what the page shows.
        connect: where the page may connect to, in the words of a Content-Security-Policy; a saved page
            may connect to nothing.
    """
    styles = "\n".join((HERE / f"{part}.css").read_text(encoding="utf-8") for part in ("common", name))
    pieces = {
        "policy": f"default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
        f"img-src data: blob:; connect-src {connect}; base-uri 'none'; form-action 'none'",
        "title": html.escape(title),
        "styles": styles,
        "viewer": viewer(),
        "data": pack.scripts(),
        "script": bundle(f"{name}.js"),
    }
    template = (HERE / f"{name}.html").read_text(encoding="utf-8")
    return re.sub(r"\{\{(\w+)\}\}", lambda found: pieces[found.group(1)], template)


def write_whole(path: str | Path, content: bytes) -> Path:
    """Write a file whole or not at all: a temporary neighbour, then a rename.

    Raises:
        InputError: the folder does not exist or cannot be written to.
    """
    target = Path(path)
    try:
        handle, temporary = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.")
    except OSError as error:
        raise InputError(
            "cannot be written",
            file=target,
            value=error.strerror,
            cure="name a file in a folder you can write to",
        ) from error
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(content)
        umask = os.umask(0)
        os.umask(umask)
        Path(temporary).chmod(0o666 & ~umask)
        Path(temporary).replace(target)
    except OSError as error:
        raise InputError(
            "cannot be written", file=target, value=error.strerror, cure="choose another path"
        ) from error
    finally:
        Path(temporary).unlink(missing_ok=True)
    return target
