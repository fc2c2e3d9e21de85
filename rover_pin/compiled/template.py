"""A posture on level ground, from the plain path: which supports carry there, and where it starts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rover_pin.compiled.posed import FREE_OF_BASE
from rover_pin.errors import InputError, SolverError
from rover_pin.numerics import Array
from rover_pin.statics.asked import held_values
from rover_pin.statics.ground import Footing
from rover_pin.statics.held import held_joints
from rover_pin.statics.level import on_level
from rover_pin.statics.problem import Problem
from rover_pin.statics.stance import Status

if TYPE_CHECKING:
    from rover_pin.rover import Rover


Posture = str | Mapping[str, float] | None
"""What `settle` takes for a posture."""


@dataclass(frozen=True)
class Template:
    """What cases of one posture share.

    Attributes:
        problem: the plain path's, base at the origin.
        footing: its stance on level ground.
        held: joints that are held.
        values: (nv,) configuration where it is held, zero elsewhere.
    """

    problem: Problem
    footing: Footing
    held: tuple[str, ...]
    values: Array

    def support(self, records: NDArray[np.void]) -> None:
        """Write the supports and where Newton starts from into machines (g,) of `posed_dtype`."""
        active, loops = self.footing.active, self.footing.loops
        records["n_active"], records["n_held_loops"] = len(active), len(loops)
        records["active"][:, : len(active)] = active
        records["held_loops"][:, : len(loops)] = loops
        records["sign"] = self.footing.sign
        records["start"][:, : len(self.footing.z)] = self.footing.z


def template_of(
    rover: Rover,
    posture: Posture,
    joints: Sequence[str],
    locks: tuple[str, ...],
    gravity: float,
    *,
    designs: bool = False,
) -> Template | None:
    """The template of a posture, or None where the plain path has to answer (it also words the errors).

    Args:
        rover: the rover.
        posture: as for `settle`.
        joints: further joints that are held, here at the posture's values.
        locks: passive joints that are locked.
        gravity: m/s2.
        designs: whether parameters vary.
    """
    if (joints or designs) and isinstance(posture, Mapping) and "clearance" in posture:
        return None  # the goal is solved anew for each value
    try:
        free, _ = held_values(rover, posture, {}, locks, gravity)
        values, locked = held_values(rover, posture, {name: free[name] for name in joints}, locks, gravity)
        problem, footing = on_level(rover, values, locked, gravity)
    except (InputError, SolverError):
        return None
    held = len(footing.active) + len(footing.loops)
    if (
        footing.status is not Status.SETTLED
        or problem.reduction.columns[:3] != FREE_OF_BASE
        or held > problem.n
    ):
        return None
    q = np.zeros(problem.model.nv)
    for joint, value in values.items():
        q[rover.column[joint]] = value
    return Template(problem, footing, held_joints(rover, locked), q)
