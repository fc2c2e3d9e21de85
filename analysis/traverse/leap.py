"""Stances so close along the path that the rover cannot get from one to the other without leaping up.

With the root link held along the path a wheel's height can jump: as it climbs an upright riser the suspension
turns, and the root link would first have to go back. Between, it stands by friction alone, in stances that
let it down were it let go. What they ask for is not worked out, so that such a place counts as a stop.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from rover_pin.analysis.traverse.centres import centres
from rover_pin.analysis.traverse.step import Step

LEAP = 0.02
"""Of a wheel's radius: what its centre may move at once. On an edge it turns the normal by as many rad."""

FASTEST = 3.0
"""What a wheel's centre may move for each m that the root link does."""


def checked(last: Step, there: Step) -> Step:
    """The second of two steps, stopped by `leap` where a wheel and the centre of mass rise there at once.

    Down it falls by itself, so that this stops nothing.
    """
    before, after = last.stood.stance, there.stood.stance
    if there.limit or not (before.settled and after.settled):
        return there
    rover = after.rover
    a, b = last.stood.place, there.stood.place
    gone = abs(b.way - a.way) + rover.wheel_span * abs(b.yaw - a.yaw)
    moved = centres(rover, after.configuration) - centres(rover, before.configuration)
    radii = np.array([shape.ring + shape.tread for shape in rover.shapes])
    excess = np.linalg.norm(moved, axis=1) - FASTEST * gone - LEAP * radii
    worst = int(np.argmax(excess))
    if excess[worst] <= 0.0 or after.com[2] - before.com[2] <= FASTEST * gone:
        return there
    name = str(rover.shapes[worst].name)
    rise = 1e3 * float(np.linalg.norm(moved[worst]))
    why = f"{name} would have to move {rise:.3g} mm at once, and what is asked for between is not known"
    return replace(there, limit="leap", why=why, limiting=name)
