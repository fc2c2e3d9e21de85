"""Wheelbase and wheel speeds while the chassis is raised and lowered: motion constraints 2 and 3."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.analysis.papers.chart import Chart, Curve, Mark, Panel
from rover_pin.analysis.papers.finding import NOT_REPRODUCED, Finding, claimed, compared, fitted
from rover_pin.control.motion_constraints import motion_constraints
from rover_pin.control.now import Now
from rover_pin.control.plan import load_plan
from rover_pin.kinematics.instant import Bodies
from rover_pin.kinematics.model import complete
from rover_pin.kinematics.wheelbase import wheelbase_row
from rover_pin.statics.settle import settle
from rover_pin.terrain import Terrain

if TYPE_CHECKING:
    from rover_pin.numerics import Array
    from rover_pin.rover import Rover
    from rover_pin.simulation.run import Run

WHERE = "motion constraints 2 and 3, Tasks 3 to 6"
SPEED = 0.0036
STEERING = tuple(f"{wheel}_st" for wheel in ("LF", "LM", "LB", "RF", "RM", "RB"))
BRAKED = tuple(f"{wheel}_dr" for wheel in ("LM", "LB", "RM", "RB"))


def front_speed(rover: Rover, clearance: float) -> float:
    """Front wheels over the ground [mm/s] while the chassis rises at 3.6 mm/s, the others braked."""
    terrain = Terrain.flat()
    stance = settle(rover, terrain, posture={"clearance": clearance})
    at = Bodies(rover, terrain).at(np.array(stance.configuration))
    motion = complete(at, {"clearance": SPEED, **dict.fromkeys((*STEERING, *BRAKED), 0.0)})
    return 1e3 * float(wheelbase_row(at, "LF", "LM") @ motion.velocity)


def shortening(rover: Rover, clearance: float) -> float:
    """Motion constraint 3 at a clearance, from the contacts [-]."""
    terrain = Terrain.flat()
    stance = settle(rover, terrain, posture={"clearance": clearance})
    at = Bodies(rover, terrain).at(np.array(stance.configuration))
    constraint = motion_constraints(rover, load_plan(rover).layout, ["wheelbase"])["wheelbase"]
    still = np.zeros(rover.model.nv)
    return float(np.max(constraint.value(Now(at, still, still))))


def most(run: Run, name: str = "wheelbase") -> float:
    """Largest value of a motion constraint in a run."""
    return float(np.nanmax(np.abs(run.values[name])))


def findings(rover: Rover, runs: Mapping[str, Run]) -> list[Finding]:
    """Rows on reshaping."""
    low, high = front_speed(rover, 0.33), front_speed(rover, 0.48)
    creep = [front_speed(rover, h) for h in (0.25, 0.3944)]
    task_6 = min((0.44, 0.445, 0.45, 0.455, 0.46), key=lambda h: abs(shortening(rover, h) - 0.26))
    within = max(low, high) >= -4.9 and min(low, high) >= -7.2
    return [
        fitted("Task 3: largest shortening of the wheelbase", "", 0.326, most(runs["3"]), where=WHERE,
               why="the front pillar's length was chosen by it"),
        claimed("Task 3: range of the front wheels' speed", "mm/s", "-7.2 to -4.9",
                f"{min(low, high):.2f} to {max(low, high):.2f}", within, where=WHERE, at_most="partly",
                why="from 330 to 480 mm; its ends depend on lengths that are reconstructed"),
        compared("Tasks 4 and 5: largest shortening of the wheelbase", "", 0.15, most(runs["4"]), within=0.01,
                 where=WHERE, why="lift of 144.4 mm, from eq. 42"),
        Finding("Tasks 4 and 5: range of the wheels' speed", "mm/s", "6.8 to 7.1",
                f"{-max(creep):.2f} to {-min(creep):.2f}", NOT_REPRODUCED,
                "a speed of 7 mm/s is that of a shortening near 0.34, and Task 4 ends at 0.15:"
                " the paper's own numbers do not go together", WHERE),
        claimed("Task 6: largest shortening of the wheelbase", "", "around 0.26",
                f"{shortening(rover, task_6):.3f} at {1e3 * task_6:.0f} mm", True, where=WHERE,
                at_most="partly",
                why="its clearance is not printed; at 485 mm, from which ours lifts, it is 0.334"),
        compared("front wheels over the ground at 480 mm, closed form on the same lengths", "mm/s", -6.677,
                 high, within=0.033, where=WHERE, used=True, why="rises at 3.6 mm/s, the others braked"),
    ]  # fmt: skip


def charts(rover: Rover, runs: Mapping[str, Run]) -> list[Chart]:
    """Figs 13 and 14, and pitch over the clearance."""
    heights = np.linspace(0.15, 0.55, 17)
    stances = [settle(rover, Terrain.flat(), posture={"clearance": float(h)}) for h in heights]
    pitch = np.degrees([stance.rpy[1] for stance in stances])
    return [
        _indices("fig_13", "Fig. 13: wheelbase in Task 3", runs["3"], Mark(None, 0.326, "paper, largest")),
        _indices("fig_14", "Fig. 14: wheelbase in Task 4", runs["4"], Mark(None, 0.15, "paper, largest")),
        Chart("pitch", "Pitch of the body over its clearance", "clearance [mm]",
              (Panel("pitch [deg]", (Curve("", 1e3 * heights, pitch),)),), "From the contacts."),
    ]  # fmt: skip


def _indices(key: str, title: str, run: Run, mark: Mark) -> Chart:
    values: Array = run.values["wheelbase"]
    curve = Curve("", run.time, np.max(np.abs(values), axis=1))
    return Chart(key, title, "time [s]", (Panel("shortening [-]", (curve,), (mark,)),))
