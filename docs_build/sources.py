"""The sources as the reader of docstrings wants them: every folder of modules a regular package.

griffe passes over folders without an `__init__.py`, which Python imports all the same (and follows links
back to the folder they point into, hence copies). A unit behind brackets, `Z[i, j] [m]`, would be a link in
Markdown. A line about several arguments, `lower, upper: text`, becomes one for each.
"""

from __future__ import annotations

import os
import re
import shutil
from pathlib import Path

ROOT = Path(__file__).parents[1]

_SECTION = re.compile(r"^( *)(?:Args|Attributes):\n(?:\1    .*\n|\n)+", re.M)
_SEVERAL = re.compile(r"^( +)(\w+(?:, \w+)+): (.*\n(?:\1 +.*\n)*)", re.M)


def mirror(target: Path) -> None:
    """Make `target/rover_pin`: copies of the modules, and an empty `__init__.py` where there is none."""
    shutil.rmtree(target, ignore_errors=True)
    for name, folders, files in os.walk(ROOT / "rover_pin", followlinks=True):
        folders[:] = [each for each in folders if each != "__pycache__"]
        modules = [each for each in files if each.endswith(".py")]
        if not modules:
            continue
        place = target / Path(name).relative_to(ROOT)
        place.mkdir(parents=True)
        for each in modules:
            text = (Path(name) / each).read_text(encoding="utf-8")
            (place / each).write_text(readable(text), encoding="utf-8")
        if "__init__.py" not in modules:
            (place / "__init__.py").touch()


def readable(text: str) -> str:
    """A module's text with docstrings that the reader takes as they are meant."""

    def each(found: re.Match[str]) -> str:
        return "".join(f"{found[1]}{name}: {found[3]}" for name in found[2].split(", "))

    return _SECTION.sub(lambda section: _SEVERAL.sub(each, section[0]), text).replace("] [", "]&#32;[")
