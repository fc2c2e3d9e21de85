"""The start of every settle: level, passive joints at the posture, loops closed, lowered onto flat ground."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.errors import MechanismError
from rover_pin.numerics import Array
from rover_pin.statics.problem import Problem

if TYPE_CHECKING:
    from rover_pin.terrain import Terrain

REACHING = 60
"""Steps in which springs and tracks are brought within reach."""

REACHED = 1e-4
"""m: what is within this of its stop is within reach; the fall does the rest."""


def level_start(problem: Problem, posture: Mapping[str, float], ground: Terrain) -> Array:
    """(n,) free coordinates of the rover held level, lowered until its first wheel touches `ground`.

    Raises:
        MechanismError: a loop that cannot close with the values that are held, a track or a spring that is
            too short or too long wherever the free joints go.
    """
    rover = problem.rover
    q = np.zeros(problem.model.nv)
    for joint, value in posture.items():
        q[rover.column[joint]] = value
    z = within_reach(problem, close_loops(problem, problem.reduction.pick(q)))
    for _ in range(3):
        gaps = problem.state(z, ground).slack[: len(rover.shapes)]
        z[0] -= np.min(gaps)
    return z


def within_reach(problem: Problem, z: Array) -> Array:
    """(n,) near z, where no spring is beyond its stop and no track shorter than its way: least steps.

    Raises:
        MechanismError: the free joints, within their limits, reach no such place; names the worst element.
    """
    elements = problem.one_sided
    joints = [i for i, column in enumerate(problem.reduction.columns) if column >= 6]
    columns = [problem.reduction.columns[i] for i in joints]
    lower, upper = problem.rover.lower[columns], problem.rover.upper[columns]
    best, nearest_z = -np.inf, z
    for _ in range(REACHING):
        at = problem.locate(z)
        slack = np.array([element.slack(at) for element in elements])
        worst = float(np.min(slack, initial=0.0))
        if worst > best:
            best, nearest_z = worst, z
        if worst >= -REACHED or not joints:
            break
        short = np.flatnonzero(slack < REACHED)
        rows = np.array([elements[i].slack_gradient(at) @ problem.reduction.basis for i in short])
        closure, closing = problem.loops(at)
        matrix = np.vstack([rows, closing])[:, joints]
        right = np.concatenate([REACHED - slack[short], -closure])
        step = np.linalg.lstsq(matrix, right, rcond=1e-8)[0]
        z = z.copy()
        move = step * min(1.0, 0.1 / max(float(np.max(np.abs(step), initial=0.0)), 1e-12))
        z[joints] = np.clip(z[joints] + move, lower, upper)
    if best < -REACHED:
        at = problem.locate(nearest_z)
        element = min(elements, key=lambda each: each.slack(at))
        what, cure = element.impossible
        raise MechanismError(
            f"{what}: {-element.slack(at):.4g} m are missing at best",
            file=problem.rover.sidecar_path,
            element=f"{element.kind}.{element.name}",
            cure=cure,
            problem=nearest_z,
        )
    return nearest_z


def close_loops(problem: Problem, z: Array) -> Array:
    """(n,) the nearest coordinates, base kept, at which every loop is closed: Newton with least steps.

    Raises:
        MechanismError: they do not close; the message names the worst loop and its residual.
    """
    loops = problem.rover.loops
    z = z.copy()
    if not loops:
        return z
    joints = [i for i, column in enumerate(problem.reduction.columns) if column >= 6]
    residual, jacobian = problem.loops(problem.locate(z))
    for _ in range(50):
        if np.max(np.abs(residual)) < 1e-12:
            break
        step = np.linalg.lstsq(jacobian[:, joints], -residual, rcond=1e-10)[0]
        size = float(np.max(np.abs(step), initial=0.0))
        z[joints] += step * min(1.0, 0.3 / max(size, 1e-12))
        residual, jacobian = problem.loops(problem.locate(z))
        if size < 1e-14:
            break
    first = 0
    for loop in loops:
        error = float(np.max(np.abs(residual[first : first + loop.size])))
        first += loop.size
        if not error <= loop.tolerance:
            raise MechanismError(
                f"the loop does not close with the joints that are held: residual {error:.4g} m",
                file=problem.rover.sidecar_path,
                element=f"loops.{loop.name}",
                cure="check its frames, hold fewer of its joints, or at values that close it",
                problem=z,
            )
    return z
