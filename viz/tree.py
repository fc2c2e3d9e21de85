"""The rover's joints as nodes of a scene: a fixed placement each, and a child that turns or slides.

A page then needs no kinematics: it sets the base and the joints, and the scene composes the rest.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from rover_pin.numerics import Array, frozen

ROOT = "rover"


@dataclass(frozen=True)
class JointNode:
    """One joint of the model.

    Attributes:
        joint: Pinocchio's id; 1 is the base.
        name: the joint's name.
        path: path of the moving node in the scene.
        fixed: path of its fixed placement; the base has none and says "".
        placement: (4, 4) of the joint in its parent joint's frame.
        axis: (3,) unit, in the joint's frame; zero for the base.
        slides: whether it slides along the axis instead of turning about it.
        mass: kg of the body that the joint carries.
        lever: (3,) m; that body's centre of mass in the joint's frame.
    """

    joint: int
    name: str
    path: str
    fixed: str
    placement: Array
    axis: Array
    slides: bool
    mass: float
    lever: Array


def joint_nodes(model: Any) -> tuple[JointNode, ...]:
    """One node a joint of a Pinocchio model whose joint 1 is the base and whose others move one way each."""
    import pinocchio as pin

    data = model.createData()
    pin.forwardKinematics(model, data, pin.neutral(model), np.zeros(model.nv))
    nodes: list[JointNode] = []
    paths = {1: ROOT}
    for joint in range(1, model.njoints):
        name = str(model.names[joint])
        fixed, axis, slides = "", np.zeros(3), False
        if joint > 1:
            word = name.replace("/", "_")
            fixed = f"{paths[model.parents[joint]]}/{word}.fixed"
            paths[joint] = f"{fixed}/{word}"
            subspace = np.asarray(data.joints[joint].S, dtype=np.float64).ravel()
            slides = bool(np.linalg.norm(subspace[:3]) > 0.5)
            axis = subspace[:3] if slides else subspace[3:]
        inertia = model.inertias[joint]
        nodes.append(
            JointNode(
                joint=joint,
                name=name,
                path=paths[joint],
                fixed=fixed,
                placement=frozen(model.jointPlacements[joint].homogeneous),
                axis=frozen(axis),
                slides=slides,
                mass=float(inertia.mass),
                lever=frozen(inertia.lever),
            )
        )
    return tuple(nodes)


def turn(node: JointNode, value: float) -> Array:
    """(4, 4) of the moving node in its fixed placement, for a joint at `value` (rad or m)."""
    matrix = np.eye(4)
    if node.slides:
        matrix[:3, 3] = value * node.axis
        return matrix
    x, y, z = node.axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    matrix[:3, :3] += np.sin(value) * cross + (1 - np.cos(value)) * cross @ cross  # Rodrigues
    return matrix


def base_matrix(model: Any, position: Array, rpy: Array) -> Array:
    """(4, 4) of the base node: the model's own turn of the root, then R = Rz(yaw) Ry(pitch) Rx(roll)."""
    roll, pitch, yaw = (float(angle) for angle in rpy)
    cr, sr, cp, sp, cy, sy = (f(a) for a in (roll, pitch, yaw) for f in (np.cos, np.sin))
    matrix = np.eye(4)
    matrix[:3, :3] = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
    matrix[:3, 3] = position
    return np.asarray(model.jointPlacements[1].homogeneous @ matrix, dtype=np.float64)
