"""Cases in which a wheel touches in several places: their contacts' loads are not in the dataset."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rover_pin.mechanism import Reduction
from rover_pin.statics.problem import Problem
from rover_pin.viz.page.measured import worst_cases

if TYPE_CHECKING:
    import xarray as xr

    from rover_pin.numerics import Array
    from rover_pin.rover import Rover
    from rover_pin.terrain import Terrain

WINDOW = 1e-5
"""m: what is so near to touching as the wheel's nearest place touches too, as in `settle`."""

BASE = ("x_m", "y_m", "z_m", "yaw_rad", "pitch_rad", "roll_rad")
LOOKED_AT = 4000
"""Worst cases that are looked through: up to a millisecond each."""

SETTLED_ANEW = 200
"""Cases at most that a page has settled anew for this: up to 30 ms each."""


def exact_cases(dataset: xr.Dataset, rover: Rover, terrain: Terrain, worst: int = 10) -> list[int]:
    """Cases whose stances a page should be given: the worst, and where a wheel touches in several places.

    The latter are looked for among the LOOKED_AT worst, and SETTLED_ANEW of them told, where no parameter of
    the rover varies.

    Args:
        dataset: of a Study.
        rover: the study's.
        terrain: the study's.
        worst: how many of the worst.
    """
    ranked = worst_cases(dataset, LOOKED_AT)
    if any("parameter" in values.attrs for values in dataset.data_vars.values()):
        return ranked[:worst]
    found = several(dataset, rover, terrain, ranked)[:SETTLED_ANEW]
    return list(dict.fromkeys([*ranked[:worst], *found]))


def several(dataset: xr.Dataset, rover: Rover, terrain: Terrain, among: list[int]) -> list[int]:
    """Those of the cases `among` in which a wheel touches in more than one place.

    Args:
        dataset: of a Study whose parameters do not vary.
        rover: the study's.
        terrain: the study's.
        among: numbers of settled cases.
    """
    if not among or not rover.shapes:
        return []
    rows = {name: np.asarray(dataset[name].values)[among] for name in BASE}
    joints = np.asarray(dataset["joint_rad"].values)[among]
    q = np.column_stack([*rows.values(), *(np.zeros(len(among)) for _ in rover.model.names[2:])])
    columns = {str(name): k + len(BASE) for k, name in enumerate(rover.model.names[2:])}
    for k, name in enumerate(dataset["joint"].values):
        q[:, columns[str(name)]] = joints[:, k]
    every = Reduction(np.eye(rover.model.nv), np.zeros(rover.model.nv), tuple(range(rover.model.nv)))
    problem = Problem(rover, every, 0.0)  # all of q is free, and only contacts are asked for
    return [case for case, each in zip(among, q, strict=True) if _most(problem, terrain, each) > 1]


def _most(problem: Problem, terrain: Terrain, q: Array) -> int:
    """The most places in which one wheel touches, at the configuration q (nv,)."""
    owners, contacts = problem.search(problem.locate(q), terrain, WINDOW)
    return int(np.bincount(owners[contacts[:, 0] < WINDOW], minlength=1).max())
