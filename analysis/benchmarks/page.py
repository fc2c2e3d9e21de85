"""How large a study's page is, and how quick in a Chromium without a window.

`python -m rover_pin.analysis.benchmarks.page [CASES|OUT.nc] [RUNS]` makes a study of so many cases or takes
a result, writes its page and opens it RUNS times, each in a fresh browser, by a permalink to the last case.
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import xarray as xr

from rover_pin.analysis.benchmarks.page_clock import Opened, opened

if TYPE_CHECKING:
    from selenium.webdriver import Chrome

GROUND = {"rough": {"seed": 1, "rms": 0.05, "hurst": 0.8, "size": 20, "spacing": 0.05}}
VARY = {"x": "map", "y": "map", "yaw_deg": [0, 360], "friction": [0.3, 0.8]}
MEASURES = ["loads", "polygon", "tip", "force_angle", "energy", "zmp", "clearance"]


@dataclass
class PageBench:
    """A page and how it opened.

    Attributes:
        cases: of the study.
        mb: the page's size, million bytes.
        made: s to make it from the result.
        apart: largest difference of a number of the last case from the result, over the rounding that the
            page states of its column; 1 at the most.
        columns: numbers compared.
        opened: each run.
    """

    cases: int
    mb: float
    made: float
    apart: float = 0.0
    columns: int = 0
    opened: list[Opened] = field(default_factory=list)

    def __str__(self) -> str:
        """A few lines."""
        head = f"{self.cases} cases: page of {self.mb:.1f} MB made in {self.made:.1f} s"
        told = (
            f"case {self.cases - 1}: {self.columns} numbers differ by {self.apart:.2f} of the stated rounding"
        )
        return "\n".join([head, f"{told} at most", *map(str, self.opened)])


def page_bench(out: Path, runs: int = 3) -> PageBench:
    """Make the page of a result and open it.

    Args:
        out: the result of a study.
        runs: fresh browsers, one after the other.

    Raises:
        BrowserError: there is no browser to drive.
        ArithmeticError: the table ends before the last case, or the last case's numbers are not the result's.
    """
    from rover_pin.analysis.dataset import read
    from rover_pin.viz.page.result import save_result_page

    with tempfile.TemporaryDirectory() as folder:
        page = Path(folder, "page.html")
        with read(out) as data:
            begun = time.perf_counter()
            save_result_page(data, page)
            made = time.perf_counter() - begun
            found = PageBench(int(data.sizes["case"]), page.stat().st_size / 1e6, made)
        for _ in range(runs):
            with _opened(page, found.cases - 1) as driver:
                found.opened.append(opened(driver, found.cases))
                found.apart, found.columns = _apart(driver, out, found.cases - 1)
    return found


@contextmanager
def _opened(page: Path, case: int) -> Iterator[Chrome]:
    """A fresh browser in which the page shows a case by its permalink."""
    from rover_pin.viz.driven import driven, open_page

    with driven(patience=600.0) as driver:
        open_page(driver, page, f"case={case}", patience=600.0)
        if driver.execute_script("return roverPin.state.chosen") != case:
            raise ArithmeticError(f"the page does not open case {case}")
        yield driver


def _apart(driver: Chrome, out: Path, case: int) -> tuple[float, int]:
    """A case's numbers beside those of the file, read by xarray alone: largest difference over the rounding.

    Raises:
        ArithmeticError: it is above 1 and what doubles lose.
    """
    shown = driver.execute_script(
        "const { cases } = roverPin.state; const i = arguments[0];"
        "return Object.entries(cases.header.columns).filter(([, c]) => c.kind !== 'words')"
        ".map(([name, c]) => [name, cases.at(name, i), c.rounding])",
        case,
    )
    worst, compared = 0.0, 0
    with xr.open_dataset(out, engine="h5netcdf") as data:
        row = data.isel(case=case).load()
    for name, value, rounding in shown:
        variable, _, part = name.partition("/")
        if variable not in row:
            continue  # the lightest and the heaviest wheel, from the loads
        ours = row[variable] if not part else row[variable].sel({row[variable].dims[0]: part})
        difference = abs(float(ours) - value)
        worst = max(worst, difference / rounding if rounding else float(difference > 0))
        compared += 1
    if not worst <= 1 + 1e-6:
        raise ArithmeticError(f"a number of case {case} is {worst:.3g} of its rounding from the result")
    return worst, compared


def study_of(cases: int, folder: Path) -> Path:
    """The result of a study of so many cases on rough ground, in a folder."""
    from rover_pin.analysis.study import Study

    out = folder / "study.nc"
    Study("rocker_bogie", GROUND, cases={"n": cases}, vary=VARY, measures=MEASURES).run(
        engine="process", out=out
    )
    return out


def main(words: list[str]) -> None:
    """Print the figures."""
    what, runs = (words[0] if words else "100000"), int(words[1]) if len(words) > 1 else 3
    with tempfile.TemporaryDirectory() as folder:
        out = study_of(int(what), Path(folder)) if what.isdigit() else Path(what)
        sys.stdout.write(f"{page_bench(out, runs)}\n")


if __name__ == "__main__":
    main(sys.argv[1:])
