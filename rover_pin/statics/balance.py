"""The rows of equilibrium with friction: which generalised forces must vanish, and what can act on them."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pinocchio as pin

from rover_pin.errors import InputError
from rover_pin.mechanism import Kinematics, reduce_coordinates
from rover_pin.numerics import Array, frozen
from rover_pin.statics.held import held_joints
from rover_pin.statics.loads import STOPPED
from rover_pin.statics.problem import STANDARD

if TYPE_CHECKING:
    from rover_pin.statics.stance import Stance


@dataclass(frozen=True)
class Balance:
    """contact @ f + internal @ multipliers = gravity, with f the contacts' forces in world axes.

    Passive joints add rows to the six of the base: S_p (g - sum J_i' f_i - J_c' lambda) = 0. The rows of the
    base alone are optimistic.

    Attributes:
        rows: (m,) names: the base's coordinates, then free joints (couplings folded in).
        gravity: (m,) gravity minus springs [N or N m].
        contact: (m, 3 k) of forces at the stance's contacts, x y z of each in turn [-, m].
        internal: (m, j) of loops, stops on which a joint stands, taut tracks.
        internal_names: (j,).
        internal_lower: (j,) least multiplier: 0 for one-sided ones, else -inf.
        lean: (m, 2) what gravity gains per metre by which the base's mass moves along x and y, the weight
            as it is [N or N m, per m].
        torque: (m, t) of the motors of the joints asked for.
    """

    rows: tuple[str, ...]
    gravity: Array
    contact: Array
    internal: Array
    internal_names: tuple[str, ...]
    internal_lower: Array
    lean: Array
    torque: Array


BASE_JOINT = 1
"""Pinocchio's id of the joint of the root link."""


def balance(stance: Stance, motors: Collection[str] = ()) -> Balance:
    """The rows of the base and of every joint that is neither driven, locked, nor a braked wheel's.

    Args:
        stance: a settled stance.
        motors: driven joints that have rows too, each with its motor's torque (in this order) to balance it
            and nothing else: a limit it happens to stand on carries nothing.

    Raises:
        InputError: the stance is not settled.
    """
    if not stance.settled:
        raise InputError(
            "there is no equilibrium to write",
            element="stance",
            value=str(stance.status),
            cure="settle it first",
        )
    rover = stance.rover
    q = np.array(stance.configuration)
    at = Kinematics(rover.model, rover.model.createData(), q)
    held = {
        rover.column[joint]: float(q[rover.column[joint]])
        for joint in held_joints(rover, stance.locked)
        if joint not in motors
    }
    names = dict(enumerate(rover.dof_names))
    reduction = reduce_coordinates(rover.model.nv, rover.couplings, held, names, tolerance=1e-6)
    basis = reduction.basis
    load = pin.computeGeneralizedGravity(rover.model, at.data, q) * (stance.gravity / STANDARD)
    at = Kinematics(rover.model, at.data, q)
    for spring in rover.springs:
        load = load - spring.force(at)
    blocks = [basis.T @ at.point_jacobian(c.joint, c.point).T for c in stance.contacts]
    internal: list[tuple[str, Array, float]] = []
    for loop in rover.loops:
        rows = loop.jacobian(at) @ basis
        internal += [(f"{loop.name}[{i}]", row, -np.inf) for i, row in enumerate(rows)]
    for joint in rover.joints:
        column = rover.column[joint]
        for sign, limit in ((1.0, rover.lower[column]), (-1.0, rover.upper[column])):
            if joint not in motors and np.any(basis[column]) and abs(q[column] - limit) <= STOPPED:
                internal.append((joint, sign * basis[column], 0.0))
    for element in rover.one_sided:
        if element.slack(at) <= STOPPED:
            internal.append((element.name, element.slack_gradient(at) @ basis, 0.0))
    size = basis.shape[1]
    turning = at.joint_jacobian(BASE_JOINT)[3:] @ basis
    return Balance(
        tuple(rover.dof_names[column] for column in reduction.columns),
        frozen(basis.T @ load),
        frozen(np.hstack(blocks) if blocks else np.zeros((size, 0))),
        frozen(np.column_stack([row for _, row, _ in internal]) if internal else np.zeros((size, 0))),
        tuple(name for name, _, _ in internal),
        frozen([lower for _, _, lower in internal]),
        frozen(stance.weight * np.column_stack([-turning[1], turning[0]])),
        frozen(basis[[rover.column[joint] for joint in motors]].T.reshape(size, len(motors))),
    )
