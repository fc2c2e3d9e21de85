"""Newton with central differences, damped and bounded: no project code."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np


def newton(
    f: Callable[[np.ndarray], np.ndarray], x: np.ndarray, step: np.ndarray, reach: np.ndarray
) -> np.ndarray | None:
    """A root of f near x, to the rounding of f; None where it does not arrive.

    Args:
        f: (n,) residuals, scaled so that 1e-9 is nothing.
        x: (n,) start.
        step: (n,) of the differences.
        reach: (n,) most that an entry may change in a step.
    """
    r = f(x)
    for _ in range(60):
        size = np.max(np.abs(r))
        if not np.isfinite(size):
            return None
        columns = [
            (f(x + h * e) - f(x - h * e)) / (2.0 * h) for h, e in zip(step, np.eye(len(x)), strict=True)
        ]
        try:
            dx = np.linalg.solve(np.column_stack(columns), -r)
        except np.linalg.LinAlgError:
            return None
        dx /= max(1.0, np.max(np.abs(dx) / reach))
        share = 1.0
        while share > 1e-4:
            tried = f(x + share * dx)
            if np.all(np.isfinite(tried)) and (np.max(np.abs(tried)) < size or size < 1e-8):
                break
            share /= 2.0
        else:
            return x if size < 1e-8 else None
        x, r = x + share * dx, tried
        if size < 1e-9 and np.max(np.abs(dx)) < 1e-9:
            return x
    return x if np.max(np.abs(r)) < 1e-8 else None
