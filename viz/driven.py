"""A Chromium without a window that a script drives: for tests and benchmarks of pages."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from rover_pin.viz.browser import FLAGS, BrowserError, find_browser

if TYPE_CHECKING:
    from selenium.webdriver import Chrome

READY = "return Boolean(window.roverPin) || /cannot/.test(document.getElementById('loading')?.textContent)"


@contextmanager
def driven(width: int = 1600, height: int = 900, *, patience: float = 120.0) -> Iterator[Chrome]:
    """A fresh browser; what it downloads lands in its `downloads`, a folder that ends with it.

    Args:
        width: of the page, px.
        height: of the page, px.
        patience: s that a script of the page may take.

    Raises:
        BrowserError: no Chromium, no chromedriver or no Selenium.
    """
    try:
        from selenium.webdriver import Chrome, ChromeOptions
        from selenium.webdriver.chrome.service import Service
    except ImportError:
        raise BrowserError(
            "Selenium is not installed", element="selenium", cure="pip install selenium"
        ) from None
    program = shutil.which("chromedriver")
    if program is None:
        cure = "install chromium-driver"
        raise BrowserError(
            "no chromedriver on PATH, which drives Chromium", element="chromedriver", cure=cure
        )
    options = ChromeOptions()
    options.binary_location = find_browser()
    for flag in (*FLAGS, f"--window-size={width},{height}"):
        options.add_argument(flag)
    if hasattr(os, "geteuid") and os.geteuid() == 0:
        options.add_argument("--no-sandbox")  # Chromium refuses its sandbox to root
    with tempfile.TemporaryDirectory(prefix="rover_pin_") as folder:
        options.add_experimental_option("prefs", {"download.default_directory": folder})
        driver = Chrome(options=options, service=Service(program))
        try:
            driver.set_script_timeout(patience)
            driver.set_page_load_timeout(patience)
            inner = driver.execute_script("return [innerWidth, innerHeight]")
            driver.set_window_size(2 * width - inner[0], 2 * height - inner[1])
            driver.downloads = Path(folder)  # type: ignore[attr-defined]
            yield driver
        finally:
            driver.quit()


def open_page(driver: Chrome, path: Path, fragment: str = "", *, patience: float = 120.0) -> None:
    """Open a study's page and wait until it shows something, or says why it cannot."""
    from selenium.webdriver.support.ui import WebDriverWait

    driver.get("about:blank")  # an address that differs in its fragment only would not load anew
    driver.get(path.resolve().as_uri() + (f"#{fragment}" if fragment else ""))
    WebDriverWait(driver, patience, poll_frequency=0.02).until(lambda d: d.execute_script(READY))
