"""Contact forces with friction: what `distribute` answers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

import numpy as np

from rover_pin.numerics import Array, frozen
from rover_pin.statics.force_space import BALANCE_TOLERANCE, unbalanced
from rover_pin.statics.friction_problem import FrictionProblem

NO_FORCE = 1e-7
"""Share of the weight below which a contact carries nothing, and a cone is not left."""


class ForceStatus(str, Enum):
    """How a rule ended; only `feasible` forces hold the rover with the friction given."""

    FEASIBLE = "feasible"
    INFEASIBLE = "infeasible"
    NO_CONVERGENCE = "no_convergence"

    def __str__(self) -> str:
        """The word used in tables and files."""
        return self.value


@dataclass(frozen=True)
class Forces:
    """One set of contact forces of a stance.

    Where a rule has no answer, the forces are NaN. Where it has one that friction cannot hold
    (`vertical` and `ratio` do not look at friction; `least_friction` may need more than there is), the
    forces are given and the status is `infeasible`.

    Attributes:
        rule: vertical, ratio, least_friction or least_torque.
        status: whether friction holds them.
        reason: one clause for people; empty where feasible.
        contacts: (k) names, a wheel's further contacts `name#2`.
        force: (k, 3) N, world: the ground's force on the rover.
        normal: (k,) N, along the contact's normal.
        rolling: (k,) N, along the wheel's rolling direction.
        lateral: (k,) N, along normal x rolling.
        ratio: (k,) [-] |tangential| / normal; 0 where a contact carries nothing.
        loads: per wheel, N against gravity.
        tractions: per wheel, N along its rolling direction.
        torques: per wheel, N m about its axle: what a motor or brake gives, positive where it drives on.
        friction: [-] the largest ratio, what friction these forces ask for.
        given: (k,) [-] the friction there is.
        k: [-] the ratio of rolling to normal force where the rule has one, else None.
        residual: [-] largest unbalanced share of the weight, recomputed from the equilibrium's rows.
    """

    rule: str
    status: ForceStatus
    reason: str
    contacts: tuple[str, ...]
    force: Array
    normal: Array
    rolling: Array
    lateral: Array
    ratio: Array
    loads: Mapping[str, float]
    tractions: Mapping[str, float]
    torques: Mapping[str, float]
    friction: float
    given: Array
    k: float | None
    residual: float

    @property
    def feasible(self) -> bool:
        """Whether these forces hold the rover within the friction given."""
        return self.status is ForceStatus.FEASIBLE


def forces_of(problem: FrictionProblem, rule: str, local: Array, *, k: float | None = None) -> Forces:
    """Judge forces given in contact frames.

    Args:
        problem: contacts, friction, equilibrium.
        rule: its name.
        local: (k, 3) N: normal, rolling, lateral.
        k: the traction ratio, if the rule has one.
    """
    world = np.einsum("ka,kaw->kw", local, problem.frames)
    tangential = np.hypot(local[:, 1], local[:, 2])
    least = NO_FORCE * problem.weight
    carries = np.maximum(np.abs(local[:, 0]), tangential) > least
    with np.errstate(divide="ignore"):
        quotient = np.divide(
            tangential, local[:, 0], out=np.full(len(local), np.inf), where=local[:, 0] > 0.0
        )
    ratio = np.where(carries, quotient, 0.0)
    residual = unbalanced(problem.rows, world, problem.weight)
    reason = _complaint(problem, local, tangential, ratio, residual)
    return _forces(
        problem,
        rule,
        local,
        world,
        ratio,
        reason,
        k,
        residual,
        ForceStatus.INFEASIBLE if reason else ForceStatus.FEASIBLE,
    )


def no_forces(problem: FrictionProblem, rule: str, status: ForceStatus, reason: str) -> Forces:
    """The answer of a rule that has none."""
    nothing = np.full((len(problem.contacts), 3), np.nan)
    return _forces(problem, rule, nothing, nothing, nothing[:, 0], reason, None, float("nan"), status)


def _complaint(
    problem: FrictionProblem, local: Array, tangential: Array, ratio: Array, residual: float
) -> str:
    """Why forces do not hold the rover; empty where they do."""
    least = NO_FORCE * problem.weight
    if residual > BALANCE_TOLERANCE:
        return f"the forces leave {residual:.2g} of the weight unbalanced"
    pulls = int(np.argmin(local[:, 0])) if len(local) else 0
    if len(local) and local[pulls, 0] < -least:
        return f"the ground would have to pull at {problem.names[pulls]} ({-local[pulls, 0]:.4g} N)"
    for name, free, force in zip(problem.names, problem.free, local, strict=True):
        if free and abs(force[1]) > least:
            return f"{name} turns freely and would have to carry a rolling force of {force[1]:.4g} N"
    over = tangential - problem.friction * local[:, 0]
    if len(local) and over.max() > least:
        worst = int(np.argmax(np.where(over > least, ratio - problem.friction, -np.inf)))
        asked, there = ratio[worst], problem.friction[worst]
        return f"{problem.names[worst]} asks for friction {asked:.4g} where there is {there:.4g}"
    return ""


def _forces(
    problem: FrictionProblem,
    rule: str,
    local: Array,
    world: Array,
    ratio: Array,
    reason: str,
    k: float | None,
    residual: float,
    status: ForceStatus,
) -> Forces:
    loads: dict[str, float] = {}
    tractions: dict[str, float] = {}
    torques: dict[str, float] = {}
    for contact, force, along in zip(problem.contacts, world, local[:, 1], strict=True):
        traction = float(along) if contact.rolling.any() else 0.0
        loads[contact.wheel] = loads.get(contact.wheel, 0.0) + float(force[2])
        tractions[contact.wheel] = tractions.get(contact.wheel, 0.0) + traction
        torques[contact.wheel] = torques.get(contact.wheel, 0.0) + contact.radius * traction
    return Forces(
        rule=rule,
        status=status,
        reason=reason,
        contacts=problem.names,
        force=frozen(world),
        normal=frozen(local[:, 0]),
        rolling=frozen(local[:, 1]),
        lateral=frozen(local[:, 2]),
        ratio=frozen(ratio),
        loads=loads,
        tractions=tractions,
        torques=torques,
        friction=float(np.max(ratio, initial=0.0)),
        given=problem.friction,
        k=k,
        residual=residual,
    )
