"""Figs 20 and 21: an obstacle under the first road wheel, Polibot beside the X-shaped suspension."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.analysis.papers.chart import Chart, Curve, Mark, Panel
from rover_pin.analysis.papers.finding import PARTLY, Finding, claimed, compared
from rover_pin.analysis.papers.polibot.ground import on_obstacle
from rover_pin.analysis.papers.polibot.reading import front_wheel, read
from rover_pin.statics.settle import settle
from rover_pin.terrain import Terrain

if TYPE_CHECKING:
    from rover_pin.numerics import Array
    from rover_pin.rover import Rover

HIGHEST, COUNT = 0.065, 53
"""m, as high as the first road wheel's radius; heights computed."""

INDIRECT = (
    "an indirect look: the paper gives no springs, track or upper wheels of the X-shaped"
    " robot; ours are chosen,"
    " its track for Polibot's first tension and its upper wheels for the height at which the tension ends"
)


@dataclass(frozen=True, eq=False)
class Climb:
    """One robot with an obstacle under its first road wheel, against the obstacle's height.

    Attributes:
        radius: mm, of that wheel.
        height: (n,) mm.
        theta: (n,) deg, less that on level ground.
        touching: (n,).
        spread: (n,) sigma_N.
        tension: (n,) N.
    """

    radius: float
    height: Array
    theta: Array
    touching: Array
    spread: Array
    tension: Array

    @property
    def share(self) -> Array:
        """(n,) %, height over radius."""
        return 100.0 * self.height / self.radius


def climb(rover: Rover) -> Climb:
    """Settle on every height."""
    wheel = front_wheel(rover)
    radius = next(w.radius for w in rover.wheels if w.name == wheel)
    rest = settle(rover, Terrain.flat())
    heights = np.linspace(0.0, HIGHEST, COUNT)
    found = [read(on_obstacle(rover, wheel, float(h), rest)) for h in heights]
    return Climb(
        1e3 * radius,
        1e3 * heights,
        np.array([r.theta for r in found]) - found[0].theta,
        np.array([r.touching if r.theta == r.theta else np.nan for r in found]),
        np.array([r.spread for r in found]),
        np.array([r.tension for r in found]),
    )


def results(half: Rover, other: Rover) -> tuple[list[Finding], list[Chart]]:
    """Rows and charts of section 5.3."""
    ours, theirs = climb(half), climb(other)
    return _findings(ours, theirs), [_indicators(ours, theirs), _tensions(ours, theirs)]


def _findings(ours: Climb, theirs: Climb) -> list[Finding]:
    slack, crossing = _slack_share(theirs), _crossing(ours, theirs)
    fewest, least = float(np.min(ours.touching)), 100.0 * float(np.min(ours.tension)) / ours.tension[0]
    after = np.flatnonzero(ours.share > crossing) if crossing == crossing else np.arange(0)
    kept = [k for k in after if theirs.tension[k] > 0.0]
    return [
        compared("both robots: first tension, X-shaped over Polibot", "", 1.0,
                 theirs.tension[0] / ours.tension[0], within=0.01, where="Fig. 21", used=True,
                 why="the X-shaped robot's track length was fitted to it"),
        claimed("Polibot: fewest wheels in contact up to 65 mm", "", "4", fewest, fewest == 4.0,
                where="Fig. 20", why="counted above 1e-3 N at every height; not used in the identification"),
        claimed("Polibot: least tension up to 65 mm, of the first", "%", "well above zero", least,
                least > 50.0, where="Fig. 21", why="above half of it counts; not used in the identification"),
        compared("X-shaped: height at which the tension ends, of the radius", "%", 35.0, slack, within=2.5,
                 where="Fig. 21", used=True,
                 why="the height of the X-shaped robot's upper wheels was fitted to it"),
        claimed("X-shaped: sigma_N on level ground, of Polibot's", "", "lower",
                theirs.spread[0] / ours.spread[0], theirs.spread[0] < ours.spread[0], where="Fig. 20",
                at_most=PARTLY, why=INDIRECT),
        compared("height at which Polibot's sigma_N becomes the lower, of the radius", "%", 28.0, crossing,
                 within=2.5, where="Fig. 20", at_most=PARTLY, why=INDIRECT),
        claimed("Polibot's sigma_N above that height, largest share of the X-shaped's", "", "lower",
                max((ours.spread[k] / theirs.spread[k] for k in kept), default=None),
                bool(kept) and all(ours.spread[k] < theirs.spread[k] for k in kept), where="Fig. 20",
                at_most=PARTLY, why=f"as long as the X-shaped robot's track has tension; {INDIRECT}"),
    ]  # fmt: skip


def _slack_share(c: Climb) -> float:
    """Height [% of the radius] at which the tension is gone, linear between cases; NaN where it stays."""
    gone = np.flatnonzero(c.tension <= 1e-6)
    if not len(gone) or gone[0] == 0:
        return float("nan")
    k = int(gone[0])
    before = c.tension[max(k - 2, 0) : k]
    if len(before) < 2 or before[1] >= before[0]:
        return float(c.share[k])
    step = c.share[1] - c.share[0]
    return float(min(c.share[k], c.share[k - 1] + step * before[1] / (before[0] - before[1])))


def _crossing(ours: Climb, theirs: Climb) -> float:
    """Height [% of the radius] from which on sigma_N of `ours` is the lower; NaN: none."""
    apart = ours.spread - theirs.spread
    turns = np.flatnonzero((apart[:-1] > 0.0) & (apart[1:] <= 0.0))
    if not len(turns):
        return float("nan")
    k = int(turns[0])
    return float(np.interp(0.0, [-apart[k], -apart[k + 1]], ours.share[k : k + 2]))


def _pair(ours: Climb, theirs: Climb, what: str, steps: bool = False) -> tuple[Curve, Curve]:
    end = np.where(theirs.tension > 0.0, 1.0, np.nan)  # the paper's curves end where the tension does
    return (
        Curve("Polibot", ours.share, getattr(ours, what), steps=steps),
        Curve("X-shaped", theirs.share, getattr(theirs, what) * end, style="dashed", steps=steps),
    )


def _indicators(ours: Climb, theirs: Climb) -> Chart:
    panels = (
        Panel("change of pitch [deg]", _pair(ours, theirs, "theta")),
        Panel("wheels in contact", _pair(ours, theirs, "touching", steps=True)),
        Panel("$\\sigma_N$", _pair(ours, theirs, "spread"), (Mark(28.0, None, "paper: equal at 28 %"),)),
    )
    return Chart("fig_20", "Fig. 20: obstacle under W3 and the indicators",
                 "obstacle's height over the wheel's radius [%]", panels)  # fmt: skip


def _tensions(ours: Climb, theirs: Climb) -> Chart:
    panel = Panel(
        "tension [N]", _pair(ours, theirs, "tension"), (Mark(35.0, None, "paper: X-shaped ends at 35 %"),)
    )
    return Chart("fig_21", "Fig. 21: obstacle under W3 and track tension",
                 "obstacle's height over the wheel's radius [%]", (panel,))  # fmt: skip
