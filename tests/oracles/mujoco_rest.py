"""The same robot dropped in MuJoCo and left to come to rest.

The MJCF is written here from the URDF text and the sidecar (`tree_walk`): driven joints and wheels are
welded, passive joints are free, couplings are joint equalities, ball loops connect sites, joint springs stay.
A wheel is the convex hull of the circle swept by a ball, as a mesh: against ground from outside that is the
same shape. The ground is a height field, sampled from the same surface.

Friction is 0.5: a braked bogie whose pivot is as high as half its length stands on one wheel alone where
friction is 1, its other wheel in the air, held by the others. That is a jam, not the stance whose contact
forces are vertical.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import dataclass

import mujoco
import numpy as np
from tree_walk import Machine

SAMPLE = 0.01
AROUND = 64
ACROSS = 9
REST = 1e-4
WHEEL = {
    "type": "mesh", "contype": "1", "conaffinity": "0", "priority": "1", "condim": "3",
    "friction": "0.5 0 0", "solref": "0.005 1",
}  # fmt: skip
STIFF = {"solref": "0.004 1", "solimp": "0.9999 0.9999 0.001 0.5 2"}


@dataclass
class AtRest:
    """Base pose, largest speed of any coordinate [m/s or rad/s], and whether it is below `REST`."""

    position: np.ndarray
    rotation: np.ndarray
    speed: float

    @property
    def resting(self) -> bool:
        return self.speed < REST

    @property
    def yaw(self) -> float:
        return float(np.arctan2(self.rotation[1, 0], self.rotation[0, 0]))


def come_to_rest(machine: Machine, urdf, terrain, place, fixed=None, span=3.0, seconds=6.0) -> AtRest:
    """Drop the level robot and wait.

    Args:
        machine: what falls.
        urdf: its URDF text, for the inertias.
        terrain: the ground.
        place: x, y, yaw of the base.
        fixed: values of joints.
        span: side of the square of ground around the place [m].
        seconds: most time.
    """
    fixed = dict(fixed or {})
    heights, low = sampled(terrain, place, span)
    rise = max(float(np.ptp(heights)), 1e-3)
    corner = (place[0], place[1], low)
    model = mujoco.MjModel.from_xml_string(mjcf(machine, urdf, fixed, heights.shape[0], span, rise, corner))
    model.hfield_data[:] = ((heights - low) / rise).ravel()
    data = mujoco.MjData(model)
    yaw = place[2]
    data.qpos[:7] = place[0], place[1], 0.0, np.cos(yaw / 2), 0.0, 0.0, np.sin(yaw / 2)
    mujoco.mj_forward(model, data)
    data.qpos[2] = _lift(machine, model, data, terrain)
    model.dof_damping[:6] = _damping(machine)
    waited = 0
    for count in range(int(seconds / model.opt.timestep)):
        mujoco.mj_step(model, data)
        if count % 25 == 0:
            waited = waited + 1 if np.max(np.abs(data.qvel)) < REST else 0
        if waited == 4:
            break
    body = data.body(machine.root)
    return AtRest(body.xpos.copy(), body.xmat.reshape(3, 3).copy(), float(np.max(np.abs(data.qvel))))


def sampled(terrain, place, span) -> tuple[np.ndarray, float]:
    """Heights (n, n) about a place, rows along +y, and the least."""
    count = round(span / SAMPLE) + 1
    offsets = np.linspace(-span / 2, span / 2, count)
    x, y = np.meshgrid(place[0] + offsets, place[1] + offsets)
    heights = terrain.height(x, y)
    return heights, float(heights.min())


def _lift(machine, model, data, terrain) -> float:
    """Base height at which every wheel is a millimetre above the highest ground under it."""
    needed = []
    for disc in machine.discs:
        geom = data.geom(f"wheel_{disc.name}")
        reach = disc.ring + disc.tread
        offsets = np.linspace(-reach, reach, 40)
        x, y = np.meshgrid(geom.xpos[0] + offsets, geom.xpos[1] + offsets)
        needed.append(float(np.max(terrain.height(x, y))) + reach - geom.xpos[2])
    return max(needed) + 1e-3


def _damping(machine) -> np.ndarray:
    """Of the base, so that it sinks at about half a metre a second."""
    return np.array([20.0, 20.0, 20.0, 5.0, 5.0, 5.0]) * machine.mass


def mjcf(machine: Machine, urdf: str, fixed, count: int, span: float, rise: float, at) -> str:
    """The model as MJCF text."""
    top = ET.Element("mujoco")
    ET.SubElement(top, "compiler", angle="radian", inertiafromgeom="false", balanceinertia="true",
                  boundmass="1e-4", boundinertia="1e-5")  # fmt: skip
    ET.SubElement(top, "option", timestep="0.002", integrator="implicitfast", cone="elliptic", impratio="10",
                  noslip_iterations="5")  # fmt: skip
    asset = ET.SubElement(top, "asset")
    size = f"{span / 2} {span / 2} {rise} 0.5"
    ET.SubElement(asset, "hfield", name="ground", nrow=str(count), ncol=str(count), size=size)
    world = ET.SubElement(top, "worldbody")
    ET.SubElement(
        world,
        "geom",
        name="ground",
        type="hfield",
        hfield="ground",
        pos=_text(at),
        contype="0",
        conaffinity="1",
    )
    root = ET.SubElement(world, "body", name=machine.root)
    ET.SubElement(root, "freejoint", name="base")
    bodies = {machine.root: root}
    loose = _loose(machine, fixed)
    for b in machine.branches:
        bodies[b.child] = _body(bodies[b.parent], b, fixed, loose, machine)
    _inertias(bodies, urdf)
    for disc in machine.discs:
        points = _hull(disc)
        vertex = " ".join(f"{v:.9g}" for v in points.ravel())
        ET.SubElement(asset, "mesh", name=f"wheel_{disc.name}", vertex=vertex)
        name = f"wheel_{disc.name}"
        ET.SubElement(bodies[disc.link], "geom", WHEEL, name=name, mesh=name)
    _equalities(top, machine, bodies, fixed, loose)
    return ET.tostring(top, encoding="unicode")


def _loose(machine, fixed) -> set[str]:
    """Joints that move: passive ones that no coupling ties to held ones; the tied ones get their value."""
    moving = set(machine.free()) - {"base_z", "base_pitch", "base_roll"}
    for joints, offset in machine.couplings:
        mine = [j for j in joints if j in moving]
        if len(mine) == 1:
            rest = sum(c * fixed.get(j, 0.0) for j, c in joints.items() if j != mine[0])
            fixed[mine[0]] = (offset - rest) / joints[mine[0]]
            moving.discard(mine[0])
    return moving


def _body(parent, b, fixed, loose, machine):
    """A body at a joint's frame; a held joint is folded into it."""
    place = b.origin.copy()
    if not b.fixed and b.name not in loose and fixed.get(b.name, 0.0):
        turn = np.eye(4)
        value = fixed[b.name]
        if b.sliding:
            turn[:3, 3] = value * b.axis
        else:
            mujoco_quat = np.zeros(4)
            mujoco.mju_axisAngle2Quat(mujoco_quat, b.axis, value)
            flat = np.zeros(9)
            mujoco.mju_quat2Mat(flat, mujoco_quat)
            turn[:3, :3] = flat.reshape(3, 3)
        place = place @ turn
    quat = np.zeros(4)
    mujoco.mju_mat2Quat(quat, place[:3, :3].ravel())
    body = ET.SubElement(parent, "body", name=b.child, pos=_text(place[:3, 3]), quat=_text(quat))
    if b.name in loose:
        joint = {"name": b.name, "type": "slide" if b.sliding else "hinge", "axis": _text(b.axis)}
        joint["damping"] = str(machine.mass * 0.05)
        for s in machine.springs:
            if s.get("joint") == b.name:
                joint["stiffness"] = str(s["stiffness"])
                joint["springref"] = str(s.get("rest", 0.0) + s.get("preload", 0.0) / s["stiffness"])
        if np.all(np.isfinite(b.limits)):
            joint |= {"limited": "true", "range": _text(b.limits)}
        ET.SubElement(body, "joint", joint)
    return body


def _inertias(bodies, urdf) -> None:
    for link in ET.fromstring(urdf).iter("link"):
        inertial = link.find("inertial")
        if inertial is None or link.get("name") not in bodies:
            continue
        origin, tensor = inertial.find("origin"), inertial.find("inertia")
        keys = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
        xx, yy, zz, xy, xz, yz = (float(tensor.get(k)) for k in keys)
        quat, flat = np.zeros(4), np.zeros(9)
        mujoco.mju_euler2Quat(quat, np.array([float(v) for v in origin.get("rpy", "0 0 0").split()]), "XYZ")
        mujoco.mju_quat2Mat(flat, quat)
        r = flat.reshape(3, 3)
        full = r @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ r.T + 1e-6 * np.eye(3)
        ET.SubElement(bodies[link.get("name")], "inertial", pos=origin.get("xyz", "0 0 0"),
                      mass=inertial.find("mass").get("value"),
                      fullinertia=_text(full[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]))  # fmt: skip


def _hull(disc) -> np.ndarray:
    """Points of the outer half of the swept circle, in the link's frame."""
    helper = np.eye(3)[int(np.argmin(np.abs(disc.axis)))]
    first = np.cross(disc.axis, helper)
    first /= np.linalg.norm(first)
    second = np.cross(disc.axis, first)
    turn = np.linspace(0.0, 2 * np.pi, AROUND, endpoint=False)[:, None, None]
    lean = np.linspace(-np.pi / 2, np.pi / 2, ACROSS)[None, :, None]
    out = np.cos(turn) * first + np.sin(turn) * second
    points = (disc.ring + disc.tread * np.cos(lean)) * out + disc.tread * np.sin(lean) * disc.axis
    return disc.center + points.reshape(-1, 3)


def _equalities(top, machine, bodies, fixed, loose) -> None:
    equality = ET.SubElement(top, "equality")
    for joints, offset in machine.couplings:
        mine = [j for j in joints if j in loose]
        if not mine:
            continue
        assert len(mine) == 2, "MuJoCo ties two joints"
        rest = offset - sum(c * fixed.get(j, 0.0) for j, c in joints.items() if j not in mine)
        a, b = joints[mine[0]], joints[mine[1]]
        line = _text((rest / a, -b / a, 0, 0, 0))
        ET.SubElement(equality, "joint", STIFF, joint1=mine[0], joint2=mine[1], polycoef=line)
    for i, pair in enumerate(machine.balls):
        for end, letter in zip(pair, "ab", strict=True):
            spot = _text(end.get("xyz", (0, 0, 0)))
            ET.SubElement(bodies[end["link"]], "site", name=f"loop_{i}{letter}", pos=spot)
        ET.SubElement(equality, "connect", STIFF, site1=f"loop_{i}a", site2=f"loop_{i}b")


def _text(values) -> str:
    return " ".join(f"{float(v):.12g}" for v in values)
