"""Linear complementarity: find n >= 0 with w = M n + q >= 0 and n . w = 0."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rover_pin.numerics import Array, formula


@formula
def lemke(matrix: Array, vector: Array, pivots: int) -> tuple[Array, bool]:
    """Solve LCP(M, q) by Lemke's complementary pivoting (Cottle, Pang and Stone, section 4.4).

    M need not be symmetric: on slopes the direction of a contact's force is not that of its gap's gradient.
    Among rows that tie in the ratio test the one with the largest pivot leaves, which keeps the tableau well
    conditioned where supports are redundant; a ray or too many pivots is a failure, never an answer.

    Args:
        matrix: M, (m, m).
        vector: q, (m,).
        pivots: most pivots before giving up.

    Returns:
        n, (m,), and whether it solves the problem.
    """
    m = vector.shape[0]
    answer = np.zeros(m)
    lowest = 0
    for i in range(m):
        if vector[i] < vector[lowest]:
            lowest = i
    if m == 0 or vector[lowest] >= 0.0:
        return answer, True
    # Columns: w (0..m-1), n (m..2m-1), the artificial variable (2m), right-hand side (2m+1).
    table = np.zeros((m, 2 * m + 2))
    basis = np.zeros(m, dtype=np.int64)
    for i in range(m):
        table[i, i] = 1.0
        for j in range(m):
            table[i, m + j] = -matrix[i, j]
        table[i, 2 * m] = -1.0
        table[i, 2 * m + 1] = vector[i]
        basis[i] = i
    row = lowest
    entering = 2 * m
    for _ in range(pivots):
        leaving = basis[row]
        pivot = table[row, entering]
        for k in range(2 * m + 2):
            table[row, k] /= pivot
        for i in range(m):
            if i != row:
                factor = table[i, entering]
                if factor != 0.0:
                    for k in range(2 * m + 2):
                        table[i, k] -= factor * table[row, k]
        basis[row] = entering
        if leaving == 2 * m:
            for i in range(m):
                if basis[i] >= m:
                    answer[basis[i] - m] = max(table[i, 2 * m + 1], 0.0)
            return answer, True
        entering = leaving + m if leaving < m else leaving - m
        row = _leaving_row(table, basis, entering)
        if row < 0:
            return answer, False
    return answer, False


@formula
def _leaving_row(table: Array, basis: NDArray[np.int64], entering: int) -> int:
    """Ratio test; the artificial variable leaves whenever it may, else the largest pivot among ties."""
    m = table.shape[0]
    last = table.shape[1] - 1
    best = np.inf
    largest = 0.0
    for i in range(m):
        largest = max(largest, abs(table[i, entering]))
    small = 1e-11 * max(largest, 1e-300)
    for i in range(m):
        if table[i, entering] > small:
            best = min(best, max(table[i, last], 0.0) / table[i, entering])
    if best == np.inf:
        return -1
    slack = 1e-10 * (1.0 + abs(best))
    chosen = -1
    for i in range(m):
        if table[i, entering] > small and max(table[i, last], 0.0) / table[i, entering] <= best + slack:
            if basis[i] == 2 * m:
                return i
            if chosen < 0 or table[i, entering] > table[chosen, entering]:
                chosen = i
    return chosen
