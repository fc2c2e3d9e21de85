"""HIT-MRII: a six-wheeled rover that reshapes itself, Tasks 1 to 15.

The paper's signs: a rear arm's angle grows as it swings down; a shortened wheelbase is positive.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from rover_pin.analysis.papers.paper import Paper, Results

if TYPE_CHECKING:
    from rover_pin.rover import Rover

ROBOT = "hit_mrii"

REMARKS = (
    "Equations and tables did not survive in the text: formulas are reconstructed from its words,"
    " lengths from its parameters, and one length is fitted (the front pillar, from the shortening of"
    " 0.326 at 480 mm).",
    "Three total wheelbases stand in the text: 1550 mm, 1900 mm (from the overall length) and 1750 mm (what"
    " Task 14's 2800 mm asks for). The arms' lengths, 775 and 390.7 mm, allow the first.",
    "The tasks are run kinematically: drives do what they are told, wheels roll without sliding forward, and"
    " sideways they scrub as little as the ground and a lifted side allow. At every sample the rover is set"
    " down anew by the statics, which know nothing of the motion; loads are theirs.",
    "Obstacles' lengths, the stair's height, and the clearances from which wheels are lifted are ours: the"
    " text has none.",
)


def _compute(robots: Mapping[str, Rover]) -> Results:
    from rover_pin.analysis.papers.hit_mrii import arithmetic, loads, motion, reshaping, runs, soil

    rover = robots[ROBOT]
    done = runs.run_all(rover)
    rows = [
        *arithmetic.findings(),
        *reshaping.findings(rover, done),
        *loads.findings(rover, done),
        *motion.findings(done),
        *soil.findings(),
    ]
    charts = (*reshaping.charts(rover, done), loads.chart(done))
    named = {f"Task {task.key}: {task.title}": done[task.key] for task in runs.all_tasks()}
    return Results(tuple(rows), charts, named)


PAPER = Paper(
    key="hit_mrii",
    title="HIT-MRII: inverse kinematics control with motion constraints",
    citation="Harbin Institute of Technology; title and authors are not in the text at hand",
    robots=(ROBOT,),
    compute=_compute,
    remarks=REMARKS,
)
