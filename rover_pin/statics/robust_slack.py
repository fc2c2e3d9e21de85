"""The forces in equilibrium that are furthest from what friction forbids."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from rover_pin.numerics import Array
from rover_pin.statics.cone_program import ConeProgram
from rover_pin.statics.force_space import ForceSpace
from rover_pin.statics.least_friction import SQUEEZE


@dataclass(frozen=True)
class Slack:
    """The largest slack.

    Attributes:
        outcome: `found`; `infeasible`: no forces of any size are in equilibrium; `failed`: no proof.
        value: units of the weight, as is all else.
        forces: (3k + o,) in the force space's coordinates.
        braced: whether only the bound on normal forces limits it.
    """

    outcome: Literal["found", "infeasible", "failed"]
    value: float
    forces: Array
    braced: bool


def robust_slack(space: ForceSpace, friction: Array) -> Slack:
    """Largest s with |tangential_i| <= friction_i (normal_i - s) at every contact, in equilibrium.

    Args:
        space: the forces in equilibrium, units of the weight.
        friction: (k,) coefficient at each contact.

    Cost: one program, 0.35 ms with six wheels.
    """
    k, d = space.contacts, space.basis.shape[1]
    nothing = np.full(space.particular.size, np.nan)
    if not space.consistent or k == 0:
        return Slack("infeasible", -np.inf, nothing, braced=False)
    cones = np.zeros((k, 3, d + 1))
    cones[:, :, :d] = space.basis[: 3 * k].reshape(k, 3, d)
    cones[:, 0, d] = -1.0
    cones[:, 0] *= friction[:, None]
    offset = space.particular[: 3 * k].reshape(k, 3).copy()
    offset[:, 0] *= friction
    pushes = space.basis[3 * k :]
    sums = space.basis[space.normals()].sum(axis=0)
    total = float(space.particular[space.normals()].sum())
    answer = ConeProgram(
        cost=np.append(np.zeros(d), -1.0),
        at_least=np.hstack([np.vstack([pushes, -sums / SQUEEZE]), np.zeros((len(pushes) + 1, 1))]),
        base=np.append(space.particular[3 * k :], 1.0 - total / SQUEEZE),
        cones=cones,
        offset=offset,
    ).solve()
    if answer.outcome != "solved":
        return Slack("infeasible" if answer.outcome == "infeasible" else "failed", -np.inf, nothing, False)
    forces = space.particular + space.basis @ answer.x[:d]
    braced = bool(forces[space.normals()].sum() >= SQUEEZE * (1.0 - 1e-3))
    return Slack("found", float(answer.x[d]), forces, braced)
