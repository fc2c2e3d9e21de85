"""Every set of contact forces that is in equilibrium, as a particular one plus a basis."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from rover_pin.numerics import Array

if TYPE_CHECKING:
    from rover_pin.statics.friction_problem import Rows

RANK_TOLERANCE = 1e-9
"""Singular values below this share of the largest count as none (rows of unit length)."""

BALANCE_TOLERANCE = 1e-6
"""Largest share of the weight that may stay unbalanced."""


@dataclass(frozen=True)
class ForceSpace:
    """Solutions of the equilibrium, forces in contact frames and in units of the weight.

    Every solution is u = particular + basis @ y. Its first 3k entries are normal, rolling and lateral
    force of each contact (the rolling one of a free wheel is zero), the rest the one-sided multipliers,
    each in a unit of its own. Multipliers that bind both ways are eliminated.

    Attributes:
        particular: (3k + o,) the solution of least norm.
        basis: (3k + o, d) orthonormal.
        contacts: k.
        unbalanced: [-] share of the weight that no force at all can balance.
    """

    particular: Array
    basis: Array
    contacts: int
    unbalanced: float

    @property
    def consistent(self) -> bool:
        """Whether forces of any sign and size can balance the weight."""
        return self.unbalanced <= BALANCE_TOLERANCE

    @property
    def one_sided(self) -> int:
        """Number of multipliers that only push."""
        return int(self.particular.size) - 3 * self.contacts

    def normals(self) -> slice:
        """Entries of u that are normal forces."""
        return slice(0, 3 * self.contacts, 3)

    def pushing(self) -> NDArray[np.intp]:
        """Indices of u that must not be negative: normal forces and one-sided multipliers."""
        normals = np.arange(0, 3 * self.contacts, 3)
        return np.concatenate([normals, np.arange(3 * self.contacts, self.particular.size)])


def force_space(rows: Rows, frames: Array, free: Sequence[bool], weight: float) -> ForceSpace:
    """Solve the equilibrium for all contact forces.

    Rows and columns are scaled to unit length, so that neither newtons nor metres matter; then the
    two-sided multipliers go by the left null space of their columns, and one SVD gives the rest.

    Args:
        rows: the equilibrium, m rows.
        frames: (k, 3, 3) normal, rolling, lateral direction of each contact as rows.
        free: per contact, whether it can carry no rolling force.
        weight: N.
    """
    k = len(frames)
    contact = np.einsum("mkw,kaw->mka", rows.contact.reshape(-1, k, 3), frames).reshape(-1, 3 * k)
    one_sided = np.isfinite(rows.internal_lower)
    pushes = _unit_columns(rows.internal[:, one_sided])
    holds = _unit_columns(rows.internal[:, ~one_sided])
    length = np.linalg.norm(np.hstack([contact, pushes, holds]), axis=1)
    length[length <= 1e-12 * max(length.max(initial=0.0), 1e-300)] = 1.0
    contact, pushes, holds = contact / length[:, None], pushes / length[:, None], holds / length[:, None]
    weighed = rows.gravity / (length * weight)

    if holds.shape[1]:
        left, values, _ = np.linalg.svd(holds)
        held = int(np.count_nonzero(values > RANK_TOLERANCE * max(values.max(), 1e-300)))
        keep = left[:, held:].T
        contact, pushes, weighed = keep @ contact, keep @ pushes, keep @ weighed

    carries = np.ones(3 * k, dtype=bool)
    carries[1::3] = ~np.asarray(free, dtype=bool)
    matrix = np.hstack([contact[:, carries], pushes])
    left, values, right = np.linalg.svd(matrix)
    rank = int(np.count_nonzero(values > RANK_TOLERANCE * max(values.max(initial=0.0), 1e-300)))
    least = right[:rank].T @ ((left[:, :rank].T @ weighed) / values[:rank])
    unbalanced = float(np.max(np.abs(matrix @ least - weighed), initial=0.0))

    used = np.r_[np.flatnonzero(carries), 3 * k + np.arange(pushes.shape[1])]
    particular = np.zeros(3 * k + pushes.shape[1])
    basis = np.zeros((particular.size, matrix.shape[1] - rank))
    particular[used] = least
    basis[used] = right[rank:].T
    return ForceSpace(particular, basis, k, unbalanced)


def _unit_columns(matrix: Array) -> Array:
    length = np.linalg.norm(matrix, axis=0)
    return matrix / np.where(length > 0, length, 1.0)


def unbalanced(rows: Rows, forces: Array, weight: float) -> float:
    """Residual of the equilibrium, from the rows as they were given.

    The multipliers are fitted by least squares (non-negative where they only push); what is left of each
    row is divided by the weight, and by the row's largest lever where that is more than 1.

    Args:
        rows: the equilibrium, m rows.
        forces: (k, 3) N, world.
        weight: N.

    Returns:
        the largest share of the weight that is not balanced [-].
    """
    lever = np.maximum(np.max(np.abs(rows.contact), axis=1, initial=0.0), 1.0)
    rest = (rows.gravity - rows.contact @ forces.reshape(-1)) / (lever * weight)
    internal = _unit_columns(rows.internal / lever[:, None])
    if internal.shape[1]:
        one_sided = np.isfinite(rows.internal_lower)
        if one_sided.any():
            signed = np.hstack([internal, -internal[:, ~one_sided]])
            rest = rest - signed @ nnls(signed, rest)[0]
        else:
            rest = rest - internal @ np.linalg.lstsq(internal, rest, rcond=RANK_TOLERANCE)[0]
    return float(np.max(np.abs(rest), initial=0.0))
