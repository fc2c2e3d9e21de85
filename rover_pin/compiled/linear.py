"""Small dense systems inside compiled loops.

LAPACK's entry costs more than these systems of a few unknowns take, and cannot be inlined.
"""

from __future__ import annotations

from rover_pin.numerics import Array, formula, inlined

SINGULAR = 1e-12
"""A pivot below this share of the largest entry of its column as given: no answer."""


@inlined
def eliminate(a: Array, b: Array, n: int) -> float:
    """Solve a x = b by Gauss with row pivoting.

    Args:
        a: (>= n, >= n), destroyed.
        b: (>= n,), receives x.
        n: unknowns.

    Returns:
        The sign of a's determinant, 0 where a is singular.
    """
    sign = 1.0
    for c in range(n):
        best = c
        largest = abs(a[c, c])
        for r in range(c + 1, n):
            if abs(a[r, c]) > largest:
                best, largest = r, abs(a[r, c])
        if not largest > SINGULAR:
            return 0.0
        if best != c:
            for k in range(c, n):
                a[c, k], a[best, k] = a[best, k], a[c, k]
            b[c], b[best] = b[best], b[c]
            sign = -sign
        if a[c, c] < 0.0:
            sign = -sign
        inverse = 1.0 / a[c, c]
        for r in range(c + 1, n):
            f = a[r, c] * inverse
            if f != 0.0:
                for k in range(c + 1, n):
                    a[r, k] -= f * a[c, k]
                b[r] -= f * b[c]
    for c in range(n - 1, -1, -1):
        total = b[c]
        for k in range(c + 1, n):
            total -= a[c, k] * b[k]
        b[c] = total / a[c, c]
    return sign


@formula
def null_basis(rows: Array, m: int, n: int, basis: Array) -> int:
    """A basis of the motions that m independent rows leave free, by Gauss-Jordan with full pivoting.

    Args:
        rows: (>= m, n), destroyed.
        m: rows.
        n: columns.
        basis: (n, >= n - m) receives the basis in its columns.

    Returns:
        n - m, or -1 where the rows are not independent.
    """
    order = [0] * n
    for c in range(n):
        order[c] = c
    for r in range(m):
        best_i, best_j, largest = r, r, 0.0
        for i in range(r, m):
            for j in range(r, n):
                if abs(rows[i, j]) > largest:
                    best_i, best_j, largest = i, j, abs(rows[i, j])
        if not largest > 1e-9:
            return -1
        for j in range(n):
            rows[r, j], rows[best_i, j] = rows[best_i, j], rows[r, j]
        for i in range(m):
            rows[i, r], rows[i, best_j] = rows[i, best_j], rows[i, r]
        order[r], order[best_j] = order[best_j], order[r]
        inverse = 1.0 / rows[r, r]
        for j in range(n):
            rows[r, j] *= inverse
        for i in range(m):
            if i != r:
                f = rows[i, r]
                for j in range(n):
                    rows[i, j] -= f * rows[r, j]
    for d in range(n - m):
        for c in range(n):
            basis[c, d] = 0.0
        basis[order[m + d], d] = 1.0
        for r in range(m):
            basis[order[r], d] = -rows[r, m + d]
    return n - m


@formula
def is_positive(a: Array, n: int, least: float) -> bool:
    """Whether the symmetric part of `a` less `least` times the identity is positive definite (Cholesky).

    Every eigenvalue of `a` then has a real part above `least`; the reverse does not hold. `a` is destroyed.
    """
    for i in range(n):
        for j in range(i + 1):
            a[i, j] = 0.5 * (a[i, j] + a[j, i])
        a[i, i] -= least
    for j in range(n):
        d = a[j, j]
        for k in range(j):
            d -= a[j, k] * a[j, k]
        if not d > 0.0:
            return False
        root = d**0.5
        a[j, j] = root
        for i in range(j + 1, n):
            s = a[i, j]
            for k in range(j):
                s -= a[i, k] * a[j, k]
            a[i, j] = s / root
    return True
