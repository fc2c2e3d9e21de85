"""What a geometry of Polibot is held against: the tables' model columns and the statements that were used.

Each target is a number with half of its last digit; of a statement in words, with what the words leave
open. That W6 lifts at -0.15 % or +0.7 % is read off a sweep of unknown steps: a tenth is left open. A
geometry fits where every target is met to that.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rover_pin.analysis.papers.polibot.planar import STATE, Inputs, Solved
from rover_pin.analysis.papers.polibot.tables import HEIGHT, PAYLOAD, TABLE_6, TABLE_7, TABLE_8, WHOLE_MASS
from rover_pin.numerics import Array

BASELINE, PAYLOADED, FRONT, REAR, MASS_20, MASS_65, SHORT_TRACK, LONG_ARM = range(8)
MASS, TRACK, FRONT_ARM = WHOLE_MASS / 2.0, 2026.0, 198.0
LEAST_LOAD = 5.0
"""N: what every road wheel carries at rest at least; the paper says that all four carry."""

TABLE_6_STATE = np.array([row[1] for row in TABLE_6.values()])


@dataclass(frozen=True)
class Target:
    """One number of the paper.

    Attributes:
        name: as a person reads it.
        case: it is of.
        what: of STATE.
        value: mm, deg or N.
        half: what is left open on both sides.
        less: a case whose value is subtracted, -1 for none.
        least: whether only values below it count as missing it.
    """

    name: str
    case: int
    what: str
    value: float
    half: float
    less: int = -1
    least: bool = False


def inputs() -> Inputs:
    """The eight cases."""
    mass, track, arm = np.full(8, MASS), np.full(8, TRACK), np.full(8, FRONT_ARM)
    ground = np.zeros((4, 8))
    mass[PAYLOADED] *= 1.0 + PAYLOAD / WHOLE_MASS
    mass[MASS_20] *= 1.20
    mass[MASS_65] *= 1.65
    track[SHORT_TRACK] *= 1.0 - 0.0015
    arm[LONG_ARM] *= 1.0 + 0.007
    ground[0, FRONT] = ground[3, REAR] = 1e3 * HEIGHT
    return Inputs(mass, track, arm, ground)


def _tables() -> list[Target]:
    halves = {"theta": 0.005}  # of the last digit; 0.05 elsewhere
    cases = ((BASELINE, "Table 6", TABLE_6), (PAYLOADED, "Table 7", TABLE_7),
             (FRONT, "Table 8, W3", TABLE_8["W3"]), (REAR, "Table 8, W6", TABLE_8["W6"]))  # fmt: skip
    return [
        Target(f"{table}: {what}", case, what, model, halves.get(what, 0.05))
        for case, table, rows in cases
        for what, (_, model, _) in rows.items()
    ]


TARGETS = (
    *_tables(),
    Target("Fig. 13: pitch at +20 % mass, less that at rest", MASS_20, "theta", -0.5, 0.1, less=BASELINE),
    Target("Fig. 14: tension at +65 % mass", MASS_65, "T", 15.0, 15.0),
    Target("Fig. 17: load of W6 at -0.15 % track", SHORT_TRACK, "N6", 0.0, 3.5),
    Target("Fig. 18: load of W6 at +0.7 % front arm", LONG_ARM, "N6", 0.0, 3.5),
    *(
        Target(f"rest: least load of W{k}", BASELINE, f"N{k}", LEAST_LOAD, 1.0, least=True)
        for k in (3, 4, 5, 6)
    ),
)
"""The last four count only where a load is less. In the two before them, 3.5 N are about a tenth of the
change."""

TABLES = 13
"""How many of them, from the first on, are numbers of Tables 6 to 8."""


def first_guess() -> Array:
    """(15, 8) Table 6 in every case, with forces of a size that carries the weight."""
    pose = np.concatenate([TABLE_6_STATE[:2], np.radians(TABLE_6_STATE[2:])])
    state = np.concatenate([pose, np.full(4, MASS * 9.81 / 4.0), [250.0, 250.0, 100.0, 250.0]])
    return np.tile(state[:, None], (1, 8))


def misses(solved: Solved) -> tuple[Array, Array]:
    """(t,) by how much each target is missed, over what it leaves open; (t, l) derivatives by the lengths."""
    values, slopes = [], []
    for target in TARGETS:
        row = STATE.index(target.what)
        scale = 180.0 / np.pi if target.what.startswith("theta") else 1.0
        value, slope = solved.state[row, target.case], solved.by_length[row, :, target.case]
        if target.less >= 0:
            value = value - solved.state[row, target.less]
            slope = slope - solved.by_length[row, :, target.less]
        missed = (scale * value - target.value) / target.half
        open_ = target.least and missed > 0.0
        values.append(0.0 if open_ else missed)
        slopes.append(0.0 * slope if open_ else scale * slope / target.half)
    return np.array(values), np.array(slopes)
