"""Loads of wheels: Sections 8.4 and 8.5, from the statics with clutches engaged."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.analysis.papers.chart import Chart, Curve, Mark, Panel
from rover_pin.analysis.papers.finding import NOT_REPRODUCED, Finding, claimed, compared
from rover_pin.statics.settle import settle
from rover_pin.terrain import Terrain

if TYPE_CHECKING:
    from rover_pin.rover import Rover
    from rover_pin.simulation.run import Run

WHERE = "loads, Tasks 6, 7, 12 and 13"
WHEELS = ("LF", "LM", "LB", "RF", "RM", "RB")


def lifted_loads(run: Run, wheels: tuple[str, ...]) -> dict[str, float]:
    """Loads [N] at the last sample in which just these wheels hang and the lift is done.

    Raises:
        ValueError: there is none.
    """
    held = [
        i for i, (names, action) in enumerate(zip(run.lifted, run.actions, strict=True))
        if set(names) == set(wheels) and action.startswith("roll with")
    ]  # fmt: skip
    if not held:
        raise ValueError(f"{' and '.join(wheels)} never hang in this run: {run.status}, {run.reason}")
    return {name: float(run.loads[name][held[-1]]) for name in WHEELS}


def difference(loads: Mapping[str, float], lifted: tuple[str, ...]) -> float:
    """Largest less least load of the wheels that stand [N]."""
    standing = [load for name, load in loads.items() if name not in lifted]
    return max(standing) - min(standing)


def deviation(loads: Mapping[str, float], lifted: tuple[str, ...]) -> float:
    """Largest difference of a standing wheel's load from their mean [N]."""
    standing = np.array([load for name, load in loads.items() if name not in lifted])
    return float(np.max(np.abs(standing - standing.mean())))


def findings(rover: Rover, runs: Mapping[str, Run]) -> list[Finding]:
    """Rows on loads."""
    home = settle(rover, Terrain.flat())
    front = lifted_loads(runs["6"], ("RF",))
    middle = lifted_loads(runs["6"], ("RM",))
    rear = lifted_loads(runs["6"], ("RB",))
    both = lifted_loads(runs["12 LF+RF 200"], ("LF", "RF"))
    behind = lifted_loads(runs["13 LB+RB 200"], ("LB", "RB"))
    share = abs(middle["RF"] - middle["RB"]) / middle["RF"]
    return [
        compared("mean load of a wheel", "N", 380.0, float(np.mean(list(home.loads.values()))), within=15.0,
                 where=WHERE, why="225 kg on six wheels; the text says approximately"),
        compared("right front lifted 180 mm: largest less least load", "N", 826.0,
                 difference(front, ("RF",)), within=30.0, where=WHERE,
                 why="from a clearance of 485 mm, which is ours; soil and sensors are not in a static model"),
        claimed("right front lifted: who carries", "N", "middle most, rear nearly suspended",
                f"RM {front['RM']:.0f}, RB {front['RB']:.0f}",
                max(front, key=lambda name: front[name]) == "RM" and front["RB"] < 0.5 * front["LB"],
                where=WHERE, why="from the statics"),
        compared("right rear lifted 180 mm: largest less least load", "N", 1050.0,
                 difference(rear, ("RB",)), within=30.0, where=WHERE, at_most="partly",
                 why="from a clearance of 200 mm, which is ours; from 200 to 250 mm it is 950 to 1090 N"),
        claimed("right middle lifted: front and rear share alike", "", "almost equally",
                f"RF {middle['RF']:.0f}, RB {middle['RB']:.0f} N", share < 0.05, where=WHERE,
                why="from the statics"),
        compared("right middle lifted: largest less least load", "N", 250.0, difference(middle, ("RM",)),
                 within=30.0, where=WHERE, why="the paper's is an average over the motion, on soil"),
        compared("front pair lifted: largest less least load", "N", 1300.0, difference(both, ("LF", "RF")),
                 within=30.0, where=WHERE,
                 why=f"half the weight, {home.weight / 2:.0f} N, is the most of a symmetric static lift"),
        compared("rear pair lifted: largest less least load", "N", 1189.0, difference(behind, ("LB", "RB")),
                 within=30.0, where=WHERE,
                 why=f"half the weight, {home.weight / 2:.0f} N, is the most of a symmetric static lift"),
        compared("rear pair lifted: largest difference from the mean", "N", 612.0,
                 deviation(behind, ("LB", "RB")), within=30.0, where=WHERE, why="level ground here"),
        Finding("right rear lifted: load of the left front", "N", "nearly 0 (seesaw)", rear["LF"],
                NOT_REPRODUCED,
                "an ideal differential decouples the sides: the diagonal wheel keeps its load", WHERE),
        _stair(runs["7"]),
        *_slopes(rover),
    ]  # fmt: skip


def _stair(run: Run) -> Finding:
    done = run.status == "done"
    return claimed("Task 7: all pairs onto the stair", "", "done", run.status, done, where=WHERE,
                   why="front and middle pairs climb; " + (run.reason or "the rear pair too"))  # fmt: skip


def _slopes(rover: Rover) -> list[Finding]:
    """What friction standing asks for on slopes, beside an inscribed pyramid of four edges and the cone."""
    mu = 0.6
    rows = []
    for degrees, feasible in ((20.0, True), (30.0, False)):
        stance = settle(rover, Terrain.slope(degrees))
        asked = max(math.tan(math.acos(float(c.normal[2]))) for c in stance.contacts)
        ours = asked <= mu / math.sqrt(2.0)
        cone = "holds" if asked <= mu else "does not hold"
        word = "feasible" if feasible else "not feasible"
        rows.append(
            claimed(f"standing on {degrees:.0f} deg", "", word, "feasible" if ours else "not feasible",
                    ours == feasible, where="feasibility, eqs 39 and 40",
                    why=f"asks for {asked:.3f}; an inscribed pyramid of 4 edges leaves 0.424 of 0.6"
                    f" (22.99 deg); under the cone it {cone}")
        )  # fmt: skip
    return rows


def chart(runs: Mapping[str, Run]) -> Chart:
    """Loads against time in Task 6."""
    run = runs["6"]
    curves = tuple(
        Curve(name, run.time, run.loads[name], style="solid" if name[0] == "R" else "dashed",
              faint=name[0] == "L")
        for name in WHEELS
    )  # fmt: skip
    spread = np.array([difference({n: float(run.loads[n][i]) for n in WHEELS}, run.lifted[i])
                       for i in range(len(run.time))])  # fmt: skip
    marks = (Mark(None, 826.0, "paper, front lifted"), Mark(None, 1050.0, "paper, rear lifted"))
    panels = (
        Panel("load [N]", curves),
        Panel("largest less least [N]", (Curve("", run.time, spread),), marks),
    )
    return Chart("fig_15_loads", "Fig. 15: loads in Task 6", "time [s]", panels)
