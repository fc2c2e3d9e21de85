"""The sources as the reader of docstrings wants them: every folder of modules a regular package.

griffe passes over folders without an `__init__.py`, which Python imports all the same (and follows links
back to the folder they point into, hence copies). A unit behind brackets, `Z[i, j] [m]`, would be a link in
Markdown.
"""

from __future__ import annotations

import os
import shutil
from pathlib import Path

ROOT = Path(__file__).parents[1]


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
            (place / each).write_text(text.replace("] [", "]&#32;["), encoding="utf-8")
        if "__init__.py" not in modules:
            (place / "__init__.py").touch()
