"""From a machine and the values that are held to the arrays of the kernels."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rover_pin.compiled.internal import COLUMN
from rover_pin.compiled.machine import Machine
from rover_pin.compiled.posed import (
    BASE,
    Bodies,
    Integers,
    Placed,
    directions,
    lumps,
    merge,
    points,
    posed_dtype,
    rotations,
)
from rover_pin.mechanism import FrameSpring, JointSpring
from rover_pin.mechanism.closure import SIZES
from rover_pin.mechanism.loop import KINDS
from rover_pin.numerics import Array

if TYPE_CHECKING:
    from rover_pin.rover import Rover
    from rover_pin.statics.problem import Problem

YAW = 3

LEAST_TIER = 12

CONTRADICTION = 1e-9
"""rad or m: held values that a coupling contradicts by more than this are bad input."""


class Pose(NamedTuple):
    """A machine of g groups with joints held at values, ready for the kernels.

    Attributes:
        records: (g,) machines of `posed_dtype`.
        placed: where each joint's frame lies on its body.
        basis: (g, nv, n); offset: (g, nv): configuration = basis z + offset, with x, y, yaw 0.
        consistent: (g,) whether the held values satisfy the couplings.
    """

    records: NDArray[np.void]
    placed: Sequence[Placed]
    basis: Array
    offset: Array
    consistent: NDArray[np.bool_]

    def joints(self, groups: Integers, z: Array) -> Array:
        """(n, joints) rad or m at free coordinates z (n, free) of cases of these groups (n,)."""
        g = np.maximum(groups, 0) if len(self.offset) > 1 else np.zeros(1, dtype=np.int64)
        out = np.broadcast_to(self.offset[g, BASE:], (len(z), self.offset.shape[1] - BASE)).copy()
        for k in range(z.shape[1]):
            out += self.basis[g, BASE:, k] * z[:, k, None]
        return out


def pose(rover: Rover, machine: Machine, problem: Problem, held: Sequence[str], values: Array) -> Pose:
    """Merge what is held.

    Args:
        rover: the rover as loaded.
        machine: its designs, one or one a group.
        problem: the plain path's, which says what is free.
        held: names of the joints that are held.
        values: (g, nv) configuration, read where it is held.
    """
    columns = list(problem.reduction.columns)
    fixed = {0, 1, YAW, *(rover.column[joint] for joint in held)}
    dependent = [k for k in range(values.shape[1]) if k not in fixed and k not in columns]
    basis, offset, consistent = _reduced(machine, columns, dependent, values)
    moving = np.flatnonzero(np.any(problem.reduction.basis != 0.0, axis=1))
    placed, bodies = merge(machine, offset, [int(column) for column in moving if column >= BASE])
    records = _records(rover, machine, problem, placed, bodies, basis, offset)
    return Pose(records, placed, basis, offset, consistent)


def _reduced(
    machine: Machine, columns: Sequence[int], dependent: Sequence[int], values: Array
) -> tuple[Array, Array, NDArray[np.bool_]]:
    """basis (g, nv, n) and offset (g, nv) that satisfy the couplings, and whether they do (g,).

    Entries that are neither free nor held depend on those by the coupling rows, design by design.
    """
    count, nv = values.shape
    rows, right = _wide(machine.coupling_rows, count), _wide(machine.coupling_offsets, count)
    basis = np.zeros((count, nv, len(columns)))
    offset = values.copy()
    offset[:, [*columns, *dependent]] = 0.0
    for k, column in enumerate(columns):
        basis[:, column, k] = 1.0
    if dependent:
        inverse: Array = np.linalg.pinv(rows[:, :, dependent]).astype(np.float64)
        basis[:, dependent] = -inverse @ rows[:, :, list(columns)]
        basis[np.abs(basis) < 1e-15] = 0.0
        offset[:, dependent] = _product(inverse, right - _product(rows, offset))
    residual = _product(rows, offset) - right
    return basis, offset, np.all(np.abs(residual) <= CONTRADICTION, axis=1)


def _product(matrices: Array, vectors: Array) -> Array:
    """Rows M v of (g, r, c) and (g, c)."""
    result: Array = (matrices @ vectors[:, :, None])[:, :, 0]
    return result


def spans_of(rover: Rover, machine: Machine, count: int) -> Array:
    """(count,) m, the largest distance between two shapes at home, as `Rover.wheel_span`."""
    placed, _ = merge(machine, home_of(rover, machine), ())
    _, centers = points(placed, machine.shape_joints, machine.centers)
    away = centers[:, :, None] - centers[:, None, :]
    span = np.sqrt(np.max(np.sum(away * away, axis=-1), axis=(1, 2), initial=0.0))
    lone = 2.0 * np.max(machine.rings + machine.treads, axis=1, initial=0.0)
    lone[lone == 0.0] = 1.0
    return _wide(np.maximum(np.where(span > 0.0, span, lone), 1e-3), count)


def home_of(rover: Rover, machine: Machine) -> Array:
    """(g, nv) configuration at home, as `Rover.neutral`."""
    home: Array = np.clip(0.0, machine.lower, machine.upper)
    for name, value in rover.home.items():
        home[:, rover.column[name]] = value
    return home


def _records(
    rover: Rover,
    machine: Machine,
    problem: Problem,
    placed: Sequence[Placed],
    bodies: Sequence[Bodies],
    basis: Array,
    offset: Array,
) -> NDArray[np.void]:
    """(g,) machines of `posed_dtype`; supports, reaches and the underside are still to be written."""
    count, n = basis.shape[0], basis.shape[2]
    struts = [s for s in rover.springs if isinstance(s, FrameSpring)]
    body_of = {body.column: k for k, body in enumerate(bodies) if k > 0}
    torsions = [s for s in rover.springs if isinstance(s, JointSpring) and s.column in body_of]
    kinds = [KINDS.index(loop.type) for loop in rover.loops]
    sizes = {
        "n_bodies": len(bodies),
        "n_free": n,
        "n_shapes": len(rover.shapes),
        "n_stops": len(problem.stop_joints),
        "n_loops": len(kinds),
        "n_loop_rows": sum(SIZES[kind] for kind in kinds),
        "n_torsions": len(torsions),
        "n_struts": len(struts),
        "n_tracks": len(machine.track_planes),
        "n_circles": len(machine.track_joints),
        "n_belly": len(machine.belly_joints),
        "n_outline": len(machine.outline_joints),
    }
    out = np.zeros(count, dtype=posed_dtype(tier_of(sizes)))
    for name, size in sizes.items():
        out[name] = size
    columns = [max(body.column, 0) for body in bodies]
    masses, moments = lumps(machine, placed, len(bodies))
    _put(out, "parents", [body.parent for body in bodies])
    _put(out, "turning", [body.turns for body in bodies])
    _put(out, "above", [-1, 0, 1, *(COLUMN + body.parent for body in bodies[1:])])
    for k, body in enumerate(bodies):
        out["rotations"][:, k], out["translations"][:, k] = body.rotation, body.origin
    out["basis"][:, : len(bodies), :n] = basis[:, columns]
    out["offsets"][:, : len(bodies)] = offset[:, columns]
    out["masses"][:, : len(bodies)], out["moments"][:, : len(bodies)] = masses, moments
    _place(out, "carriers", "centers", placed, machine.shape_joints, machine.centers)
    shapes = len(rover.shapes)
    out["axes"][:, :shapes] = directions(placed, machine.shape_joints, _wide(machine.shape_axes, count))
    out["rings"][:, :shapes], out["treads"][:, :shapes] = machine.rings, machine.treads
    for k, joint in enumerate(problem.stop_joints):
        column, sign = rover.column[joint], problem.stop_sign(k)
        out["stop_bodies"][:, k], out["stop_signs"][:, k] = body_of[column], sign
        out["stop_limits"][:, k] = (machine.upper if sign > 0.0 else machine.lower)[:, column]
    _put(out, "loop_kinds", kinds)
    _put(out, "loop_starts", [0, *np.cumsum([SIZES[kind] for kind in kinds])])
    out["loop_across"][:, : len(kinds)] = machine.loop_across
    out["loop_lengths"][:, : len(kinds)] = machine.loop_lengths
    for e in range(2):
        joints = machine.loop_joints[:, e]
        owners, origins = points(placed, joints, _wide(machine.loop_translations[:, :, e], count))
        out["loop_bodies"][:, : len(kinds), e], out["loop_origins"][:, : len(kinds), e] = owners, origins
        turned = rotations(placed, joints, _wide(machine.loop_rotations[:, :, e], count))
        out["loop_rotations"][:, : len(kinds), e] = turned
        joints = machine.strut_joints[:, e]
        owners, origins = points(placed, joints, _wide(machine.strut_translations[:, :, e], count))
        out["strut_bodies"][:, : len(struts), e], out["strut_origins"][:, : len(struts), e] = owners, origins
    _put_tracks(out, machine, placed)
    _put(out, "torsion_bodies", [body_of[s.column] for s in torsions])
    joint_springs = [s for s in rover.springs if isinstance(s, JointSpring)]
    moving = [k for k, s in enumerate(joint_springs) if s.column in body_of]
    out["torsions"][:, : len(moving)] = machine.torsion_values[:, moving]
    out["struts"][:, : len(struts)] = machine.strut_values
    _place(out, "belly_bodies", "belly", placed, machine.belly_joints, machine.belly)
    _place(out, "outline_bodies", "outline", placed, machine.outline_joints, machine.outline)
    spans = spans_of(rover, machine, count)
    out["weight"] = np.sum(machine.masses, axis=1) * problem.gravity
    out["span"] = spans
    out["units"][:, :n] = np.where(problem.lengths, spans[:, None], 1.0)
    out["gravity"] = problem.gravity
    out["usable"] = 1
    return out


def _put_tracks(out: NDArray[np.void], machine: Machine, placed: Sequence[Placed]) -> None:
    """Write the tracks into every record."""
    tracks, circles = len(machine.track_planes), len(machine.track_joints)
    _put(out, "track_starts", machine.track_starts.tolist())
    _place(out, "track_bodies", "track_centers", placed, machine.track_joints, machine.track_centers)
    out["track_rho"][:, :circles] = machine.track_rho
    _put(out, "track_planes", [placed[joint].body for joint in machine.track_planes])
    axes = _wide(machine.track_axes, len(out))
    out["track_axes"][:, :tracks] = rotations(placed, machine.track_planes, axes)
    out["track_lengths"][:, :tracks] = machine.track_lengths


def tier_of(sizes: Mapping[str, int]) -> int:
    """The least of 12, 24, 48, ... that holds a machine of these sizes."""
    needed = [sizes[name] for name in ("n_bodies", "n_free", "n_shapes", "n_loops", "n_torsions", "n_struts")]
    needed += [sizes["n_tracks"], -(-sizes["n_circles"] // 2)]
    needed += [-(-sizes["n_stops"] // 2), -(-sizes["n_belly"] // 2), -(-sizes["n_outline"] // 8)]
    needed += [-(-sizes["n_loop_rows"] // 2)]
    tier = LEAST_TIER
    while tier < max(needed):
        tier *= 2
    return tier


def _put(out: NDArray[np.void], name: str, values: Sequence[Any]) -> None:
    """Write the same leading entries of a field into every record."""
    if len(values):
        out[name][:, : len(values)] = np.asarray(values)


def _place(
    out: NDArray[np.void], owners: str, name: str, placed: Sequence[Placed], joints: Integers, local: Array
) -> None:
    """Write points given in joints' frames, ordered by body where their order is free."""
    bodies, found = points(placed, joints, _wide(local, len(out)))
    order = np.argsort(bodies, kind="stable") if owners == "outline_bodies" else np.arange(len(bodies))
    out[owners][:, : len(bodies)] = bodies[order]
    out[name][:, : len(bodies)] = found[:, order]


def _wide(values: Array, count: int) -> Array:
    """One row for every group, where there is one for all."""
    return np.ascontiguousarray(np.broadcast_to(values, (count, *values.shape[1:])))
