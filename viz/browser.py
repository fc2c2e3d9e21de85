"""Pictures of pages by a Chromium that runs without a window."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from rover_pin.errors import InputError
from rover_pin.viz.page.html import write_whole

if TYPE_CHECKING:
    from rover_pin.stability.margin import Margin
    from rover_pin.statics.stance import Stance

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
FLAGS = (
    "--headless=new",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--hide-scrollbars",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--force-device-scale-factor=1",
)
PATIENCE = 180  # s; software rendering on a busy machine is slow


class BrowserError(InputError):
    """No browser for pictures, or one that gave none."""


def find_browser() -> str:
    """The path of an installed Chromium or Chrome.

    Raises:
        BrowserError: there is none on PATH.
    """
    for name in NAMES:
        found = shutil.which(name)
        if found:
            return found
    raise BrowserError(
        "no Chromium or Chrome on PATH, which draws the picture",
        element="png",
        cure="install chromium, or save an HTML page, which every browser opens",
    )


def picture(html: str, *, width: int = 1600, height: int = 900, fragment: str = "") -> bytes:
    """A page as PNG.

    Args:
        html: the page's text.
        width: px.
        height: px.
        fragment: what follows `#` in its address.

    Raises:
        BrowserError: no browser, or it made no picture.
    """
    browser = find_browser()
    with tempfile.TemporaryDirectory(prefix="rover_pin_") as folder:
        source, target = Path(folder, "page.html"), Path(folder, "page.png")
        source.write_text(html, encoding="utf-8")
        flags = [*FLAGS, f"--user-data-dir={folder}/profile", f"--window-size={width},{height}"]
        if hasattr(os, "geteuid") and os.geteuid() == 0:
            flags.append("--no-sandbox")  # Chromium refuses its sandbox to root
        address = source.as_uri() + (f"#{fragment}" if fragment else "")
        command = [browser, *flags, "--virtual-time-budget=8000", f"--screenshot={target}", address]
        try:
            done = subprocess.run(command, capture_output=True, timeout=PATIENCE, check=False)
            said = done.stderr.decode("utf-8", "replace").strip().splitlines()[-1:] or ["no message"]
        except (OSError, subprocess.TimeoutExpired) as error:
            said = [str(error).splitlines()[0]]
        if not target.is_file():
            raise BrowserError(
                "made no picture", file=browser, value=said[0], cure="save an HTML page instead"
            )
        return target.read_bytes()


def save_png(
    stance: Stance,
    path: str | Path,
    *,
    width: int = 1600,
    height: int = 900,
    margins: Mapping[str, Margin] | None = None,
) -> Path:
    """Write a picture of a stance's page, whole or not at all.

    Raises:
        BrowserError: no Chromium or Chrome is installed, or it made no picture.
        InputError: the file cannot be written.
    """
    from rover_pin.viz.show import stance_page

    find_browser()  # before the work of drawing
    return write_whole(path, picture(stance_page(stance, margins), width=width, height=height))
