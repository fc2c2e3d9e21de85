"""A rover with clutches engaged and some wheels up: the pose in which the other wheels touch, and its loads.

The pose is followed from the one before, as the rover moves. A settle afresh from level ground would not do:
with a clutch engaged a side may stand on its front and middle or on its middle and rear wheels, and from some
tens of millimetres on both are stances at the same rocker angles.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.kinematics.instant import Bodies
from rover_pin.kinematics.tasks.wheel_lift import height
from rover_pin.numerics import Array
from rover_pin.statics.ground import Footing
from rover_pin.statics.held import free_coordinates, held_joints
from rover_pin.statics.newton import Landing, independent_rows, land
from rover_pin.statics.problem import THOROUGH, Integers, Problem
from rover_pin.statics.report import report
from rover_pin.statics.stance import Stance, Status

if TYPE_CHECKING:
    from rover_pin.control.lifting.question import Question


@dataclass(frozen=True)
class Pose:
    """One pose on chosen supports.

    Attributes:
        angles: (m,) of the rockers that turn [rad].
        q: (nv,) configuration.
        slack: (s,) gap of every wheel and foot to the nearest ground [m].
        heights: (m,) of the lifted wheels' lowest points over the ground under their centres [m]; negative
            where one would be in the ground. Beside a step the gap is the smaller of the two.
        loads: per standing wheel [N], negative where it would have to be held down; empty where the supports
            are more than equilibrium determines.
        problem: the equations.
        landing: Newton's last step.
        loops: independent loop rows.
    """

    angles: Array
    q: Array
    slack: Array
    heights: Array
    loads: Mapping[str, float]
    problem: Problem
    landing: Landing
    loops: Integers


class Hoist:
    """The poses of one lift.

    Args:
        question: which wheels, where.
        present: the stance in which the clutches are engaged.
        clutches: joints that are locked, and where.
    """

    def __init__(self, question: Question, present: Stance, clutches: Mapping[str, float]) -> None:
        rover = question.rover
        self.question = question
        self.present = present
        self.locked = tuple(sorted(clutches))
        self.names = tuple(str(shape.name) for shape in rover.shapes)
        self.lifted: Integers = np.array([self.names.index(wheel) for wheel in question.wheels])
        standing = [row for row in rover.bearing if self.names[row] not in question.wheels]
        self.standing: Integers = np.array(standing, dtype=np.int64)
        self.rockers = tuple(side.rocker for side in question.sides)
        self.start: Array = np.array([present.joints[rocker] for rocker in self.rockers])
        self._bodies = Bodies(rover, question.terrain)
        self._held = held_joints(rover, self.locked)
        self._values = {**present.joints, **clutches}

    def pose(self, angles: Array, near: Array) -> Pose | None:
        """The pose at rocker angles (m,), nearest to the configuration `near` (nv,); None: there is none."""
        ask = self.question
        values = {**self._values, **dict(zip(self.rockers, angles.tolist(), strict=True))}
        free = free_coordinates(ask.rover, self._held, values, ask.x, ask.y, ask.yaw)
        problem = Problem(ask.rover, free, ask.gravity)
        z = problem.reduction.pick(near)
        state = problem.state(z, ask.terrain, THOROUGH)
        loops = independent_rows(state.closing)
        active = self.standing
        if len(active) + len(loops) > problem.n:
            active = active[independent_rows(state.motion[active])][: problem.n - len(loops)]
        landing = land(problem, z, ask.terrain, active, loops, window=THOROUGH)
        if landing is None:
            return None
        q = problem.reduction.expand(landing.z)
        at = self._bodies.at(q)
        loads = {self.names[row]: float(landing.multipliers[row]) for row in active}
        return Pose(
            angles=angles,
            q=q,
            slack=at.contacts[:, 0],
            heights=np.array([height(at, row) for row in self.lifted.tolist()]),
            loads=loads if len(active) == len(self.standing) else {},
            problem=problem,
            landing=landing,
            loops=loops,
        )

    def stance(self, pose: Pose) -> Stance:
        """The stance of a pose, its balance, signs and steadiness checked by the statics."""
        landing = pose.landing
        footing = Footing(
            landing.z, Status.SETTLED, None, "", landing.active, pose.loops, landing.sign
        )  # fmt: skip
        return report(pose.problem, footing, self.question.terrain, self.locked)
