"""Figs 13 to 18: mass, track length and front arm against pitch, contacts, sigma_N and tension.

Each sweep is a Study: a range of one parameter of the half model on level ground.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.analysis.papers.chart import Chart, Curve, Mark, Panel
from rover_pin.analysis.papers.finding import Finding, claimed, compared

if TYPE_CHECKING:
    from rover_pin.numerics import Array
    from rover_pin.rover import Rover

USED = "used in identifying the geometry"


@dataclass(frozen=True, eq=False)
class Sweep:
    """One parameter varied about its value, on level ground.

    Attributes:
        parameter: of the rover.
        change: (n,) %, of its value.
        theta: (n,) deg.
        touching: (n,) wheels that carry.
        spread: (n,) sigma_N.
        tension: (n,) N.
        rear: (n,) N, load of the rear wheel.
    """

    parameter: str
    change: Array
    theta: Array
    touching: Array
    spread: Array
    tension: Array
    rear: Array

    def at(self, change: float, what: str) -> float:
        """A curve's value at a change [%], linear between cases."""
        return float(np.interp(change, self.change, getattr(self, what)))

    def lifted(self, outwards: float) -> float:
        """The change [%] nearest to none, outwards, at which fewer than four wheels carry; NaN: nowhere."""
        there = (self.touching < 4) & (np.sign(self.change) == np.sign(outwards))
        return float(self.change[there][np.argmin(np.abs(self.change[there]))]) if there.any() else np.nan


def sweep(rover: Rover, parameter: str, low: float, high: float, count: int) -> Sweep:
    """A Study of `count` cases from `low` to `high` [%] of change."""
    from rover_pin.analysis.papers.polibot.reading import rear_wheel
    from rover_pin.analysis.study import Study

    nominal = rover.parameters[parameter]
    ends = [nominal * (1.0 + share / 100.0) for share in (low, high)]
    study = Study(
        rover,
        "flat",
        cases={"sampler": "grid", "grid": {parameter: count}},
        vary={"x": 0, "y": 0, "yaw_deg": 0, "parameters": {parameter: ends}},
        measures=["loads"],
    )
    data = study.run()
    rear = data["load_n"].sel(wheel=rear_wheel(rover)).values
    return Sweep(
        parameter,
        100.0 * (data[parameter].values / nominal - 1.0),
        np.degrees(data["pitch_rad"].values),
        data["touching"].values.astype(np.float64),
        data["load_spread"].values,
        data["tension_n"].values[:, 0],
        rear,
    )


def results(rover: Rover) -> tuple[list[Finding], list[Chart]]:
    """Rows and charts of section 5.2."""
    mass = sweep(rover, "mass", 0.0, 80.0, 161)
    length = sweep(rover, "track_length", -0.3, 0.3, 241)
    arm = sweep(rover, "front_arm_length", -1.5, 1.5, 241)
    rows = [*_mass(mass), *_setup(length, arm)]
    return rows, _charts(mass, length, arm)


def _mass(s: Sweep) -> list[Finding]:
    until = s.change <= 65.0 + 1e-9
    theta, spread, tension = (getattr(s, name)[until] for name in ("theta", "spread", "tension"))
    top = float(s.change[until][np.argmax(spread)])
    share = 100.0 * s.at(65.0, "tension") / s.at(0.0, "tension")
    fewest = int(np.min(s.touching[until]))
    return [
        compared("mass +20 %: fall of pitch", "deg", 0.5, s.at(0.0, "theta") - s.at(20.0, "theta"),
                 within=0.1, where="Fig. 13", used=True, why=f"'only half a degree'; {USED}"),
        claimed("steepest rise of pitch with mass", "deg/%", "pitch falls", _rise(s.change[until], theta),
                _rise(s.change[until], theta) <= 0.0, where="Fig. 13", used=True,
                why=f"over +0 to +65 %; negative: it falls everywhere; {USED}"),
        claimed("fewest wheels in contact", "", "always 4", fewest, fewest == 4, where="Fig. 13", used=True,
                why=f"over +0 to +65 %; {USED}"),
        claimed("mass at which sigma_N is largest", "%", "rises, then falls", top,
                0.0 < top < 65.0, where="Fig. 13",
                why="ours falls from the baseline on, so it is largest at the end of the range: the first"
                " rise is not in the identified geometry" if top <= 0.0 else "largest within the range"),
        claimed("sigma_N at +65 % over sigma_N at the baseline", "", "below its maximum",
                s.at(65.0, "spread") / s.at(0.0, "spread"), s.at(65.0, "spread") < float(np.max(spread)),
                where="Fig. 13", used=True, why=f"the later fall; {USED}"),
        claimed("steepest rise of tension with mass", "N/%", "tension falls", _rise(s.change[until], tension),
                _rise(s.change[until], tension) <= 0.0, where="Fig. 14", used=True,
                why=f"over +0 to +65 %; negative: it falls everywhere; {USED}"),
        claimed("mass +65 %: tension, of the baseline's", "%", "almost zero", share, share < 10.0,
                where="Fig. 14", used=True, why=f"below a tenth counts as almost zero; {USED}"),
    ]  # fmt: skip


def _setup(length: Sweep, arm: Sweep) -> list[Finding]:
    """Rows of Figs 15 to 18."""
    rows = []
    for s, name, figures, tight, said in (
        (length, "track", ("Fig. 15", "Fig. 17"), -1.0, -0.15),
        (arm, "front arm", ("Fig. 16", "Fig. 18"), 1.0, 0.7),
    ):
        words = ("shorter", "longer") if tight < 0 else ("longer", "shorter")
        toward = s.change * tight >= -1e-9  # from the baseline to the tight side
        rise = -_rise(s.change[toward] * tight, -s.tension[toward])
        away = (s.change * tight <= 1e-9) & (s.tension > 0.0)
        even = _rise(-s.change[away] * tight, s.spread[away])
        worse = -_rise(s.change[toward] * tight, -s.spread[toward])
        at = s.lifted(tight)
        step = float(s.change[1] - s.change[0])
        rows += [
            claimed(f"slowest rise of tension, {words[0]} {name}", "N/%", "tension rises", rise, rise > 0.0,
                    where=figures[0], used=True, why=f"positive: it rises everywhere; {USED}"),
            claimed(f"steepest rise of sigma_N, {words[1]} {name}", "1/%", "sigma_N falls", even, even < 0.0,
                    where=figures[1], used=True,
                    why=f"negative: it falls everywhere, until the track is slack; {USED}"),
            claimed(f"slowest rise of sigma_N, {words[0]} {name}", "1/%", "less uniform", worse, worse > 0.0,
                    where=figures[1], used=True, why=f"positive: it rises everywhere; {USED}"),
            compared(f"change of {name} that lifts a wheel", "%", said, at,
                     within=0.1 * abs(said), where=figures[1], used=True,
                     why=f"a tenth, as the steps of its sweep are not given; ours to {step:.2g} %; {USED}"),
            claimed(f"load of W6 there, {name}", "N", "W6 is lifted", s.at(at, "rear") if at == at else None,
                    at == at and abs(s.at(at, "rear")) < 1e-3, where=figures[1], used=True,
                    why=f"the wheel that is lifted is the rear one; {USED}"),
        ]  # fmt: skip
    return rows


def _rise(x: Array, y: Array) -> float:
    """Largest slope between neighbours along growing x."""
    order = np.argsort(x)
    return float(np.max(np.diff(y[order]) / np.diff(x[order])))


def _charts(mass: Sweep, length: Sweep, arm: Sweep) -> list[Chart]:
    names = ((mass, "robot mass"), (length, "track length"), (arm, "front-arm length"))
    charts = []
    for (s, name), kpi, pull in zip(names, (13, 17, 18), (14, 15, 16), strict=True):
        x_label = f"change of {name} [%]"
        charts += [
            Chart(f"fig_{kpi}", f"Fig. {kpi}: {name} and the indicators", x_label, _panels(s)),
            Chart(f"fig_{pull}", f"Fig. {pull}: {name} and track tension", x_label,
                  (Panel("tension [N]", (Curve("", s.change, s.tension),), _pull_marks(s)),)),
        ]  # fmt: skip
    return sorted(charts, key=lambda chart: chart.key)


def _panels(s: Sweep) -> tuple[Panel, ...]:
    marks: tuple[Mark, ...] = ()
    lifts = {"track_length": (-0.15, "W6 lifts at -0.15 %"), "front_arm_length": (0.7, "W6 lifts at +0.7 %")}
    fall: tuple[Mark, ...] = ()
    if s.parameter in lifts:
        marks = (Mark(lifts[s.parameter][0], None, f"paper: {lifts[s.parameter][1]}"),)
    else:
        fall = (Mark(20.0, s.at(0.0, "theta") - 0.5, "paper: half a degree less at +20 %"),)
    return (
        Panel("pitch [deg]", (Curve("", s.change, s.theta),), fall),
        Panel("wheels in contact", (Curve("", s.change, s.touching, steps=True),), marks),
        Panel("$\\sigma_N$", (Curve("", s.change, s.spread),)),
    )


def _pull_marks(s: Sweep) -> tuple[Mark, ...]:
    return (Mark(65.0, 0.0, "paper: almost zero at +65 %"),) if s.parameter == "mass" else ()
