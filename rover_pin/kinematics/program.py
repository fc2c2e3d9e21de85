"""The program of one step: tasks as a cost, limits as equations, inequalities and bounds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rover_pin.errors import InputError
from rover_pin.kinematics.instant import Instant
from rover_pin.kinematics.kernels import add_cost, has_nan, is_finite
from rover_pin.kinematics.rows import Aim, Box, Rows
from rover_pin.numerics import Array


@dataclass(frozen=True)
class Program:
    """min 1/2 x'Hx + g'x subject to A x = b, low <= C x <= high, floor <= x <= ceiling; x = (v, slack).

    Attributes:
        nv: length of v; slacks of rows that bend follow it in x.
        hessian: (n, n).
        gradient: (n,).
        equations: A (e, n).
        right: b (e,).
        matrix: C (m, n).
        low: (m,).
        high: (m,).
        floor: (n,).
        ceiling: (n,).
        equation_names: (e,).
        row_names: (m,).
        bending: (n - nv,) row of each slack.
        pins: (e,) the coordinate that an equation gives its rate, -1 where it binds several.
    """

    nv: int
    hessian: Array
    gradient: Array
    equations: Array
    right: Array
    matrix: Array
    low: Array
    high: Array
    floor: Array
    ceiling: Array
    equation_names: tuple[str, ...]
    row_names: tuple[str, ...]
    bending: NDArray[np.int64]
    pins: NDArray[np.int64]


def assemble(
    at: Instant, aims: Sequence[Aim], blocks: Sequence[Rows], boxes: Sequence[Box], dt: float, damping: Array
) -> Program:
    """The program of one step.

    An equation that bends is a cost; an inequality that bends has a slack of its own.

    Args:
        at: the instant.
        aims: of the tasks.
        blocks: rows of the limits.
        boxes: bounds on coordinates.
        dt: s.
        damping: (nv,) weight of each coordinate's own rate squared: chooses among motions equal else.
    """
    nv = len(damping)
    equal, between = [], []
    soft: list[float] = []
    names: list[str] = []
    row_names: list[str] = []
    pins: list[int] = []
    costs = [(aim.matrix, aim.target, aim.weight) for aim in aims]
    for block in blocks:
        if block.equation and block.bend < np.inf:
            costs.append((block.matrix, block.low, np.full(len(block.low), block.bend)))
        elif block.equation:
            equal.append((block.matrix, block.low))
            names.extend(block.names)
            pins.extend(block.pins or [-1] * len(block.names))
        else:
            between.append((block.matrix, block.low, block.high))
            soft.extend([block.bend] * len(block.names))
            row_names.extend(block.names)
    bend = np.array(soft)
    bending = np.flatnonzero(bend < np.inf)
    n = nv + len(bending)
    hessian, gradient = _cost(n, nv, costs, damping)
    hessian[range(nv, n), range(nv, n)] = bend[bending]
    equations, right = _stacked(n, nv, [rows for rows, _ in equal], [side for _, side in equal])
    matrix, low = _stacked(n, nv, [rows for rows, _, _ in between], [side for _, side, _ in between])
    high = np.concatenate([side for _, _, side in between]) if between else np.zeros(0)
    matrix[bending, range(nv, n)] = 1.0
    floor, ceiling = _bounds(at, n, nv, boxes, dt)
    return Program(
        nv, hessian, gradient, equations, right, matrix, low, high, floor, ceiling, tuple(names),
        tuple(row_names), bending, np.array(pins, dtype=np.int64),
    )  # fmt: skip


def _cost(
    n: int, nv: int, costs: Sequence[tuple[Array, Array, Array]], damping: Array
) -> tuple[Array, Array]:
    hessian, gradient = np.zeros((n, n)), np.zeros(n)
    hessian[range(nv), range(nv)] = damping
    if costs:
        rows = np.concatenate([matrix for matrix, _, _ in costs])
        targets = np.concatenate([target for _, target, _ in costs])
        weights = np.concatenate([weight for _, _, weight in costs])
        add_cost(rows, targets, weights, hessian, gradient)
    return hessian, gradient


def _stacked(n: int, nv: int, matrices: Sequence[Array], sides: Sequence[Array]) -> tuple[Array, Array]:
    side = np.concatenate(sides) if sides else np.zeros(0)
    matrix = np.zeros((len(side), n))
    if sides:
        np.concatenate(matrices, out=matrix[:, :nv])
    return matrix, side


def _bounds(at: Instant, n: int, nv: int, boxes: Sequence[Box], dt: float) -> tuple[Array, Array]:
    floor, ceiling = np.full(n, -np.inf), np.full(n, np.inf)
    for box in boxes:
        low, high = box.box(at, dt)
        np.maximum(floor[:nv], low, out=floor[:nv])
        np.minimum(ceiling[:nv], high, out=ceiling[:nv])
    return floor, ceiling


def check(program: Program) -> None:
    """Refuse what a solver would spin on.

    Raises:
        InputError: an entry that is not finite, or a side that is no number; named by its row.
    """
    p = program
    numbers = (p.hessian.ravel(), p.gradient, p.equations.ravel(), p.right, p.matrix.ravel())
    sides = (p.low, p.high, p.floor, p.ceiling)
    if all(is_finite(values) for values in numbers) and not any(has_nan(values) for values in sides):
        return
    rows = np.isfinite(program.equations).all(axis=1) & np.isfinite(program.right)
    between = np.isfinite(p.matrix).all(axis=1) & ~np.isnan(p.low) & ~np.isnan(p.high)
    bad = [name for name, good in zip(program.equation_names, rows, strict=True) if not good]
    bad += [name for name, good in zip(program.row_names, between, strict=True) if not good]
    raise InputError(
        "has an entry that is no finite number",
        element=bad[0] if bad else "a task or a bound",
        cure="a rate, a measured value or a limit given to this step is NaN or infinite",
        problem=program,
    )
