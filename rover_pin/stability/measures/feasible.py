"""Feasible region: the support region within the motors' torques too (Orsolino et al. 2020)."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.stability.com_region import held_level, region_margin
from rover_pin.stability.margin import Margin
from rover_pin.stability.measure import Measure, Standing
from rover_pin.statics.balance import balance
from rover_pin.statics.com_reach import ComReach, Motors

if TYPE_CHECKING:
    from rover_pin.rover import Rover
    from rover_pin.statics.stance import Stance


def evaluate(standing: Standing) -> Margin:
    """Signed distance [m] of the centre of mass from the edge of the feasible region.

    As `region`, and every driven joint keeps |torque| <= the URDF's `effort`: a driven joint gets a row of
    its own that its motor alone balances (with what couplings and loops take off it); a wheel's drive holds
    its rolling forces times their lever. Joints without an effort, brakes and locks hold any torque.

    Edges, note, details and outline are those of `region`; the note names motors that give all they can.

    Cost: 25 ms a stance with six wheels.
    """
    stance = standing.stance
    if not stance.contacts:
        return MEASURE.closed("0 contacts span no region")
    if said := missing(stance.rover):
        return MEASURE.closed(said)
    motors = limited_motors(stance)
    problem = replace(standing.problem, rows=balance(stance, motors.joints))
    return region_margin(
        MEASURE,
        stance,
        ComReach(problem, motors),
        "friction and the motors' efforts hold no place of the centre of mass",
    )


def limited_motors(stance: Stance) -> Motors:
    """The motors with an effort: of wheels by their contacts' levers, of other driven joints by rows."""
    rover, contacts = stance.rover, stance.contacts
    limited = [name for name in rover.actuated if np.isfinite(rover.effort[rover.column[name]])]
    drives = {w.drive: w.name for w in rover.wheels if w.drive is not None}
    joints = [name for name in limited if name not in drives and name not in stance.locked]
    turning = [name for name in limited if name in drives]

    def efforts(names: list[str]) -> list[float]:
        return [float(rover.effort[rover.column[name]]) for name in names]

    levers = [[c.radius if c.wheel == drives[name] else 0.0 for c in contacts] for name in turning]
    return Motors(
        joints=joints,
        effort=np.array(efforts(joints)),
        drives=turning,
        levers=np.array(levers, dtype=np.float64).reshape(len(turning), len(contacts)),
        drive_effort=np.array(efforts(turning)),
    )


def missing(rover: Rover) -> str:
    """What the rover lacks, or nothing."""
    if level := held_level(rover):
        return level
    limited = any(np.isfinite(rover.effort[rover.column[name]]) for name in rover.actuated)
    return "" if limited else f"no driven joint of {rover.name} has an effort in the URDF"


MEASURE = Measure("feasible", "m", "high", 25.0, evaluate, missing)
