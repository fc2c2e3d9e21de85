"""From the headings of a cell to the cell: the worst and the best that settle, the commonest failure."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rover_pin.numerics import Array


def best_and_worst(value: Array, settled: NDArray[np.bool_], yaw: Array, better: str) -> dict[str, Array]:
    """The worst and the best value over the settled headings of each cell; the first heading of equal ones.

    Args:
        value: (..., headings) of the measure.
        settled: (..., headings) which of them count.
        yaw: (headings,) rad.
        better: `high` or `low`.

    Returns:
        `worst`, `best`, `worst_yaw_rad`, `best_yaw_rad` (...), NaN where no heading settles.
    """
    sign = 1.0 if better == "high" else -1.0
    any_settled = settled.any(axis=-1)
    first = settled.argmax(axis=-1)
    oriented = sign * value
    found: dict[str, Array] = {}
    for name, pick, other in (("worst", np.argmin, np.inf), ("best", np.argmax, -np.inf)):
        index = pick(np.where(settled, oriented, other), axis=-1)
        chosen = np.take_along_axis(settled, index[..., None], axis=-1)[..., 0]
        index = np.where(chosen, index, first)  # where every settled heading is as bad as can be
        values = np.take_along_axis(value, index[..., None], axis=-1)[..., 0]
        found[name] = np.where(any_settled, values, np.nan)
        found[f"{name}_yaw_rad"] = np.where(any_settled, yaw[index], np.nan)
    return found


def commonest_failure(outcome: NDArray[np.int64], kinds: int) -> NDArray[np.int8]:
    """The commonest outcome of each cell beside 0, or 0 where there is no other; the least of equal ones.

    Args:
        outcome: (..., headings) numbers from 0 (settled) to before `kinds`.
        kinds: how many outcomes there are.
    """
    counts = np.stack([np.sum(outcome == k, axis=-1) for k in range(1, kinds)], axis=-1)
    return np.where(counts.any(axis=-1), counts.argmax(axis=-1) + 1, 0).astype(np.int8)
