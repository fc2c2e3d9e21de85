"""Constrained inverse kinematics: one quadratic program a step."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, cast

import numpy as np

from rover_pin.errors import InputError, OffMapError
from rover_pin.kinematics.conflict import Side, conflict
from rover_pin.kinematics.instant import Bodies, Instant
from rover_pin.kinematics.limits import (
    CouplingsKept,
    Held,
    JointLimits,
    LoopsClosed,
    SpeedLimits,
    rolling_contacts,
)
from rover_pin.kinematics.program import Program, assemble
from rover_pin.kinematics.rows import Aim, Box, Limit, Task, above
from rover_pin.kinematics.solution import Outcome, Solution
from rover_pin.kinematics.solver import solve, solve_patiently
from rover_pin.kinematics.steering import steering_joints
from rover_pin.numerics import Array

if TYPE_CHECKING:
    from rover_pin.rover import Rover
    from rover_pin.statics.stance import Stance
    from rover_pin.terrain import Terrain


HANGS = 1e-4
"""m: a wheel or foot this far off the ground does not stand, where nobody says which do."""


def usual_limits(lifted: tuple[str, ...] = ()) -> tuple[Limit | Box, ...]:
    """What holds for every rover that rolls: couplings, loops, contacts, joints' places and speeds.

    Args:
        lifted: wheels and feet that do not stand.
    """
    return CouplingsKept(), LoopsClosed(), *rolling_contacts(lifted), JointLimits(), SpeedLimits()


def hanging(at: Instant) -> tuple[str, ...]:
    """Wheels and feet that are off the ground; let down, they count as standing within HANGS of it."""
    gaps = at.contacts[:, 0].tolist()
    return tuple(name for name, gap in zip(at.bodies.names, gaps, strict=True) if gap > HANGS)


class InverseKinematics:
    """Rates of all joints and of the base that do what tasks want as far as limits allow.

    Least squares of the tasks subject to the limits' rows, in v = dq/dt. Among motions that serve the tasks
    alike the least is taken, weighed by `damping`.

    Args:
        rover: what moves.
        terrain: on what.
        damping: weight of a (m/s) squared of every coordinate; of an angle it counts with the wheels' radius,
            where there are only feet with half their distance.

    Raises:
        InputError: a rover that touches nothing, or a damping that is not above 0.
    """

    def __init__(self, rover: Rover, terrain: Terrain, *, damping: float = 1e-5) -> None:
        above("damping", damping)
        self.rover = rover
        self.bodies = Bodies(rover, terrain)
        legs = 0.5 * rover.wheel_span or 0.1
        size = max((wheel.radius for wheel in rover.wheels), default=legs)
        self.damping: Array = damping * np.where(rover.turning, size**2, 1.0)

    def at(self, where: Stance | Instant | Array) -> Instant:
        """The instant of a stance, of a configuration (nv,), or the one given.

        Raises:
            InputError: a configuration of another shape or with an entry that is not finite.
        """
        if isinstance(where, Instant):
            return where
        return self.bodies.at(where.configuration if hasattr(where, "configuration") else where)

    def solve(
        self,
        where: Stance | Instant | Array,
        tasks: Sequence[Task],
        limits: Sequence[Limit | Box] | None = None,
        *,
        dt: float = 0.01,
    ) -> Solution:
        """The rates of one step.

        Args:
            where: a stance, an instant, or q (nv,).
            tasks: what is wanted.
            limits: what is obeyed; silent: `usual_limits(hanging(at))`, and steering holds that no task asks
                for by name. The rows of a step see how fast a wheel is steered, not that it ends up askew:
                steering that is free to serve them wanders.
            dt: s.

        Raises:
            InputError: dt not above 0, an unknown name in a task or limit, an entry that is not finite.
            OffMapError: a wheel or foot that is not over the terrain's map.
        """
        above("dt", dt, "s")
        at = self.at(where)
        self._refuse_off_map(at)
        aims = [task.aim(at, dt) for task in tasks]
        obeyed = _silent_limits(at, aims) if limits is None else limits
        boxes = [cast("Box", limit) for limit in obeyed if hasattr(limit, "box")]
        found = [cast("Limit", limit).rows(at, dt) for limit in obeyed if hasattr(limit, "rows")]
        blocks = [block for block in found if block.names]
        program = assemble(at, aims, blocks, boxes, dt, self.damping)
        try:
            answer = solve(program)
        except InputError:
            _refuse_aims(tasks, aims)
            raise
        fighting: tuple[Side, ...] = ()
        if not answer.solved:
            fighting = conflict(program, self._bound_names(at, program, boxes, dt))
            answer = answer if fighting else solve_patiently(program)
        residuals = {"rows": answer.primal, "optimality": answer.dual}
        if not answer.solved:
            outcome = Outcome.INFEASIBLE if fighting else Outcome.NO_CONVERGENCE
            still = np.zeros(program.nv)
            return Solution(self.rover, outcome, still, {}, {}, residuals, fighting, program)
        velocity = answer.x[: program.nv]
        velocity.setflags(write=False)
        slack: dict[str, float] = {}
        if len(program.bending):
            names = [program.row_names[row] for row in program.bending]
            slack = dict(zip(names, answer.x[program.nv :].tolist(), strict=True))
        for block in blocks:
            if block.equation and block.bend < np.inf:
                slack |= zip(block.names, (block.low - block.matrix @ velocity).tolist(), strict=True)
        asked = _by_name(tasks, aims)
        return Solution(self.rover, Outcome.SOLVED, velocity, slack, asked, residuals, (), program)

    def _refuse_off_map(self, at: Instant) -> None:
        name = at.bodies.off_map(at)
        if name is not None:
            xmin, xmax, ymin, ymax = at.bodies.terrain.extent
            raise OffMapError(
                "is not over the map",
                element=name,
                cure=f"the map spans x {xmin:g} to {xmax:g} m, y {ymin:g} to {ymax:g} m",
            )

    def _bound_names(
        self, at: Instant, program: Program, boxes: Sequence[Box], dt: float
    ) -> dict[tuple[int, bool], str]:
        names = {}
        for each in boxes:
            low, high = each.box(at, dt)
            for i, dof in enumerate(self.rover.dof_names):
                if low[i] == program.floor[i] and np.isfinite(low[i]):
                    names[i, False] = each.bound_name(dof, False)
                if high[i] == program.ceiling[i] and np.isfinite(high[i]):
                    names[i, True] = each.bound_name(dof, True)
        return names


def _silent_limits(at: Instant, aims: Sequence[Aim]) -> tuple[Limit | Box, ...]:
    """The usual ones, and steering held that no row of a task picks."""
    limits = usual_limits(hanging(at))
    picking = [aim.matrix[np.count_nonzero(aim.matrix, axis=1) == 1] for aim in aims]
    column = at.rover.column
    idle = tuple(
        joint
        for joint in steering_joints(at).values()
        if not any(np.any(rows[:, column[joint]]) for rows in picking)
    )
    return (*limits, Held(idle, "steering")) if idle else limits


def _by_name(tasks: Sequence[Task], aims: Sequence[Aim]) -> dict[str, Aim]:
    """What each task asked for; further ones of a name are numbered."""
    asked: dict[str, Aim] = {}
    for task, aim in zip(tasks, aims, strict=True):
        alike = sum(other.name == task.name for other in tasks[: len(asked)])
        asked[f"{task.name} {alike + 1}" if alike else task.name] = aim
    return asked


def _refuse_aims(tasks: Sequence[Task], aims: Sequence[Aim]) -> None:
    """Say which task asks for something that is no number.

    Raises:
        InputError: named by the task.
    """
    for task, aim in zip(tasks, aims, strict=True):
        if not all(np.isfinite(part).all() for part in (aim.matrix, aim.target, aim.weight)):
            raise InputError("has an entry that is no finite number", element=task.name)
