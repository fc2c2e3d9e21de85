"""A stand-in for the compiled path: made-up answers of the same form, each from its case alone."""

from __future__ import annotations

import sys
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from rover_pin.analysis import Study

SETTLED, GROUNDED, OFF_MAP, OPEN = 0, 1, 2, 255
EDGES = {"tip": ["bl-br", "br-fr", "fl-bl", "fr-fl", "never-said"], "loads": ["bl", "br", "fl", "fr"]}


class DoubleAnswers(SimpleNamespace):
    """The fields of `Answers` from the places of the cases."""

    def __init__(self, x: Any, y: Any, yaw: Any, wheels: int, joints: int, measures: Any, left: bool) -> None:
        n = len(x)
        turn = np.sin(37.0 * x + 11.0 * y + yaw)
        code = np.zeros(n, dtype=np.uint8)
        code[turn > 0.9], code[turn < -0.95] = GROUNDED, OFF_MAP
        if left:
            code[np.abs(turn) < 0.05] = OPEN
        settled = code == SETTLED

        def some(values: Any) -> Any:
            return np.where(settled if values.ndim == 1 else settled[:, None], values, np.nan)

        self.who = np.where(settled, -1, (1000 * np.abs(turn)).astype(np.int64) % 3)
        self.depth_m = np.round(np.abs(turn), 2)
        self.z_m, self.roll_rad, self.pitch_rad = some(turn), some(turn / 2), some(turn / 3)
        self.joint_rad = some(turn[:, None] * np.arange(1.0, joints + 1))
        self.load_n = some(100.0 + turn[:, None] * np.arange(1.0, wheels + 1))
        self.redundant = np.floor(3 * np.abs(turn)).astype(np.int64)
        self.equilibrium = some(1e-12 * np.abs(turn))
        self.gap_m = self.loop_m = self.complementarity = self.equilibrium
        self.value = {name: some(turn - k) for k, name in enumerate(measures)}
        self.code, self._turn, self._settled = code, turn, settled

    def labelled(self, measure: str) -> tuple[list[str], Any, NDArray[np.int64]]:
        """A table with gaps; what limits is the edge of the least value."""
        names = EDGES[measure]
        table = self._turn[:, None] + np.arange(float(len(names)))
        if measure == "tip":
            table[self._turn > 0.3, 0] = np.nan
            table[:, -1] = np.nan
        table[~self._settled] = np.nan
        limiting = np.where(self._settled, np.isnan(table[:, 0]).astype(np.int64), -1)
        return names, table, limiting

    def words(self) -> tuple[list[str], list[str]]:
        """One after the other, as a person would write it down."""
        told = {SETTLED: "settled", GROUNDED: "grounded", OFF_MAP: "off_map", OPEN: ""}
        status = [told[int(code)] for code in self.code]
        reasons = [
            f"link {who} lies {depth} m deep" if word == "grounded" else "wheel off" * (word == "off_map")
            for word, who, depth in zip(status, self.who, self.depth_m, strict=True)
        ]
        return status, reasons


class DoubleBatch:
    """Answers every case, or leaves some to the plain path."""

    refusal = ""

    def __init__(self, job: Any, *, left: bool = True) -> None:
        self._layout = job.layout
        self._left = left

    def answer(self, x: Any, y: Any, yaw: Any, **_: Any) -> DoubleAnswers:
        """As `Batch.answer`."""
        layout = self._layout
        wheels, joints = len(layout.wheels), len(layout.joints)
        return DoubleAnswers(x, y, yaw, wheels, joints, layout.margins, self._left)


def stand_in() -> ModuleType:
    """A module with the status codes, where the compiled path's are looked for."""
    module = ModuleType("rover_pin.compiled")
    module.__dict__.update(SETTLED=SETTLED, GROUNDED=GROUNDED, OFF_MAP=OFF_MAP, OPEN=OPEN)
    return module


def install(*, left: bool) -> None:
    """Give every job of this process the double."""
    from rover_pin.analysis.batch import CompiledRows

    sys.modules["rover_pin.compiled"] = stand_in()
    of: Any = classmethod(lambda cls, job: cls(job, DoubleBatch(job, left=left)))
    CompiledRows.of = of  # type: ignore[method-assign]


def double_study(monkeypatch: pytest.MonkeyPatch, n: int, *, left: bool = False) -> Study:
    """A study on the stand-in."""
    from rover_pin.analysis.batch import CompiledRows

    monkeypatch.setitem(sys.modules, "rover_pin.compiled", stand_in())
    of: Any = classmethod(lambda cls, job: cls(job, DoubleBatch(job, left=left)))
    monkeypatch.setattr(CompiledRows, "of", of)
    vary = {"x": [-3, 3], "y": [-3, 3], "yaw_deg": [0, 360]}
    return Study("rocker_bogie", {"slope": 3}, cases={"n": n}, vary=vary, measures=["tip", "loads"])
