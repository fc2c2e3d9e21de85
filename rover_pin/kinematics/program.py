"""The program of one step: tasks as a cost, limits as equations, inequalities and bounds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from rover_pin.errors import InputError
from rover_pin.kinematics.instant import Instant
from rover_pin.kinematics.kernels import add_cost
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
        equation_blocks: names of the equations, block by block.
        row_blocks: names of the rows, block by block.
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
    equation_blocks: tuple[tuple[str, ...], ...]
    row_blocks: tuple[tuple[str, ...], ...]
    bending: NDArray[np.int64]
    pins: NDArray[np.int64]

    @property
    def equation_names(self) -> tuple[str, ...]:
        """(e,)."""
        return tuple(chain.from_iterable(self.equation_blocks))

    @property
    def row_names(self) -> tuple[str, ...]:
        """(m,)."""
        return tuple(chain.from_iterable(self.row_blocks))


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
    equal = [block for block in blocks if block.equation and block.bend == math.inf]
    between = [block for block in blocks if not block.equation]
    soft = [
        Aim(b.matrix, b.low, np.full(len(b.low), b.bend)) for b in blocks if b.equation and b.bend < math.inf
    ]
    bends: list[float] = []
    if any(block.bend < math.inf for block in between):
        bends = [block.bend for block in between for _ in block.names]
    bending = np.array([i for i, bend in enumerate(bends) if bend < math.inf], dtype=np.int64)
    n = nv + len(bending)
    hessian, gradient = np.zeros((n, n)), np.zeros(n)
    diagonal = hessian.ravel()[:: n + 1]
    diagonal[:nv] = damping
    for aim in (*aims, *soft):
        add_cost(aim.matrix, aim.target, aim.weight, hessian, gradient)
    equations, right = _stacked(n, nv, equal)
    matrix, low = _stacked(n, nv, between)
    high = np.concatenate([block.high for block in between]) if between else np.zeros(0)
    if len(bending):
        diagonal[nv:] = [bends[i] for i in bending]
        matrix[bending, range(nv, n)] = 1.0
    floor, ceiling = _bounds(at, n, nv, boxes, dt)
    pins = [pin for block in equal for pin in (block.pins or (-1,) * len(block.names))]
    return Program(
        nv, hessian, gradient, equations, right, matrix, low, high, floor, ceiling,
        tuple(block.names for block in equal), tuple(block.names for block in between), bending,
        np.array(pins, dtype=np.int64),
    )  # fmt: skip


def _stacked(n: int, nv: int, blocks: Sequence[Rows]) -> tuple[Array, Array]:
    """Matrices and low sides, with room for slacks."""
    if not blocks:
        return np.zeros((0, n)), np.zeros(0)
    side = np.concatenate([block.low for block in blocks])
    if n == nv:
        return np.concatenate([block.matrix for block in blocks]), side
    matrix = np.zeros((len(side), n))
    np.concatenate([block.matrix for block in blocks], out=matrix[:, :nv])
    return matrix, side


def _bounds(at: Instant, n: int, nv: int, boxes: Sequence[Box], dt: float) -> tuple[Array, Array]:
    floor, ceiling = np.empty(n), np.empty(n)
    if not boxes or n > nv:
        floor.fill(-np.inf)
        ceiling.fill(np.inf)
    for i, box in enumerate(boxes):
        low, high = box.box(at, dt)
        if i == 0:
            floor[:nv], ceiling[:nv] = low, high
        else:
            np.maximum(floor[:nv], low, out=floor[:nv])
            np.minimum(ceiling[:nv], high, out=ceiling[:nv])
    return floor, ceiling


def refuse(program: Program) -> None:
    """Say which entry of a program is no number.

    Raises:
        InputError: named by its row.
    """
    p = program
    rows = np.isfinite(p.equations).all(axis=1) & np.isfinite(p.right)
    between = np.isfinite(p.matrix).all(axis=1) & ~np.isnan(p.low) & ~np.isnan(p.high)
    bad = [name for name, good in zip(p.equation_names, rows, strict=True) if not good]
    bad += [name for name, good in zip(p.row_names, between, strict=True) if not good]
    raise InputError(
        "has an entry that is no finite number",
        element=bad[0] if bad else "a task or a bound",
        cure="a rate, a measured value or a limit given to this step is NaN or infinite",
        problem=program,
    )
