"""Which supports of a sprung rover carry: found by changing all at once and landing again."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from rover_pin.numerics import Array
from rover_pin.statics.newton import Landing, land
from rover_pin.statics.problem import Integers, Problem

if TYPE_CHECKING:
    from rover_pin.terrain import Terrain

OPEN = -2e-7
"""m or rad: a gap below this is a penetration, to be resolved by another set of supports."""

NOT_NEGATIVE = -1e-9
"""Share of the weight below which a load counts as negative."""

JUMP = 0.2
"""Share of the wheels' span, and rad: a motion larger than this over a least step leaves the branch."""

MOST_CHANGES = 6
"""Sets of supports tried."""


class Adapted(NamedTuple):
    """A landing that stands, and the supports that carry there."""

    landing: Landing
    active: Integers


def stands(problem: Problem, landing: Landing, sign: float) -> bool:
    """Whether a landing is on the branch: no negative load, no penetration, orientation kept."""
    return bool(
        landing.sign == sign
        and np.min(landing.multipliers, initial=0.0) >= NOT_NEGATIVE * problem.weight
        and np.min(landing.state.slack, initial=0.0) >= OPEN
    )


def adapted(
    problem: Problem, z: Array, terrain: Terrain, active: Integers, loops: Integers, landing: Landing
) -> Adapted | None:
    """The stance of a sprung rover on the supports that carry at the place.

    Supports that would pull are dropped, rows that are violated taken up, and Newton lands again: the
    primal-dual active set method (Hintermueller, Ito and Kunisch 2002). Springs hold the rover while supports
    change, so that it stays on its branch; whether the stance is a steady one is for the caller to see.

    Args:
        problem: the rover.
        z: (n,) where it began, which it may not leave by more than twice `JUMP`.
        terrain: what it stands on.
        active: supports taken as carrying.
        loops: independent loop rows.
        landing: on those supports, which do not all carry.
    """
    for _ in range(MOST_CHANGES):
        carrying = landing.multipliers >= NOT_NEGATIVE * problem.weight
        kept = np.array([row for row in active if carrying[row]], dtype=np.int64)
        violated = np.flatnonzero(landing.state.slack < OPEN)
        active = np.union1d(kept, violated).astype(np.int64)
        again = land(problem, landing.z, terrain, active, loops, reach=JUMP * 2.0, iterations=9)
        if again is None or np.max(np.abs(again.z - z) / problem.unit) > JUMP * 2.0:
            return None
        landing = again
        if stands(problem, landing, landing.sign):
            return Adapted(landing, active)
    return None
