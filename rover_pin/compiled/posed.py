"""A machine in a posture: what is held is merged, what moves is left, as arrays for the kernels."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rover_pin.compiled.machine import Machine
from rover_pin.numerics import Array

Integers = NDArray[np.int64]

BASE = 6
_EYE = np.eye(3)

FREE_OF_BASE = (2, 4, 5)
"""Entries of the configuration that the base leaves free: z, pitch, roll; they lead the free coordinates."""


Posed = Any
"""A record of `posed_dtype`: one machine in one posture."""


def posed_dtype(size: int) -> np.dtype[np.void]:
    """Room for a machine of at most `size` bodies, free coordinates, shapes and so on.

    Records, because kernels take one as one pointer; sizes by tiers, so that one compilation serves many
    rovers. Every body's frame is turned so that its joint's axis is its z axis, which makes a joint's turn
    two columns to mix. Free coordinates z: the base's height, pitch and roll, then passive joints. One-sided
    rows are numbered as on the plain path: a contact a shape, then stops, then struts' stops, then tracks.
    """
    real, whole = np.float64, np.int64
    return np.dtype(
        [
            *((name, whole) for name in COUNTS),
            ("parents", whole, size),  # body that carries the joint; 0 for the base itself
            ("turning", whole, size),  # whether the joint turns, else it slides
            ("rotations", real, (size, 3, 3)),  # of the body's frame at coordinate 0 in its parent's
            ("translations", real, (size, 3)),  # m
            ("basis", real, (size, size)),  # the joint's coordinate = basis z + offset
            ("offsets", real, size),
            ("masses", real, size),  # kg
            ("moments", real, (size, 3)),  # kg m, mass times centre of mass
            ("carriers", whole, size),  # body of each shape
            ("centers", real, (size, 3)),  # m
            ("axes", real, (size, 3)),
            ("rings", real, size),  # m
            ("treads", real, size),  # m
            ("reach_of", whole, size),  # the first of the shape's reaches in the ground's bounds
            ("stop_bodies", whole, 2 * size),  # the joint of each stop
            ("stop_signs", real, 2 * size),  # 1 upper, -1 lower
            ("stop_limits", real, 2 * size),
            ("loop_kinds", whole, size),
            ("loop_bodies", whole, (size, 2)),
            ("loop_rotations", real, (size, 2, 3, 3)),
            ("loop_origins", real, (size, 2, 3)),  # m
            ("loop_across", real, (size, 3, 3)),
            ("loop_lengths", real, size),  # m
            ("loop_starts", whole, size + 1),  # first row of each
            ("torsion_bodies", whole, size),  # joints of joint springs
            ("torsions", real, (size, 3)),  # stiffness, rest, preload
            ("strut_bodies", whole, (size, 2)),  # ends of frame springs
            ("strut_origins", real, (size, 2, 3)),  # m
            ("struts", real, (size, 3)),  # stiffness, preload, greatest length
            ("track_starts", whole, size + 1),  # first circle of each track
            ("track_bodies", whole, 2 * size),  # of the circles
            ("track_centers", real, (2 * size, 3)),  # m
            ("track_rho", real, 2 * size),  # m, signed radii
            ("track_planes", whole, size),  # body that carries each track's plane
            ("track_axes", real, (size, 3, 3)),  # columns u, v and the plane's axis
            ("track_lengths", real, size),  # m
            ("above", whole, size + 2),  # the column that each column hangs on: height, pitch, roll, bodies
            ("belly_bodies", whole, 2 * size),
            ("belly", real, (2 * size, 3)),  # m
            ("outline_bodies", whole, 8 * size),  # ascending
            ("outline", real, (8 * size, 3)),  # m, corners whose hull holds all that must not touch ground
            ("outline_fits", whole),  # whether the ground's bounds reach that far
            ("skin_known", whole),  # whether the points of the underside are this machine's
            ("skin_bodies", whole, size),  # the joint frames that carry them
            ("skin_rotations", real, (size, 3, 3)),
            ("skin_origins", real, (size, 3)),  # m
            ("skin_starts", whole, size + 1),  # first point of each
            ("active", whole, size),  # one-sided rows that carry on level ground, ascending
            ("held_loops", whole, size),  # independent loop rows
            ("sign", real),  # of the determinant of those rows, 0 where they do not determine the pose
            ("reach", real),  # farthest landing from the start, share of the span or rad
            ("start", real, size),  # free coordinates on level ground at height 0
            ("usable", whole),  # whether cases of this machine can be answered
            ("weight", real),  # N
            ("span", real),  # m, of the wheels
            ("units", real, size),  # size of a free coordinate's motion: the span for lengths, 1 for angles
            ("gravity", real),  # m/s2
        ],
        align=True,
    )


COUNTS = (
    "n_bodies", "n_free", "n_shapes", "n_stops", "n_loops", "n_loop_rows", "n_torsions", "n_struts",
    "n_tracks", "n_circles",
    "n_belly", "n_outline", "n_skin", "n_active", "n_held_loops",
)  # fmt: skip
"""How many of each a record holds."""


class Placed(NamedTuple):
    """Where a joint's frame lies on the body that it was merged into: body, rotation (g, 3, 3), origin."""

    body: int
    rotation: Array
    origin: Array


def merge(machine: Machine, values: Array, moving: Sequence[int]) -> tuple[list[Placed], list[Bodies]]:
    """Joints merged into bodies.

    Args:
        machine: g designs.
        values: (g, nv) configuration; entries of joints that do not move are held there.
        moving: entries of the configuration that move, beyond the base's.

    Returns:
        per Pinocchio joint its place (of 0 and 1: the base), and the bodies' own placements, the base first.
    """
    count = len(values)
    eye = np.broadcast_to(np.eye(3), (count, 3, 3))
    nothing = np.zeros((count, 3))
    placed = [Placed(0, eye, nothing), Placed(0, eye, nothing)]
    bodies = [Bodies(0, True, eye, nothing, -1)]
    for joint in range(2, len(machine.parents)):
        parent = placed[int(machine.parents[joint])]
        rotation = _product(parent.rotation, machine.rotations[:, joint])
        origin = parent.origin + _turned(parent.rotation, machine.translations[:, joint])
        axis, column = machine.axes[:, joint], BASE + joint - 2
        turns = bool(machine.turning[joint])
        if column in moving:
            along = _frames_along(axis)
            bodies.append(Bodies(parent.body, turns, _product(rotation, along), origin, column))
            placed.append(Placed(len(bodies) - 1, np.swapaxes(along, 1, 2), nothing))
        elif not values[:, column].any():
            placed.append(Placed(parent.body, rotation, origin))
        elif turns:
            placed.append(Placed(parent.body, _product(rotation, _turn(axis, values[:, column])), origin))
        else:
            slid = origin + _turned(rotation, axis * values[:, column, None])
            placed.append(Placed(parent.body, rotation, slid))
    return placed, bodies


class Bodies(NamedTuple):
    """One body: its parent, whether it turns, its placement (g, 3, 3), (g, 3), its configuration entry."""

    parent: int
    turns: bool
    rotation: Array
    origin: Array
    column: int


def points(placed: Sequence[Placed], joints: Integers, local: Array) -> tuple[Integers, Array]:
    """Points (g, p, 3) given in joints' frames, as bodies (p,) and points (g, p, 3) in those."""
    out = np.empty((len(placed[0].origin), len(joints), 3))
    for k, joint in enumerate(joints):
        out[:, k] = placed[joint].origin + _turned(placed[joint].rotation, local[:, k])
    return np.array([placed[joint].body for joint in joints], dtype=np.int64), out


def directions(placed: Sequence[Placed], joints: Integers, local: Array) -> Array:
    """Directions (g, p, 3) given in joints' frames, in their bodies' frames."""
    out = np.empty((len(placed[0].origin), len(joints), 3))
    for k, joint in enumerate(joints):
        out[:, k] = _turned(placed[joint].rotation, local[:, k])
    return out


def rotations(placed: Sequence[Placed], joints: Integers, local: Array) -> Array:
    """Rotations (g, p, 3, 3) given in joints' frames, in their bodies' frames."""
    out = np.empty((len(placed[0].origin), len(joints), 3, 3))
    for k, joint in enumerate(joints):
        out[:, k] = placed[joint].rotation @ local[:, k]
    return out


def lumps(machine: Machine, placed: Sequence[Placed], count: int) -> tuple[Array, Array]:
    """Masses (g, b) and first moments (g, b, 3) of the bodies; one row where every group's are the same."""
    groups = max(len(machine.masses), *(len(each.origin) for each in placed))
    masses, moments = np.zeros((groups, count)), np.zeros((groups, count, 3))
    for joint in range(1, len(placed)):
        body, rotation, origin = placed[joint]
        mass, moment = machine.masses[:, joint], machine.moments[:, joint]
        masses[:, body] += mass
        moments[:, body] += _turned(rotation, moment) + mass[:, None] * origin
    return masses, moments


def _product(one: Array, other: Array) -> Array:
    """(g or 1, 3, 3) products; a factor that turns nothing is passed over, which changes no bit."""
    if (other == _EYE).all():
        return one if len(one) >= len(other) else np.broadcast_to(one, other.shape)
    if (one == _EYE).all() and len(other) >= len(one):
        return other
    result: Array = one @ other
    return result


def _turned(rotation: Array, vector: Array) -> Array:
    """Rows R v of (g or 1, 3, 3) and (g or 1, 3), summed in a fixed order: bits hang on a row alone."""
    if len(vector) >= len(rotation) and (rotation == _EYE).all():
        return vector
    result: Array = (
        rotation[:, :, 0] * vector[:, 0, None]
        + rotation[:, :, 1] * vector[:, 1, None]
        + rotation[:, :, 2] * vector[:, 2, None]
    )
    return result


def _turn(axis: Array, angle: Array) -> Array:
    """(g, 3, 3) rotations about unit axes (g, 3) by angles (g,) (Rodrigues)."""
    c, s = np.cos(angle)[:, None, None], np.sin(angle)[:, None, None]
    x, y, z = axis.T
    zero = np.zeros_like(x)
    cross = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=1).reshape(-1, 3, 3)
    result: Array = c * np.eye(3) + s * cross + (1.0 - c) * axis[:, :, None] * axis[:, None, :]
    return result


def _frames_along(axis: Array) -> Array:
    """(g, 3, 3) rotations whose third column is the axis (g, 3)."""
    helper = np.eye(3)[np.argmin(np.abs(axis), axis=1)]
    first = np.cross(helper, axis)
    first /= np.sqrt(np.sum(first * first, axis=1, keepdims=True))
    return np.stack([first, np.cross(axis, first), axis], axis=2)
