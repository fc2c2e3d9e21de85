"""What one step of inverse kinematics comes to."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.kinematics.conflict import Side
from rover_pin.kinematics.rows import Aim
from rover_pin.numerics import Array

if TYPE_CHECKING:
    from rover_pin.kinematics.program import Program
    from rover_pin.rover import Rover


class Outcome(str, Enum):
    """How a step ended; only `solved` has rates."""

    SOLVED = "solved"
    INFEASIBLE = "infeasible"
    NO_CONVERGENCE = "no_convergence"

    def __str__(self) -> str:
        """The word used in tables and files."""
        return self.value


MOST_TOLD = 8
STRUCTURE = ("contact of", "coupling", "loop")


def told(fighting: Sequence[Side]) -> str:
    """The rows that fight: those somebody asked for first, then what always holds; shortened."""
    asked = [str(side) for side in fighting if not side.name.startswith(STRUCTURE)]
    always = [side.name for side in fighting if side.name.startswith(STRUCTURE)]
    words = asked + always
    more = len(words) - MOST_TOLD
    return "; ".join(words[:MOST_TOLD]) + (f"; and {more} more" if more > 0 else "")


@dataclass(frozen=True)
class Solution:
    """The rates of one step, or why there are none.

    Attributes:
        rover: whose.
        outcome: `solved`, `infeasible` or `no_convergence`.
        velocity: (nv,) dq/dt, columns named by `Rover.dof_names`; zeros where it is not solved.
        slack: what rows that bend are missed by [m/s or rad/s], by name.
        aims: what each task asked for.
        residuals: `rows` [m/s or rad/s] and `optimality` [-], worked out again from the program.
        fighting: where it is infeasible, a smallest set of rows that cannot hold together.
        program: what was solved.
    """

    rover: Rover
    outcome: Outcome
    velocity: Array
    slack: Mapping[str, float]
    aims: Mapping[str, Aim]
    residuals: Mapping[str, float]
    fighting: tuple[Side, ...] = ()
    program: Program | None = field(default=None, repr=False)

    @property
    def solved(self) -> bool:
        """Whether there are rates."""
        return self.outcome is Outcome.SOLVED

    @cached_property
    def rates(self) -> Mapping[str, float]:
        """Rate of every joint [rad/s or m/s]."""
        column = self.rover.column
        return {name: float(self.velocity[column[name]]) for name in self.rover.joints}

    @cached_property
    def missed(self) -> Mapping[str, float]:
        """By task, the length of what it is missed by [m/s; angles in rad/s]."""
        return {
            name: float(np.linalg.norm(aim.matrix @ self.velocity - aim.target))
            for name, aim in self.aims.items()
        }

    @property
    def reason(self) -> str:
        """In words, empty where it is solved."""
        if self.solved:
            return ""
        if self.outcome is Outcome.INFEASIBLE:
            return f"these cannot hold together: {told(self.fighting)}"
        return f"the solver did not reach its precision (rows missed by {self.residuals['rows']:.2g})"
