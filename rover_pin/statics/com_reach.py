"""How far along a direction the centre of mass may lie: equilibrium with the base's mass moved sideways."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, Protocol, cast

import numpy as np
from numpy.typing import NDArray

from rover_pin.numerics import Array
from rover_pin.statics.cone_program import ConeProgram
from rover_pin.statics.force_space import BALANCE_TOLERANCE, in_contact_frames, may_carry, solutions
from rover_pin.statics.friction_problem import FrictionProblem, Rows
from rover_pin.statics.least_friction import SQUEEZE

CLOSE = 1e-5
"""Share of the weight (of a motor's effort) that counts as nothing when a limit is named."""


class MovableRows(Rows, Protocol):
    """Equilibrium whose weight may move sideways, and with motors' torques."""

    @property
    def lean(self) -> Array:
        """(m, 2) what gravity gains per metre that the mass moves along x and y [N or N m, per m]."""

    @property
    def torque(self) -> Array:
        """(m, t) columns of the motors' torques."""


@dataclass(frozen=True)
class Motors:
    """Motors with a limit: those of joints that have rows of their own, then those of braked wheels.

    Attributes:
        joints: (t) names, in the order of the rows' torque columns.
        effort: (t,) N m or N.
        drives: (w) names of driven wheels' joints.
        levers: (w, k) m of each contact's rolling force about its wheel's axis.
        drive_effort: (w,) N m.
    """

    joints: Sequence[str]
    effort: Array
    drives: Sequence[str]
    levers: Array
    drive_effort: Array


NONE = Motors((), np.zeros(0), (), np.zeros((0, 0)), np.zeros(0))
"""No motor has a limit."""


@dataclass(frozen=True)
class Reached:
    """The furthest place along a direction.

    Attributes:
        outcome: `solved`; `infeasible`: nowhere is there equilibrium; `unbounded`; `failed`: no proof.
        value: m, from the centre of mass as it is, along the direction.
        place: (2,) m, from the centre of mass as it is.
        forces: what attains it, in the program's own coordinates; `ComReach.limits` reads them.
    """

    outcome: Literal["solved", "infeasible", "unbounded", "failed"]
    value: float
    place: Array
    forces: Array


class ComReach:
    """The furthest places of the centre of mass that equilibrium allows, one cone program a direction.

    The mass of the root link is thought to be moved in the horizontal plane, weight and posture as they are:
    the rows of passive joints below it do not change, those of the base gain `lean`. Friction is the exact
    cone. Normal forces may add up to `SQUEEZE` weights: bracing without bound is not counted.

    Args:
        problem: contacts, friction, and equilibrium with `lean` and `torque`.
        motors: limits to keep.

    Cost: 0.35 ms a direction with six wheels.
    """

    def __init__(self, problem: FrictionProblem, motors: Motors = NONE) -> None:
        k, weight = len(problem.contacts), problem.weight
        rows = cast(MovableRows, problem.rows)
        self._problem, self._motors = problem, motors
        self.unit = _size(np.array([c.point for c in problem.contacts]))
        """m, what lengths are divided by."""
        one_sided = np.isfinite(rows.internal_lower)
        scaled = rows.torque * self.unit
        pushes = rows.internal[:, one_sided]
        size = np.linalg.norm(pushes, axis=0)
        particular, basis, self.unbalanced = solutions(
            np.hstack(
                [
                    in_contact_frames(rows.contact, problem.frames),
                    pushes / np.where(size > 0.0, size, 1.0),
                    scaled,
                    -rows.lean * (self.unit / weight),
                ]
            ),
            _unit(rows.internal[:, ~one_sided]),
            rows.gravity / weight,
            np.r_[may_carry(problem.free), np.ones(pushes.shape[1] + scaled.shape[1] + 2, dtype=bool)],
        )
        if not basis.shape[1]:  # one solution at most; a solver wants something to choose
            basis = np.zeros((len(particular), 1))
        self._particular, self._basis = particular, basis
        self._forces, self._move = slice(0, 3 * k), slice(len(particular) - 2, len(particular))
        self._torques = slice(len(particular) - 2 - scaled.shape[1], len(particular) - 2)
        self._program = self._set_up(slice(3 * k, self._torques.start))

    def _set_up(self, pushes: slice) -> ConeProgram:
        k, d = len(self._problem.contacts), self._basis.shape[1]
        cones = self._basis[self._forces].reshape(k, 3, d).copy()
        offset = self._particular[self._forces].reshape(k, 3).copy()
        cones[:, 0] *= self._problem.friction[:, None]
        offset[:, 0] *= self._problem.friction
        normals = slice(0, 3 * k, 3)
        turn, turned = self._turns()
        limit = self._efforts()
        limited = limit < SQUEEZE * SQUEEZE  # a larger one says nothing about forces of SQUEEZE weights
        turn, turned, limit = turn[limited], turned[limited], limit[limited]
        return ConeProgram(
            cost=np.zeros(d),
            at_least=np.vstack(
                [self._basis[pushes], -self._basis[normals].sum(axis=0)[None, :] / SQUEEZE, turn, -turn]
            ),
            base=np.concatenate(
                [
                    self._particular[pushes],
                    [1.0 - self._particular[normals].sum() / SQUEEZE],
                    limit + turned,
                    limit - turned,
                ]
            ),
            cones=cones,
            offset=offset,
        )

    def _turns(self) -> tuple[Array, Array]:
        """Rows (t + w, d) and offsets of all limited torques over weight and unit."""
        k = len(self._problem.contacts)
        levers = self._motors.levers.reshape(-1, k) / self.unit
        rolling = slice(1, 3 * k, 3)
        return (
            np.vstack([self._basis[self._torques], levers @ self._basis[rolling]]),
            np.concatenate([self._particular[self._torques], levers @ self._particular[rolling]]),
        )

    def _efforts(self) -> Array:
        """(t + w,) limits over weight and unit."""
        efforts = np.concatenate([self._motors.effort, self._motors.drive_effort])
        scaled: Array = efforts / (self._problem.weight * self.unit)
        return scaled

    def toward(self, direction: Array) -> Reached:
        """The furthest place along a horizontal unit vector, (2,).

        Raises:
            SolverError: data that are not finite.
        """
        nowhere = np.full(2, np.nan)
        if self.unbalanced > BALANCE_TOLERANCE:
            return Reached("infeasible", np.nan, nowhere, nowhere)
        self._program.set_cost(-(direction @ self._basis[self._move]))
        answer = self._program.solve()
        if answer.outcome != "solved":
            return Reached(answer.outcome, np.nan, nowhere, nowhere)
        found = self._particular + self._basis @ answer.x
        place = found[self._move] * self.unit
        return Reached("solved", float(direction @ place), place, answer.x)

    def limits(self, reached: Reached) -> list[str]:
        """What forbids going on, a clause each: contacts that carry nothing or slip, motors."""
        x = reached.forces
        found = self._particular + self._basis @ x
        local = found[self._forces].reshape(-1, 3)
        normal, tangential = local[:, 0], np.hypot(local[:, 1], local[:, 2])
        idle = normal <= CLOSE
        slips = ~idle & (tangential >= self._problem.friction * normal - CLOSE)
        turn, turned = self._turns()
        spent = np.abs(turn @ x + turned) >= self._efforts() * (1.0 - CLOSE)
        names = self._problem.names
        said = [
            _clause(names, idle, "carries nothing", "carry nothing"),
            _clause(names, slips, "slips", "slip"),
            _clause(
                (*self._motors.joints, *self._motors.drives), spent, "gives all it can", "give all they can"
            ),
        ]
        if normal.sum() >= SQUEEZE * (1.0 - 1e-3):
            said.append(f"contacts brace with {SQUEEZE:g} weights")
        return [clause for clause in said if clause]


def _clause(names: Sequence[str], which: NDArray[np.bool_], one: str, several: str) -> str:
    chosen = [name for name, is_one in zip(names, which, strict=True) if is_one]
    return f"{', '.join(chosen)} {one if len(chosen) == 1 else several}" if chosen else ""


def _unit(matrix: Array) -> Array:
    length = np.linalg.norm(matrix, axis=0)
    scaled: Array = matrix / np.where(length > 0.0, length, 1.0)
    return scaled


def _size(points: Array) -> float:
    """Half the largest extent of the contacts, m; 1 where they are one place."""
    return 0.5 * float(np.max(np.ptp(points, axis=0), initial=0.0)) or 1.0
