"""A rover whose front axle hangs in a four-bar of random shape, and the words that close it.

Link frames are turned and shifted at random along their hinges, hinges lean at random from the x axis, and
the frames that close the loop lie where they may: on the last hinge's line for a ball, anywhere for a weld.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pinocchio as pin
from scipy.spatial.transform import Rotation

WHEELS = ("bl", "br", "fl", "fr")
TOUCHING = "wheels:\n" + "".join(
    f"  - {{name: {w}, frame: wheel_{w}, radius: 0.15, width: 0.1, tread: 0.03, friction: 0.8}}\n"
    for w in WHEELS
)
"""The sidecar's wheels; they turn about their drives' axes."""


@dataclass
class Closed:
    """A URDF and the poses its loop needs.

    Attributes:
        kind: `3d` (ball) or `6d` (weld).
        urdf: its text.
        places: link -> pose (4, 4) in the world there.
        close: pose of the closing frames in the world where the loop is closed.
        ends: the links that close.
    """

    kind: str
    urdf: str
    places: dict[str, np.ndarray]
    close: np.ndarray
    ends: tuple[str, str]

    @property
    def gepetto(self) -> str:
        """As example-parallel-robots says it."""
        drives = ", ".join(f"'drive_{w}'" for w in WHEELS)
        return f"closed_loop: [['loop_A', 'loop_B']]\ntype: ['{self.kind}']\nname_mot: [{drives}]\n"

    def ours(self, ends=("loop_A", "loop_B")) -> str:
        """As a rover.yaml says it."""
        drives = ", ".join(f"drive_{w}" for w in WHEELS)
        kind = {"3d": "ball", "6d": "weld"}[self.kind]
        return f"loops: [{{name: front, frames: [{', '.join(ends)}], type: {kind}}}]\nactuated: [{drives}]\n"

    @property
    def placed(self) -> tuple[str, str]:
        """The closing frames as places on the links they are fixed to."""
        said = []
        for link in self.ends:
            local = np.linalg.inv(self.places[link]) @ self.close
            said.append(f"{{link: {link}, xyz: {local[:3, 3].tolist()}, rpy: {_rpy(local).tolist()}}}")
        return said[0], said[1]


def closed_rover(seed: int, kind: str, open_: float = 0.0) -> Closed:
    """Of random shape, the same for a seed; at zero the loop is open by that turn of the crank [rad]."""
    rng = np.random.default_rng(seed)
    hinge = np.array([1.0, *rng.uniform(-0.15, 0.15, 2)])
    hinge /= np.linalg.norm(hinge)
    across = np.eye(3) - np.outer(hinge, hinge)  # the four-bar's pins lie in a plane across its hinges
    front = np.array([0.5, 0.0, 0.0])
    pins = {
        "A": front + across @ [0.0, 0.18 + rng.uniform(-0.04, 0.04), 0.1],
        "B": front + across @ [0.0, -0.18 + rng.uniform(-0.04, 0.04), 0.1],
        "C": front + across @ [0.0, 0.22 + rng.uniform(-0.04, 0.04), -0.1 + rng.uniform(-0.03, 0.03)],
        "D": front + across @ [0.0, -0.22 + rng.uniform(-0.04, 0.04), -0.1 + rng.uniform(-0.03, 0.03)],
    }
    made = Closed(kind, "", {"base": np.eye(4)}, np.eye(4), ("coupler", "rocker"))
    parts = [_link("base", made.places["base"], 30.0, np.array([0.05, 0.02, 0.1]) + rng.normal(0, 0.02, 3))]

    def hang(joint: str, parent: str, child: str, at, axis, kilos: float, com, sort="revolute") -> None:
        pose = _pose(_turned(rng), at + (rng.uniform(-0.03, 0.03) * axis if sort == "revolute" else 0.0))
        made.places[child] = pose
        local = pose[:3, :3].T @ axis
        origin = np.linalg.inv(made.places[parent]) @ pose
        if joint == "crank_pin":
            origin = origin @ _pose(Rotation.from_rotvec(open_ * local).as_matrix(), np.zeros(3))
        parts.append(_joint(joint, parent, child, origin, sort, local))
        parts.append(_link(child, pose, kilos, com))

    middle = {name: 0.5 * (pins[name[0]] + pins[name[1]]) for name in ("AC", "BD", "CD")}
    hang("crank_pin", "base", "crank", pins["A"], hinge, 1.0, middle["AC"])
    hang("rocker_pin", "base", "rocker", pins["B"], hinge, 1.2, middle["BD"])
    hang("coupler_pin", "crank", "coupler", pins["C"], hinge, 4.0, middle["CD"])
    made.close = _pose(_turned(rng), pins["D"] + rng.uniform(-0.1, 0.1) * hinge)
    if kind == "6d":
        hang("tip_pin", "coupler", "tip", pins["D"], hinge, 0.1, pins["D"])
        made.ends = ("tip", "rocker")
        made.close = _pose(_turned(rng), pins["D"] + rng.uniform(-0.2, 0.2, 3))
    for name, parent, x, y in (
        ("bl", "base", -0.5, 0.4),
        ("br", "base", -0.5, -0.4),
        ("fl", "coupler", 0.5, 0.45),
        ("fr", "coupler", 0.5, -0.45),
    ):
        place, about = np.array([x, y, -0.15]), np.array([0.0, 1.0, 0.0])
        hang(f"drive_{name}", parent, f"wheel_{name}", place, about, 2.0, place, "continuous")
    for frame, link in zip(("loop_A", "loop_B"), made.ends, strict=True):
        origin = np.linalg.inv(made.places[link]) @ made.close
        parts.append(f'<link name="{frame}"/>' + _joint(f"at_{frame}", link, frame, origin, "fixed"))
    made.urdf = f'<robot name="closed">{"".join(parts)}</robot>'
    return made


def gepettos_residual(path: Path, stance, kind: str) -> tuple[float, float]:
    """How far a stance is from the loop and equilibrium that example-parallel-robots' loader builds.

    A `RigidConstraintModel` in LOCAL between the placements of the two frames on a free-flyer model of the
    URDF; wheels braked, every contact force against gravity, the loop's multipliers by least squares.

    Returns:
        the frames' distance (and angle, 6d), and the unbalanced force over the weight.
    """
    model = pin.buildModelFromUrdf(str(path), pin.JointModelFreeFlyer())
    data, q = model.createData(), pin.neutral(model)
    roll, pitch, yaw = stance.rpy
    q[:3], q[3:7] = stance.position, Rotation.from_euler("ZYX", [yaw, pitch, roll]).as_quat()
    for joint, value in stance.joints.items():
        here = model.joints[model.getJointId(joint)]
        q[here.idx_q : here.idx_q + here.nq] = [value] if here.nq == 1 else [np.cos(value), np.sin(value)]
    frames = [model.frames[model.getFrameId(name)] for name in ("loop_A", "loop_B")]
    contact = pin.ContactType.CONTACT_3D if kind == "3d" else pin.ContactType.CONTACT_6D
    (first, second) = ((f.parentJoint, f.placement) for f in frames)
    closing = pin.RigidConstraintModel(contact, model, *first, *second, pin.ReferenceFrame.LOCAL)
    pin.computeJointJacobians(model, data, q)
    pin.updateFramePlacements(model, data)
    apart = data.oMi[first[0]].act(first[1]).actInv(data.oMi[second[0]].act(second[1]))
    open_ = np.abs(apart.translation).max() if kind == "3d" else np.abs(pin.log6(apart).vector).max()
    closed = closing.createData()
    closing.calc(model, data, closed)
    rows = pin.getConstraintJacobian(model, data, closing, closed)
    load = pin.computeGeneralizedGravity(model, data, q) * stance.gravity / 9.81
    for c in stance.contacts:
        joint = model.getJointId(f"drive_{c.wheel}")
        jacobian = pin.getJointJacobian(model, data, joint, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED)
        lift = jacobian[:3] - pin.skew(c.point - data.oMi[joint].translation) @ jacobian[3:]
        load = load - c.load * lift[2]
    braked = [model.joints[model.getJointId(f"drive_{w}")].idx_v for w in WHEELS]
    kept = np.setdiff1d(np.arange(model.nv), braked)
    multipliers = np.linalg.lstsq(rows[:, kept].T, load[kept], rcond=None)[0]
    left = load[kept] - rows[:, kept].T @ multipliers
    return float(open_), float(np.abs(left).max() / stance.weight)


def _turned(rng) -> np.ndarray:
    return Rotation.random(random_state=rng).as_matrix()


def _pose(rotation, at) -> np.ndarray:
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = rotation, at
    return pose


def _rpy(pose) -> np.ndarray:
    return Rotation.from_matrix(pose[:3, :3]).as_euler("xyz")


def _origin(pose) -> str:
    xyz, rpy = (" ".join(map(repr, map(float, v))) for v in (pose[:3, 3], _rpy(pose)))
    return f'<origin xyz="{xyz}" rpy="{rpy}"/>'


def _link(name: str, pose, kilos: float, com) -> str:
    local = np.eye(4)
    local[:3, 3] = pose[:3, :3].T @ (np.asarray(com) - pose[:3, 3])
    inertia = '<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/>'
    return f'<link name="{name}"><inertial>{_origin(local)}<mass value="{kilos}"/>{inertia}</inertial></link>'


def _joint(name: str, parent: str, child: str, origin, sort: str, axis=None) -> str:
    said = "" if axis is None else f'<axis xyz="{" ".join(repr(float(v)) for v in axis)}"/>'
    limit = '<limit lower="-0.6" upper="0.6" effort="10" velocity="1"/>' if sort == "revolute" else ""
    return (
        f'<joint name="{name}" type="{sort}">{_origin(origin)}<parent link="{parent}"/>'
        f'<child link="{child}"/>{said}{limit}</joint>'
    )
