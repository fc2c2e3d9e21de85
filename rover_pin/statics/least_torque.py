"""The forces within friction whose largest wheel torque is least."""

from __future__ import annotations

from typing import Literal

import numpy as np

from rover_pin.numerics import Array
from rover_pin.statics.cone_program import ConeProgram
from rover_pin.statics.force_space import ForceSpace


def least_torque(
    space: ForceSpace, friction: Array, levers: Array
) -> tuple[Literal["found", "infeasible", "failed"], float, Array]:
    """Minimise the largest |torque| over wheels, friction cones exact (Noble and Issac 2019).

    Args:
        space: the forces in equilibrium, units of the weight.
        friction: (k,) coefficient at each contact.
        levers: (w, k) m; row per driven wheel: the lever of each contact's rolling force about its axis.

    Returns:
        how it ended; the least largest torque over the weight [m]; forces (3k + o,) in units of the weight.

    Cost: one program, 0.3 ms with six wheels.
    """
    k = space.contacts
    nothing = np.full(space.particular.size, np.nan)
    if not space.consistent or k == 0:
        return "infeasible", np.inf, nothing
    longest = float(np.max(np.abs(levers), initial=0.0)) or 1.0
    d = space.basis.shape[1]
    rolling = np.zeros((len(levers), space.particular.size))
    rolling[:, 1 : 3 * k : 3] = levers / longest
    turn, turned = rolling @ space.basis, rolling @ space.particular
    bound = np.ones((len(levers), 1))
    pushing = space.pushing()
    floor = np.append(np.zeros(d), 1.0)
    cones, offset = friction_cones(space, friction)
    program = ConeProgram(
        cost=floor,
        at_least=np.vstack(
            [
                np.hstack([turn, bound]),
                np.hstack([-turn, bound]),
                floor,
                np.hstack([space.basis[pushing], np.zeros((len(pushing), 1))]),
            ]
        ),
        base=np.concatenate([turned, -turned, [0.0], space.particular[pushing]]),
        cones=np.concatenate([cones, np.zeros((k, 3, 1))], axis=2),
        offset=offset,
    )
    answer = program.solve()
    if answer.outcome != "solved":
        return ("infeasible" if answer.outcome == "infeasible" else "failed"), np.inf, nothing
    forces = space.particular + space.basis @ answer.x[:-1]
    return "found", float(np.max(np.abs(rolling @ forces), initial=0.0)) * longest, forces


def friction_cones(space: ForceSpace, friction: Array) -> tuple[Array, Array]:
    """Rows (k, 3, d) and offsets (k, 3) of |tangential| <= friction normal, in the basis of the space."""
    k = space.contacts
    cones = space.basis[: 3 * k].reshape(k, 3, -1).copy()
    offset = space.particular[: 3 * k].reshape(k, 3).copy()
    cones[:, 0] *= friction[:, None]
    offset[:, 0] *= friction
    return cones, offset
