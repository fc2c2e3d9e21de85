"""A rover and its ground as an MJCF text, for MuJoCo as a peer.

Driven joints and wheels are welded at the posture, passive joints are free. A coupling of two joints is a
joint equality, ball loops connect sites, joint springs are joint stiffness. A wheel is the convex hull of the
circle swept by a ball, as a mesh: against ground from outside that is the same shape. The ground is a height
field.
Solver settings: elliptic cones, impratio 10, noslip_iterations 5, implicitfast, steps of 4 ms.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
import pinocchio as pin

from rover_pin.contact import Foot, Wheel
from rover_pin.mechanism.spring import JointSpring
from rover_pin.numerics import Array

if TYPE_CHECKING:
    from rover_pin.rover import Rover

AROUND, ACROSS = 32, 5
"""Corners of a wheel's mesh: about its axis, across its tread."""

STEP_S = 0.004
STIFF = {"solref": "0.004 1", "solimp": "0.9999 0.9999 0.001 0.5 2"}
TOUCH = {
    "contype": "1", "conaffinity": "0", "priority": "1", "condim": "3", "friction": "0.5 0 0",
    "solref": "0.005 1",
}  # fmt: skip
"""Friction of 0.5: where it is higher, a braked bogie can jam with a wheel in the air."""

DAMPING = 0.05  # of a passive joint over the rover's mass, N m s / kg
ROOT = "base"


def cannot(rover: Rover) -> str:
    """What of the rover this model cannot say; empty where it can say all."""
    if any(loop.type != "ball" for loop in rover.loops):
        return "loops other than ball"
    if any(not isinstance(spring, JointSpring) for spring in rover.springs):
        return "springs between frames"
    if any(len(coupling.joints) > 2 for coupling in rover.couplings):
        return "couplings of more than two joints"
    return ""


def mjcf(
    rover: Rover, held: Mapping[str, float], field: tuple[int, int], size: tuple[float, ...], at: Array
) -> str:
    """The model's text.

    Args:
        rover: what stands.
        held: values of joints at the posture; silent ones are 0.
        field: rows and columns of the height field.
        size: half its width along x and y, its rise, its depth, m.
        at: (3,) m, where its middle and lowest height lie.
    """
    values = dict(held)
    loose = _loose(rover, values)
    top = ET.Element("mujoco")
    ET.SubElement(top, "compiler", angle="radian", inertiafromgeom="false", balanceinertia="true",
                  boundmass="1e-4", boundinertia="1e-5")  # fmt: skip
    ET.SubElement(top, "option", timestep=str(STEP_S), integrator="implicitfast", cone="elliptic",
                  impratio="10", noslip_iterations="5")  # fmt: skip
    asset, world = ET.SubElement(top, "asset"), ET.SubElement(top, "worldbody")
    ET.SubElement(asset, "hfield", name="ground", nrow=str(field[0]), ncol=str(field[1]), size=_text(size))
    ET.SubElement(world, "geom", name="ground", type="hfield", hfield="ground", pos=_text(at), contype="0",
                  conaffinity="1")  # fmt: skip
    bodies = _bodies(world, rover, values, loose)
    for shape in rover.shapes:
        _shape(asset, bodies[shape.joint], shape)
    _equalities(top, rover, bodies, values, loose)
    return ET.tostring(top, encoding="unicode")


def _loose(rover: Rover, values: dict[str, float]) -> set[str]:
    """Joints that move; one that a coupling ties to held ones alone gets its value instead."""
    moving = set(rover.passive)
    for coupling in rover.couplings:
        mine = [name for name in coupling.joints if name in moving]
        if len(mine) == 1:
            values[mine[0]] = _rest(coupling.joints, coupling.offset, mine, values) / coupling.joints[mine[0]]
            moving.discard(mine[0])
    return moving


def _rest(joints: Mapping[str, float], offset: float, mine: list[str], values: Mapping[str, float]) -> float:
    """What the coupling leaves for the joints in `mine`."""
    return offset - sum(c * values.get(name, 0.0) for name, c in joints.items() if name not in mine)


def _bodies(
    world: ET.Element, rover: Rover, values: Mapping[str, float], loose: set[str]
) -> dict[int, ET.Element]:
    """A body for each joint of Pinocchio's model; a held joint is folded into its body's place."""
    model = rover.model
    data = model.createData()
    pin.forwardKinematics(model, data, np.zeros(model.nq), np.zeros(model.nv))
    base = ET.SubElement(world, "body", name=ROOT)
    ET.SubElement(base, "freejoint", name="free")
    _inertia(base, model.inertias[1])
    bodies = {1: base}
    for j in range(2, model.njoints):
        name = str(model.names[j])
        subspace = np.asarray(data.joints[j].S, dtype=np.float64).ravel()
        slides = not rover.turning[rover.column[name]]
        axis = subspace[:3] if slides else subspace[3:]
        place = model.jointPlacements[j]
        if name not in loose and values.get(name, 0.0):
            place = place * _moved(axis, slides, values[name])
        quaternion = pin.Quaternion(place.rotation).coeffs()  # x, y, z, w
        body = ET.SubElement(bodies[model.parents[j]], "body", name=f"body_{j}", pos=_text(place.translation),
                             quat=_text(np.roll(quaternion, 1)))  # fmt: skip
        if name in loose:
            _joint(body, rover, name, axis, slides)
        _inertia(body, model.inertias[j])
        bodies[j] = body
    return bodies


def _moved(axis: Array, slides: bool, value: float) -> pin.SE3:
    if slides:
        return pin.SE3(np.eye(3), value * axis)
    return pin.SE3(pin.exp3(value * axis), np.zeros(3))


def _joint(body: ET.Element, rover: Rover, name: str, axis: Array, slides: bool) -> None:
    """A passive joint with its stops and springs."""
    said = {"name": name, "type": "slide" if slides else "hinge", "axis": _text(axis)}
    said["damping"] = f"{DAMPING * rover.mass:.9g}"
    for spring in rover.springs:
        if isinstance(spring, JointSpring) and spring.joint == name:
            rest = spring.rest + spring.preload / spring.stiffness if spring.stiffness else spring.rest
            said |= {"stiffness": f"{spring.stiffness:.12g}", "springref": f"{rest:.12g}"}
    ends = rover.lower[rover.column[name]], rover.upper[rover.column[name]]
    if np.all(np.isfinite(ends)):
        said |= {"limited": "true", "range": _text(ends)}
    ET.SubElement(body, "joint", said)


def _inertia(body: ET.Element, inertia: pin.Inertia) -> None:
    tensor = np.asarray(inertia.inertia) + 1e-6 * np.eye(3)
    full = tensor[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    mass = max(float(inertia.mass), 1e-4)
    ET.SubElement(body, "inertial", pos=_text(inertia.lever), mass=f"{mass:.12g}", fullinertia=_text(full))


def _shape(asset: ET.Element, body: ET.Element, shape: Wheel | Foot) -> None:
    """A wheel's mesh, or a foot's ball."""
    if isinstance(shape, Wheel):
        name = f"wheel_{shape.name}"
        vertex = " ".join(f"{v:.9g}" for v in wheel_hull(shape).ravel())
        ET.SubElement(asset, "mesh", name=name, vertex=vertex)
        ET.SubElement(body, "geom", TOUCH, name=name, type="mesh", mesh=name)
        return
    radius = max(shape.radius, 1e-3)
    ET.SubElement(body, "geom", TOUCH, type="sphere", size=f"{radius:.9g}", pos=_text(shape.center))


def wheel_hull(wheel: Wheel) -> Array:
    """(AROUND * ACROSS, 3) points of the outer half of the swept circle, in the carrier's frame, m."""
    first = np.cross(wheel.axis, np.eye(3)[int(np.argmin(np.abs(wheel.axis)))])
    first /= np.linalg.norm(first)
    second = np.cross(wheel.axis, first)
    turn = np.linspace(0.0, 2.0 * np.pi, AROUND, endpoint=False)[:, None, None]
    lean = np.linspace(-np.pi / 2, np.pi / 2, ACROSS)[None, :, None]
    out = np.cos(turn) * first + np.sin(turn) * second
    points = (wheel.ring + wheel.tread * np.cos(lean)) * out + wheel.tread * np.sin(lean) * wheel.axis
    hull: Array = np.asarray(wheel.center) + points.reshape(-1, 3)
    return hull


def _equalities(
    top: ET.Element,
    rover: Rover,
    bodies: Mapping[int, ET.Element],
    values: Mapping[str, float],
    loose: set[str],
) -> None:
    equality = ET.SubElement(top, "equality")
    for coupling in rover.couplings:
        mine = [name for name in coupling.joints if name in loose]
        if mine:
            first, second = (coupling.joints[name] for name in mine)
            rest = _rest(coupling.joints, coupling.offset, mine, values)
            line = _text((rest / first, -second / first, 0.0, 0.0, 0.0))
            ET.SubElement(equality, "joint", STIFF, joint1=mine[0], joint2=mine[1], polycoef=line)
    for i, loop in enumerate(rover.loops):
        for end, letter in ((loop.first, "a"), (loop.second, "b")):
            ET.SubElement(bodies[end.joint], "site", name=f"loop_{i}{letter}", pos=_text(end.translation))
        ET.SubElement(equality, "connect", STIFF, site1=f"loop_{i}a", site2=f"loop_{i}b")


def _text(values: object) -> str:
    return " ".join(f"{float(v):.12g}" for v in np.asarray(values).ravel())
