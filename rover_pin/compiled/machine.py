"""Machine: a rover as arrays, one row a design: all that the compiled path knows of its tree and elements."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rover_pin.mechanism import FrameSpring, JointSpring
from rover_pin.numerics import Array

if TYPE_CHECKING:
    from rover_pin.rover import Rover

Integers = NDArray[np.int64]

FIRST_JOINT = 2
"""Pinocchio's id of the first moving joint: 0 is the universe, 1 the base."""


class Machine(NamedTuple):
    """Designs of one rover: g of them, alike in all but numbers.

    Joints are Pinocchio's ids; arrays over joints have an entry for every id, neutral for universe and base.

    Attributes:
        parents: (j,) the joint that carries a joint.
        turning: (j,) True of a revolute, False of a prismatic joint.
        shape_joints: (s,) carriers of wheels and feet.
        outline_joints: (o,) ascending.
        belly_joints: (b,).
        axes: (g, j, 3) unit, in the joint's own frame.
        rotations: (g, j, 3, 3) of a joint's frame at zero in the frame of its parent.
        translations: (g, j, 3) m, of its origin there.
        masses: (g, j) kg, of all that is fixed to a joint, payload included.
        moments: (g, j, 3) kg m, mass times its centre in the joint's frame.
        centers: (g, s, 3) m, of wheels and feet, in the frame of their joint.
        shape_axes: (g, s, 3) unit, likewise.
        lower: (g, nv) rad or m.
        upper: (g, nv) rad or m.
        coupling_rows: (g, c, nv): rows times q = offsets.
        coupling_offsets: (g, c) rad or m.
        belly: (g, b, 3) m, in the frame of their joint.
        outline: (g, o, 3) m: per joint the corners of the box, along the joint's axes, that holds its belly
            points and the boxes around its collision shapes.
        loop_joints: (l, 2).
        loop_rotations: (g, l, 2, 3, 3) of the frames that a loop joins, in their joints' frames.
        loop_translations: (g, l, 2, 3) m.
        loop_lengths: (g, l) m, of distance loops.
        loop_across: (g, l, 3, 3) columns t1, t2 and the axis, in a frame's coordinates.
        strut_joints: (f, 2), of springs between frames.
        strut_translations: (g, f, 2, 3) m, their ends in the joints' frames.
        strut_values: (g, f, 3) stiffness N/m, preload N, greatest length m.
        torsion_values: (g, k, 3) of joint springs: stiffness, rest, preload.
        rings: (g, s) m, of wheels and feet.
        treads: (g, s) m.
        track_starts: (t + 1,) first circle of each track.
        track_joints: (c,) carriers of the tracks' circles.
        track_planes: (t,) joints that carry the tracks' planes.
        track_centers: (g, c, 3) m, of the circles, in the frame of their joint.
        track_axes: (g, t, 3, 3) columns u, v and the plane's axis, in the frame of the plane's joint.
        track_rho: (g, c) m, signed radii.
        track_lengths: (g, t) m.
    """

    parents: Integers
    turning: NDArray[np.bool_]
    shape_joints: Integers
    outline_joints: Integers
    belly_joints: Integers
    axes: Array
    rotations: Array
    translations: Array
    masses: Array
    moments: Array
    centers: Array
    shape_axes: Array
    lower: Array
    upper: Array
    coupling_rows: Array
    coupling_offsets: Array
    belly: Array
    outline: Array
    loop_joints: Integers
    loop_rotations: Array
    loop_translations: Array
    loop_lengths: Array
    loop_across: Array
    strut_joints: Integers
    strut_translations: Array
    strut_values: Array
    torsion_values: Array
    rings: Array
    treads: Array
    track_starts: Integers
    track_joints: Integers
    track_planes: Integers
    track_centers: Array
    track_axes: Array
    track_rho: Array
    track_lengths: Array


def machine_of(rover: Rover) -> Machine:
    """The one design that a rover is."""
    model = rover.model
    joints, nv = model.njoints, model.nv
    axes, turning = _axes(model)
    inertias = list(model.inertias)
    struts = [spring for spring in rover.springs if isinstance(spring, FrameSpring)]
    torsions = [spring for spring in rover.springs if isinstance(spring, JointSpring)]
    belly_joints = integers([point.joint for point in rover.belly])
    belly = _one([point.point for point in rover.belly], len(rover.belly), 3)
    around = rover.read_geometry().around
    outline_joints, outline = outline_of(
        np.concatenate([belly_joints, integers([point.joint for point in around])]),
        np.concatenate([belly, _one([point.point for point in around], len(around), 3)], axis=1),
    )
    loops = [(loop.first, loop.second) for loop in rover.loops]
    ends = [(strut.first, strut.second) for strut in struts]
    circles = [circle for track in rover.tracks for circle in track.circles]
    return Machine(
        parents=integers(model.parents),
        turning=turning,
        shape_joints=integers([shape.joint for shape in rover.shapes]),
        outline_joints=outline_joints,
        belly_joints=belly_joints,
        axes=axes[None],
        rotations=_one([place.rotation for place in model.jointPlacements], joints, 3, 3),
        translations=_one([place.translation for place in model.jointPlacements], joints, 3),
        masses=_one([body.mass for body in inertias], joints),
        moments=_one([body.mass * body.lever for body in inertias], joints, 3),
        centers=_one([shape.center for shape in rover.shapes], len(rover.shapes), 3),
        shape_axes=_one([shape.axis for shape in rover.shapes], len(rover.shapes), 3),
        lower=_one(rover.lower, nv),
        upper=_one(rover.upper, nv),
        coupling_rows=_one([coupling.row for coupling in rover.couplings], len(rover.couplings), nv),
        coupling_offsets=_one([coupling.offset for coupling in rover.couplings], len(rover.couplings)),
        belly=belly,
        outline=outline,
        loop_joints=_pairs(loops),
        loop_rotations=_one([[f.rotation for f in pair] for pair in loops], len(loops), 2, 3, 3),
        loop_translations=_one([[f.translation for f in pair] for pair in loops], len(loops), 2, 3),
        loop_lengths=_one([loop.length for loop in rover.loops], len(loops)),
        loop_across=_one([loop.across for loop in rover.loops], len(loops), 3, 3),
        strut_joints=_pairs(ends),
        strut_translations=_one([[f.translation for f in pair] for pair in ends], len(ends), 2, 3),
        strut_values=_one([(s.stiffness, s.preload, s.length_max) for s in struts], len(struts), 3),
        torsion_values=_one([(s.stiffness, s.rest, s.preload) for s in torsions], len(torsions), 3),
        rings=_one([shape.ring for shape in rover.shapes], len(rover.shapes)),
        treads=_one([shape.tread for shape in rover.shapes], len(rover.shapes)),
        track_starts=integers([0, *np.cumsum([len(track.circles) for track in rover.tracks])]),
        track_joints=integers([circle.joint for circle in circles]),
        track_planes=integers([track.joint for track in rover.tracks]),
        track_centers=_one([circle.center for circle in circles], len(circles), 3),
        track_axes=_one([track.axes for track in rover.tracks], len(rover.tracks), 3, 3),
        track_rho=_one([circle.rho for circle in circles], len(circles)),
        track_lengths=_one([track.length for track in rover.tracks], len(rover.tracks)),
    )


def pick(machine: Machine, which: Integers | slice) -> Machine:
    """Some designs of a machine, in the order of `which`."""
    arrays: dict[str, Any] = machine._asdict()
    varied = {name: array[which] for name, array in arrays.items() if array.dtype == np.float64}
    return machine._replace(**varied)


def outline_of(joints: Integers, points: Array) -> tuple[Integers, Array]:
    """The corners of the boxes, along each joint's axes, that hold its points.

    Args:
        joints: (p,) whose the points are, in any order.
        points: (g, p, 3) m, in the frames of their joints.

    Returns:
        (o,) joints, ascending, eight times each, and (g, o, 3) m.
    """
    carriers = np.unique(joints)
    corners = np.empty((points.shape[0], len(carriers), 8, 3))
    high = (np.arange(8)[:, None] >> np.arange(3) & 1).astype(bool)
    for i, joint in enumerate(carriers):
        own = points[:, joints == joint]
        corners[:, i] = np.where(high, own.max(axis=1)[:, None], own.min(axis=1)[:, None])
    return np.repeat(carriers, 8), corners.reshape(points.shape[0], -1, 3)


def integers(values: Iterable[int]) -> Integers:
    """(n,) int64."""
    return np.array(list(values), dtype=np.int64)


def _axes(model: Any) -> tuple[Array, NDArray[np.bool_]]:
    """(j, 3) axes, and whether a joint turns, by Pinocchio's motion subspaces; zero and True of the base."""
    axes = np.zeros((model.njoints, 3))
    turning = np.ones(model.njoints, dtype=bool)
    for joint in range(FIRST_JOINT, model.njoints):
        motion = np.asarray(model.joints[joint].createData().S, dtype=np.float64).reshape(6)
        turning[joint] = not motion[:3].any()
        axes[joint] = motion[3:] if turning[joint] else motion[:3]
    return axes, turning


def _one(values: ArrayLike, *shape: int) -> Array:
    """Values as the array of a single design, also where there are none."""
    return np.array(values, dtype=np.float64).reshape(1, *shape)


def _pairs(pairs: list[tuple[Any, Any]]) -> Integers:
    """(l, 2) joints of pairs of frames."""
    return integers(frame.joint for pair in pairs for frame in pair).reshape(len(pairs), 2)
