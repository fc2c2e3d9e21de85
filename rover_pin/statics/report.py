"""From a footing to the Stance that users see: contacts, loads, residuals, verdict."""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from rover_pin.mechanism import Kinematics
from rover_pin.numerics import Array, cross, frozen
from rover_pin.statics import residuals
from rover_pin.statics.adapt import JUMP
from rover_pin.statics.ground import PUSH, Footing, failed, let_go, off_map
from rover_pin.statics.loads import Loads, share_loads
from rover_pin.statics.problem import Problem, State
from rover_pin.statics.relax import UPRIGHT
from rover_pin.statics.stance import Contact, Stance, Status
from rover_pin.statics.verdict import (
    free_motions,
    link_in_ground,
    steadiness,
    undetermined_joints,
    way_out,
    wheel_off_map,
)

if TYPE_CHECKING:
    from rover_pin.terrain import Terrain

ACCEPTED = {"equilibrium": 1e-6, "gap_m": 1e-6, "loop_m": 1e-6, "complementarity": 1e-6}
"""Largest residuals of a stance."""

BALANCED = 1e-7
"""Share of the weight that may stay unbalanced before a pose is no stance."""


def report(
    problem: Problem, footing: Footing, terrain: Terrain, locked: tuple[str, ...], *, pushed: bool = False
) -> Stance:
    """The stance of a footing; a pose that fails a check is a status, never a stance."""
    if footing.status is Status.SETTLED and problem.tilt(footing.z) > UPRIGHT:
        footing = failed(footing.z, Status.TIPS, None, "it stands on its side: tilt above 80 deg")
    at = problem.locate(footing.z)
    off = wheel_off_map(problem, at, terrain)
    if off is not None:
        footing = off_map(footing.z, off)
    if footing.status is not Status.SETTLED:
        return _stance(problem, footing, terrain, locked, None, None)
    state = problem.state(footing.z, terrain, 1e-5, at)
    loads = share_loads(problem, state)
    start = footing.z
    footing, undetermined = _judge(problem, footing, terrain, state, loads)
    if footing.status is Status.SETTLED and footing.z is not start and not pushed:
        return report(problem, footing, terrain, locked, pushed=True)
    if footing.status is not Status.SETTLED:
        return _stance(problem, footing, terrain, locked, None, None)
    stance = _stance(problem, footing, terrain, locked, state, loads, undetermined)
    for name, most in ACCEPTED.items():
        if not stance.residuals[name] <= most:
            reason = f"the residual {name} of the pose found is {stance.residuals[name]:.2g}"
            footing = failed(footing.z, Status.NO_CONVERGENCE, None, reason)
            return _stance(problem, footing, terrain, locked, None, None)
    return stance


def _judge(
    problem: Problem, footing: Footing, terrain: Terrain, state: State, loads: Loads
) -> tuple[Footing, tuple[str, ...]]:
    """Balance, signs, steadiness and ground clearance of a pose."""
    z = footing.z
    if not np.any(loads.touching < len(state.owners)):
        return failed(z, Status.SLACK, None, "no wheel touches the ground"), ()
    lightest = float(np.min(loads.multipliers[loads.touching]))
    if loads.unbalanced > BALANCED or lightest < -1e-8 * problem.weight:
        return failed(z, Status.NO_CONVERGENCE, None, "the pose found is not in equilibrium"), ()
    undetermined: tuple[str, ...] = ()
    determined = footing.sign != 0.0 and len(footing.active) + len(footing.loops) == problem.n
    motions = np.zeros((problem.n, 0)) if determined else free_motions(state, loads, problem)
    if motions.shape[1]:
        stiffness = steadiness(problem, state, loads, terrain, motions)
        undetermined = undetermined_joints(problem, motions, stiffness)
        out = way_out(problem, motions, stiffness)
        if out is not None:
            return _topple(problem, z, terrain, out), undetermined
    hit = link_in_ground(problem, problem.locate(z), terrain)
    if hit is not None:
        return failed(z, Status.GROUNDED, hit[0], f"{hit[0]} is {hit[1]:.3g} m in the ground"), undetermined
    return footing, undetermined


def _topple(problem: Problem, z: Array, terrain: Terrain, direction: Array) -> Footing:
    """An equilibrium that does not stay leaves along `direction`: what catches it, or what gives."""
    names = [problem.rover.dof_names[column] for column in problem.reduction.columns]
    moved = np.abs(direction) / problem.unit
    moved[:3] = 0.0
    joint = names[int(np.argmax(moved))] if np.max(moved, initial=0.0) > 1e-3 else None
    push = PUSH * direction
    found = let_go(problem, z + push, terrain, 1e-3, joint)
    near = bool(np.max(np.abs(found.z - z) / problem.unit) < JUMP)
    if found.status is Status.LOOSE or (found.status is Status.SETTLED and near):
        return found
    reason = f"joint {joint} gives way and nothing catches it" if joint else "it balances and would fall over"
    return failed(z, Status.TIPS, joint, reason)


def _stance(
    problem: Problem,
    footing: Footing,
    terrain: Terrain,
    locked: tuple[str, ...],
    state: State | None,
    loads: Loads | None,
    undetermined: tuple[str, ...] = (),
) -> Stance:
    rover = problem.rover
    q = frozen(problem.reduction.expand(footing.z))
    at = problem.locate(footing.z)
    owners, rows = problem.search(at, terrain, 0.0) if state is None else (state.owners, state.contacts)
    gaps: dict[str, float] = {}
    for owner, row in zip(owners, rows, strict=True):
        gaps.setdefault(rover.shapes[int(owner)].name, float(row[0]))
    contacts: tuple[Contact, ...] = ()
    extra: dict[str, Any] = {}
    if state is not None and loads is not None:
        contacts = _contacts(problem, at, state, loads)
        extra = _forces(problem, at, state, loads, contacts, terrain, gaps)
        extra["undetermined"] = undetermined
    return Stance(
        rover=rover,
        terrain=terrain,
        status=footing.status,
        reason=footing.reason,
        limiting=footing.limiting,
        position=frozen(q[:3]),
        rpy=frozen([q[5], q[4], q[3]]),
        joints=MappingProxyType({joint: float(q[rover.column[joint]]) for joint in rover.joints}),
        contacts=contacts,
        gaps=MappingProxyType(gaps),
        com=frozen(pin.centerOfMass(problem.model, problem.data, q)),
        gravity=problem.gravity,
        configuration=q,
        locked=locked,
        **{"loads": MappingProxyType({}), **extra},
    )


def _contacts(problem: Problem, at: Kinematics, state: State, loads: Loads) -> tuple[Contact, ...]:
    """The touching places, with their loads and rolling directions."""
    rows = loads.touching[loads.touching < len(state.owners)]
    owners = state.owners[rows]
    centers, axes = problem.place_shapes(at)
    points, normals = frozen(state.contacts[rows, 1:4]), frozen(state.contacts[rows, 4:7])
    turning = np.array([hasattr(shape, "drive") for shape in problem.rover.shapes])[owners]
    rolling, radii = _rolling(points - centers[owners], axes[owners], normals, turning)
    found = []
    for i, (row, owner) in enumerate(zip(rows.tolist(), owners.tolist(), strict=True)):
        shape = problem.rover.shapes[owner]
        found.append(
            Contact(
                wheel=shape.name,
                joint=int(shape.joint),
                point=points[i],
                normal=normals[i],
                rolling=rolling[i],
                radius=float(radii[i]),
                gap=float(state.contacts[row, 0]),
                load=float(loads.multipliers[row]),
                friction=float(shape.friction),
                free=bool(getattr(shape, "free", False)),
            )
        )
    return tuple(found)


def _rolling(away: Array, axes: Array, normals: Array, turning: NDArray[np.bool_]) -> tuple[Array, Array]:
    """Rolling directions (c, 3), across axis and normal, and levers (c,) [m] of a force along them.

    Zero where the shape does not turn, or lies on its side.
    """
    across = cross(axes, normals)
    size = np.sqrt(np.sum(across * across, axis=1, keepdims=True))
    rolls = turning[:, None] & (size > 1e-9)
    rolling = np.where(rolls, across / np.where(rolls, size, 1.0), 0.0)
    levers = np.abs(np.sum(cross(away, rolling) * axes, axis=1))
    return frozen(rolling), frozen(levers)


def _forces(
    problem: Problem,
    at: Kinematics,
    state: State,
    loads: Loads,
    contacts: tuple[Contact, ...],
    terrain: Terrain,
    gaps: dict[str, float],
) -> dict[str, Any]:
    """Loads, springs, stops and tensions by name, and the residuals."""
    rover = problem.rover
    per_wheel = {shape.name: 0.0 for shape in rover.shapes}
    for contact in contacts:
        per_wheel[contact.wheel] += contact.load
    first = len(state.owners)
    ends = first + len(problem.stop_joints)
    stops = {problem.stop_joints[row - first]: float(n) for row, n in _carried(loads, first, ends)}
    tensions = {track.name: 0.0 for track in rover.tracks}
    for row, n in _carried(loads, ends, len(state.slack)):
        name = problem.one_sided[row - ends].name
        (tensions if name in tensions else stops)[name] = float(n)
    return {
        "loads": MappingProxyType(per_wheel),
        "springs": MappingProxyType({spring.name: spring.effort(at) for spring in rover.springs}),
        "stops": MappingProxyType(stops),
        "tensions": MappingProxyType(tensions),
        **_pulling(problem, at, contacts, tensions),
        "redundant": loads.redundant,
        "residuals": MappingProxyType(_residuals(problem, state, loads, contacts, terrain, gaps)),
    }


def _pulling(
    problem: Problem, at: Kinematics, contacts: tuple[Contact, ...], tensions: dict[str, float]
) -> dict[str, Any]:
    """What contacts pull with, and the tight strands' tensions."""
    resistance, rover = problem.resistance, problem.rover
    tractions = {shape.name: 0.0 for shape in rover.shapes}
    if resistance is None:
        return {"tight": MappingProxyType(dict(tensions)), "tractions": MappingProxyType(tractions)}
    place = {shape.name: i for i, shape in enumerate(rover.shapes)}
    owners = np.array([place[contact.wheel] for contact in contacts], dtype=np.int64)
    normals = np.array([contact.normal for contact in contacts])
    for contact, tangent in zip(contacts, resistance.tangents(at, owners, normals), strict=True):
        if tangent.any():
            tractions[contact.wheel] += resistance.sense * resistance.ratio * contact.load
    tight = {
        track.name: tensions[track.name] + abs(sum(tractions.get(c.name, 0.0) for c in track.circles))
        for track in rover.tracks
    }
    return {
        "tight": MappingProxyType(tight),
        "tractions": MappingProxyType(tractions),
        "traction_ratio": resistance.sense * resistance.ratio,
        "resistance": resistance.force,
    }


def _carried(loads: Loads, low: int, high: int) -> list[tuple[int, float]]:
    rows = loads.touching[(loads.touching >= low) & (loads.touching < high)]
    return [(int(row), float(loads.multipliers[row])) for row in rows if loads.multipliers[row] > 0.0]


def _residuals(
    problem: Problem,
    state: State,
    loads: Loads,
    contacts: tuple[Contact, ...],
    terrain: Terrain,
    gaps: dict[str, float],
) -> dict[str, float]:
    """What `residuals` finds at this pose with these loads."""
    rover = problem.rover
    model = problem.model
    at = Kinematics(model, problem.checking, state.q)
    internal = np.zeros(model.nv)
    row = 0
    for loop in rover.loops:
        internal += loop.jacobian(at).T @ loads.pulls[row : row + loop.size]
        row += loop.size
    first = len(state.owners)
    for place, joint in enumerate(problem.stop_joints):
        sign = problem.stop_sign(place)
        internal[rover.column[joint]] -= sign * loads.multipliers[first + place]
    for place, element in enumerate(problem.one_sided):
        force = loads.multipliers[first + len(problem.stop_joints) + place]
        internal += force * element.slack_gradient(at)
    weight = problem.weight
    return {
        "equilibrium": residuals.equilibrium(
            rover,
            at,
            problem.reduction.basis,
            contacts,
            internal,
            problem.gravity,
            problem.resistance,
        ),
        "gap_m": residuals.gap(rover, at, terrain, contacts),
        "loop_m": residuals.closure(rover, at),
        "complementarity": residuals.complementarity(contacts, gaps, state.slack, loads.multipliers, weight),
    }
