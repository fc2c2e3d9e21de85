"""Which rows of an infeasible program fight.

Farkas: M v <= s has no solution just where some y >= 0 has M'y = 0 and s'y = -1. A basic solution y has a
support that is a smallest fighting set: leave one of its rows out and the others agree (Gleeson and Ryan,
"Identifying minimally infeasible subsystems of inequalities", ORSA J. Computing 2, 1990). Lawson and Hanson's
non-negative least squares ends on basic solutions, and on a residual of zero where there is one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import nnls

from rover_pin.kinematics.program import Program
from rover_pin.numerics import Array

SMALL = 1e-9
"""m/s or rad/s: people read 0."""

PROOF = 1e-9
"""Share of its largest term that M'y may differ from zero by, and of the sides' that s'y must exceed."""


@dataclass(frozen=True)
class Side:
    """One side of a row that fights.

    Attributes:
        name: of the row or bound.
        says: `=`, `>=` or `<=`, with the number [m/s or rad/s].
    """

    name: str
    says: str

    def __str__(self) -> str:
        """`rolling of LF = 0`."""
        return f"{self.name} {self.says}"


def conflict(program: Program, bound_names: dict[tuple[int, bool], str]) -> tuple[Side, ...]:
    """A smallest set of rows that cannot hold together; nothing where the rows agree or no proof is found.

    Args:
        program: of a step.
        bound_names: per coordinate and whether its ceiling is meant, what people call that bound.
    """
    sides, matrix, right = _one_sided(program, bound_names)
    if not len(right):
        return ()
    scale = np.maximum(np.linalg.norm(matrix, axis=1), 1e-12)
    rows, limits = matrix / scale[:, None], right / scale
    size = float(np.max(np.abs(limits), initial=0.0)) or 1.0
    system = np.vstack([rows.T, limits[None, :] / size])
    wanted = np.zeros(len(system))
    wanted[-1] = -1.0
    try:
        y, _ = nnls(system, wanted, maxiter=20 * system.shape[1])
    except RuntimeError:
        return ()
    if not _proves(rows, limits / size, y):
        return ()
    taking = np.flatnonzero(y > 1e-9 * np.max(y))
    order = taking[np.argsort(-y[taking], kind="stable")]
    named = dict.fromkeys(sides[i] for i in order)
    return tuple(named)


def _proves(rows: Array, limits: Array, y: Array) -> bool:
    total = float(np.sum(y))
    if not np.isfinite(total) or total <= 0.0:
        return False
    left = float(np.max(np.abs(rows.T @ y)))
    return left <= PROOF * max(1.0, total) and float(limits @ y) < -0.5


def _one_sided(program: Program, names: dict[tuple[int, bool], str]) -> tuple[list[Side], Array, Array]:
    """Every row as `<=`: equations twice, open sides left out, rows that bend left out."""
    nv = program.nv
    hard = np.ones(len(program.low), dtype=bool)
    hard[program.bending] = False
    unit = np.eye(nv)
    parts: list[tuple[Side, Array, float]] = []
    for name, row, side in zip(program.equation_names, program.equations[:, :nv], program.right, strict=True):
        said = Side(name, f"= {_number(side)}")
        parts += [(said, row, float(side)), (said, -row, -float(side))]
    for i in np.flatnonzero(hard).tolist():
        row = program.matrix[i, :nv]
        parts += _both(program.row_names[i], program.row_names[i], row, program.low[i], program.high[i])
    for i in range(nv):
        low, high = program.floor[i], program.ceiling[i]
        parts += _both(names.get((i, False), ""), names.get((i, True), ""), unit[i], low, high)
    sides = [side for side, _, _ in parts]
    matrix = np.array([row for _, row, _ in parts]).reshape(-1, nv)
    return sides, matrix, np.array([right for _, _, right in parts])


def _both(
    low_name: str, high_name: str, row: Array, low: float, high: float
) -> list[tuple[Side, Array, float]]:
    parts = []
    if np.isfinite(low):
        parts.append((Side(low_name, f">= {_number(low)}"), -row, -float(low)))
    if np.isfinite(high):
        parts.append((Side(high_name, f"<= {_number(high)}"), row, float(high)))
    return parts


def _number(value: float) -> str:
    return f"{0.0 if abs(value) < SMALL else value:.4g}"
