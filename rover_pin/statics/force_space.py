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

    Rows and columns are scaled to unit length, so that neither newtons nor metres matter.

    Args:
        rows: the equilibrium, m rows.
        frames: (k, 3, 3) normal, rolling, lateral direction of each contact as rows.
        free: per contact, whether it can carry no rolling force.
        weight: N.
    """
    k = len(frames)
    contact = in_contact_frames(rows.contact, frames)
    one_sided = np.isfinite(rows.internal_lower)
    pushes = _unit_columns(rows.internal[:, one_sided])
    carries = may_carry(free)
    particular, basis, unbalanced = solutions(
        np.hstack([contact, pushes]),
        _unit_columns(rows.internal[:, ~one_sided]),
        rows.gravity / weight,
        np.r_[carries, np.ones(pushes.shape[1], dtype=bool)],
    )
    return ForceSpace(particular, basis, k, unbalanced)


def in_contact_frames(columns: Array, frames: Array) -> Array:
    """(m, 3k) columns of each contact's normal, rolling and lateral force, from those of its world force."""
    k = len(frames)
    turned: Array = np.einsum("mkw,kaw->mka", columns.reshape(-1, k, 3), frames).reshape(-1, 3 * k)
    return turned


def may_carry(free: Sequence[bool]) -> NDArray[np.bool_]:
    """(3k,) which of the contacts' force components there are: a free wheel has no rolling one."""
    carries = np.ones(3 * len(free), dtype=bool)
    carries[1::3] = ~np.asarray(free, dtype=bool)
    return carries


def solutions(
    columns: Array, holds: Array, level: Array, used: NDArray[np.bool_]
) -> tuple[Array, Array, float]:
    """All u with columns @ u + holds @ (anything) = level, as u = particular + basis @ y.

    Rows are scaled to unit length; `holds` go by their left null space, and one SVD gives the rest.

    Args:
        columns: (m, n).
        holds: (m, h) of what is eliminated.
        level: (m,) right side.
        used: (n,) entries of u that may differ from zero.

    Returns:
        (n,) particular, (n, d) orthonormal basis, and the largest part of `level` that nothing balances.
    """
    length = np.linalg.norm(np.hstack([columns, holds]), axis=1)
    length[length <= 1e-12 * max(length.max(initial=0.0), 1e-300)] = 1.0
    matrix, holds, level = columns[:, used] / length[:, None], holds / length[:, None], level / length
    if holds.shape[1]:
        left, values, _ = np.linalg.svd(holds)
        held = int(np.count_nonzero(values > RANK_TOLERANCE * max(values.max(), 1e-300)))
        keep = left[:, held:].T
        matrix, level = keep @ matrix, keep @ level
    left, values, right = np.linalg.svd(matrix)
    rank = int(np.count_nonzero(values > RANK_TOLERANCE * max(values.max(initial=0.0), 1e-300)))
    least = right[:rank].T @ ((left[:, :rank].T @ level) / values[:rank])
    particular, basis = np.zeros(len(used)), np.zeros((len(used), matrix.shape[1] - rank))
    particular[used], basis[used] = least, right[rank:].T
    return particular, basis, float(np.max(np.abs(matrix @ least - level), initial=0.0))


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
