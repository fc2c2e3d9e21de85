"""Free coordinates: q = S z + b, with joints held and couplings satisfied for every z.

Pinocchio's own mimic joints are not safe (inertia and constraint Jacobians are wrong), so the tree is kept
whole and couplings are a linear map beside it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rover_pin.errors import MechanismError
from rover_pin.mechanism.coupling import Coupling
from rover_pin.numerics import Array, frozen


@dataclass(frozen=True)
class Reduction:
    """q = basis z + offset, with z the configuration's own entries at `columns`.

    Attributes:
        basis: (nv, n).
        offset: (nv,).
        columns: (n,) the entries of q that are free.
    """

    basis: Array
    offset: Array
    columns: tuple[int, ...]

    def expand(self, z: Array) -> Array:
        """(nv,) the configuration at free coordinates z (n,)."""
        q: Array = self.basis @ z + self.offset
        return q

    def pick(self, q: Array) -> Array:
        """(n,) the free coordinates of a configuration."""
        return q[list(self.columns)]


def reduce_coordinates(
    nv: int,
    couplings: Sequence[Coupling],
    held: Mapping[int, float],
    names: Mapping[int, str],
    *,
    tolerance: float = 1e-9,
) -> Reduction:
    """Eliminate held entries and couplings by Gauss-Jordan with pivoting.

    Args:
        nv: size of the configuration.
        couplings: linear rows on it.
        held: value per entry that does not move.
        names: name per entry, for messages.
        tolerance: what counts as a contradiction [rad or m].

    Raises:
        MechanismError: held values that contradict a coupling; the message has the residual.
    """
    open_columns = [column for column in range(nv) if column not in held]
    offset = np.zeros(nv)
    for column, value in held.items():
        offset[column] = value
    rows = np.array([coupling.row[open_columns] for coupling in couplings])
    rows = rows.reshape(len(couplings), len(open_columns))
    right = np.array([coupling.offset - coupling.row @ offset for coupling in couplings])
    owners = list(couplings)
    pivots: list[tuple[int, int]] = []
    used = np.zeros(len(owners), dtype=bool)
    for _ in owners:
        size = np.abs(rows)
        size[used] = 0.0
        if size.size == 0 or size.max() < 1e-12:
            break
        row, column = divmod(int(np.argmax(size)), size.shape[1])
        scale = rows[row, column]
        rows[row] /= scale
        right[row] /= scale
        for other in range(len(owners)):
            if other != row:
                factor = rows[other, column]
                rows[other] -= factor * rows[row]
                right[other] -= factor * right[row]
        used[row] = True
        pivots.append((row, column))
    for row, coupling in enumerate(owners):
        if not used[row] and abs(right[row]) > tolerance:
            involved = ", ".join(
                f"{joint} {offset[c]:.6g}" for joint, c in _held_joints(coupling, held, names)
            )
            raise MechanismError(
                f"held values contradict the coupling, residual {right[row]:.6g}",
                element=f"couplings.{coupling.name}",
                value=involved or None,
                cure="hold fewer of its joints, or at values that satisfy it",
            )
    dependent = {column for _, column in pivots}
    free = [index for index in range(len(open_columns)) if index not in dependent]
    basis = np.zeros((nv, len(free)))
    for place, index in enumerate(free):
        basis[open_columns[index], place] = 1.0
    for row, column in pivots:
        basis[open_columns[column]] = -rows[row, free]
        offset[open_columns[column]] = right[row]
    return Reduction(frozen(basis), frozen(offset), tuple(open_columns[index] for index in free))


def _held_joints(
    coupling: Coupling, held: Mapping[int, float], names: Mapping[int, str]
) -> list[tuple[str, int]]:
    return [(names[int(c)], int(c)) for c in np.flatnonzero(coupling.row) if int(c) in held]
