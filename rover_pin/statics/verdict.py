"""Verdicts on a pose: over the edge of the map, in the ground, unsteady, or undetermined."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rover_pin.contact.pack import half_extents
from rover_pin.mechanism import Kinematics
from rover_pin.numerics import Array, null_space
from rover_pin.statics.loads import Loads
from rover_pin.statics.problem import Problem, State

if TYPE_CHECKING:
    from rover_pin.terrain import Terrain


UNSTEADY = -1e-7
"""Share of weight times span, per rad, below which a stiffness counts as negative."""


def wheel_off_map(problem: Problem, at: Kinematics, terrain: Terrain) -> str | None:
    """A wheel with a point that is not over the map, or None."""
    if not np.any(np.isfinite(terrain.extent)):
        return None
    shapes = problem.shapes
    centers, axes = problem.place_shapes(at)
    xmin, xmax, ymin, ymax = terrain.extent
    x, y, most = centers[:, 0], centers[:, 1], problem.reach
    if (
        x.min() - most >= xmin
        and x.max() + most <= xmax
        and y.min() - most >= ymin
        and y.max() + most <= ymax
    ):
        return None
    reach = half_extents(shapes.forms, axes, shapes.rings, shapes.treads)
    low, high = centers[:, :2] - reach, centers[:, :2] + reach
    off = (low[:, 0] < xmin) | (high[:, 0] > xmax) | (low[:, 1] < ymin) | (high[:, 1] > ymax)
    return str(problem.rover.shapes[int(np.argmax(off))].name) if np.any(off) else None


def link_in_ground(problem: Problem, at: Kinematics, terrain: Terrain) -> tuple[str, float] | None:
    """The deepest belly or collision point in the terrain: its link and its depth [m], or None."""
    skin = problem.underside
    if not skin.links:
        return None
    places = np.vstack([at.point_rows(joint, points) for joint, points in skin.groups])
    above = places[:, 2] - skin.radii - terrain.height(places[:, 0], places[:, 1])
    deepest = int(np.argmin(above))
    if above[deepest] >= -1e-9:
        return None
    return skin.links[deepest], float(-above[deepest])


def free_motions(state: State, loads: Loads, problem: Problem) -> Array:
    """(n, d) motions that keep every carrying support, and every loop, as it is."""
    carrying = loads.touching[loads.multipliers[loads.touching] > 0.0]
    rows = np.vstack([state.motion[carrying], state.closing]) * problem.unit
    if not len(rows):
        return np.eye(problem.n)
    return null_space(rows)


def steadiness(problem: Problem, state: State, loads: Loads, terrain: Terrain, motions: Array) -> Array:
    """(d, d) stiffness of the stance against its free motions, over weight and span.

    Rows are taken across the supports' forces, so that their multipliers drop out to first order.
    """
    matrix = problem.stiffness(state, terrain, loads.multipliers, loads.pulls, 1e-5)
    scaled = matrix * problem.unit[None, :] * problem.unit[:, None] / (problem.weight * problem.span)
    carrying = loads.touching[loads.multipliers[loads.touching] > 0.0]
    sides = np.vstack([state.force[carrying], state.closing]) * problem.unit
    across: Array = motions
    if len(sides):
        across = null_space(sides)
    if across.shape[1] != motions.shape[1]:
        across = motions
    between, pushed = across.T @ motions, across.T @ scaled @ motions
    if motions.shape[1] == 1 and between[0, 0] != 0.0:
        return np.asarray(pushed / between, dtype=np.float64)
    return np.asarray(np.linalg.lstsq(between, pushed, rcond=None)[0], dtype=np.float64)


def way_out(problem: Problem, motions: Array, stiffness: Array) -> Array | None:
    """(n,) the free motion along which a stance would leave by itself, or None where it stays.

    Args:
        problem: the rover.
        motions: (n, d) of `free_motions`, d > 0.
        stiffness: (d, d) of `steadiness`.
    """
    values, vectors = np.linalg.eig(stiffness)
    worst = int(np.argmin(values.real))
    if values[worst].real >= UNSTEADY:
        return None
    along: Array = motions @ vectors[:, worst].real
    return along / max(float(np.max(np.abs(along))), 1e-12) * problem.unit


def undetermined_joints(problem: Problem, motions: Array, stiffness: Array) -> tuple[str, ...]:
    """Passive joints that move along motions nothing resists."""
    values, vectors = np.linalg.eig(stiffness)
    soft = np.abs(values) < 1e-9
    moving = np.abs(motions @ vectors[:, soft].real) if np.any(soft) else np.zeros((problem.n, 0))
    names = problem.rover.dof_names
    return tuple(
        names[column]
        for row, column in enumerate(problem.reduction.columns)
        if column >= 6 and np.any(moving[row] > 1e-6)
    )
