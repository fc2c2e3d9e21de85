"""What one opening of a study's page takes, by the page's own clock."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from selenium.webdriver import Chrome

CHOSEN = 31
"""Cases that are selected, one after the other."""

TIMED = """
const done = arguments[arguments.length - 1];
const { state, picture } = roverPin;
const frame = () => new Promise((go) => setTimeout(go, 0));
const now = () => performance.now();
const took = async (deed) => { await frame(); const from = now(); deed(); return now() - from; };
(async () => {
  const out = { chosen: [], drawn: [] };
  const { viewer } = picture.view;
  const gl = viewer.renderer.getContext();
  const seen = () => gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
  for (let k = 0; k < arguments[0]; k++) {
    const i = Math.floor((state.cases.count - 1) * ((k * 0.6180339887) % 1));
    out.chosen.push(await took(() => state.choose(i)));
    out.drawn.push(await took(() => { viewer.render(); seen(); }));
  }
  const table = document.getElementById("table");
  const sort = (name) => table.querySelector(`[data-sort="${name}"]`).click();
  out.sorted = [];
  for (const name of ["x_m", "x_m", "clearance", "case"]) out.sorted.push(await took(() => sort(name)));
  table.scrollTop = table.scrollHeight;
  table.dispatchEvent(new Event("scroll"));
  out.last = [...table.querySelectorAll("tr[data-case]")].map((row) => Number(row.dataset.case)).pop();
  const { low, high } = state.scale;
  out.filtered = await took(() => state.filter(state.measure.name, [low, (low + high) / 2]));
  out.kept = state.selection.count;
  done(out);
})();
"""


@dataclass
class Opened:
    """One opening of the page; times in ms, on the wall.

    Attributes:
        ready: since the browser was told to open it, until everything but the 3D picture stood.
        pictured: until the 3D picture stood as well.
        chosen: a case selected: all of the page but the 3D picture's drawing; median and worst.
        drawn: the 3D picture's drawing, waited for; median.
        sorted: the slowest of four sorts of the table.
        filtered: a range of a histogram.
        load: of the machine, the mean number of processes in the minute before.
    """

    ready: float
    pictured: float
    chosen: tuple[float, float]
    drawn: float
    sorted: float
    filtered: float
    load: float

    def __str__(self) -> str:
        """One line."""
        return (
            f"ready {self.ready / 1e3:.2f} s, with the picture {self.pictured / 1e3:.2f} s; a case "
            f"{self.chosen[0]:.0f} ms (worst of {CHOSEN} {self.chosen[1]:.0f}), "
            f"its picture {self.drawn:.0f} ms; sort {self.sorted:.0f} ms, filter {self.filtered:.0f} ms; "
            f"load {self.load:.1f}"
        )


def opened(driver: Chrome, cases: int) -> Opened:
    """Select, sort, scroll and filter in an open page of so many cases.

    Raises:
        ArithmeticError: the table does not end with the last case.
    """
    ready, pictured = driver.execute_script("return [roverPin.ready, performance.now()]")
    found: dict[str, Any] = driver.execute_async_script(TIMED, CHOSEN)
    if found["last"] != cases - 1:
        raise ArithmeticError(f"the table by case ends with {found['last']}, not {cases - 1}")
    chosen = found["chosen"]
    return Opened(
        ready=ready,
        pictured=pictured,
        chosen=(float(np.median(chosen)), max(chosen)),
        drawn=float(np.median(found["drawn"])),
        sorted=max(found["sorted"]),
        filtered=found["filtered"],
        load=os.getloadavg()[0],
    )
