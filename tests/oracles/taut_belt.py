"""A taut belt around discs of a plane, by complex numbers: no project code.

Points are x + i y; the discs stand in counter-clockwise order and the belt has every one on its left. Between
discs i and j a span leaves along the unit t with c_j - c_i = t (s - i (r_i - r_j)), s = sqrt(|d|^2 - dr^2)
its length (Appendix D of Ugenti et al. with D.6 as sqrt(C^2 - dR^2)); a disc's arc is r arg(t_out / t_in)
(D.1). A disc with a negative arc lies above its neighbours' chord: the belt does not touch it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Belt:
    """A belt's way.

    Attributes:
        length: as the discs' lengths.
        on: the discs it touches, in order.
        t_in, t_out: by disc, unit complex directions of the span that reaches and the one that leaves it.
    """

    length: float
    on: tuple[int, ...]
    t_in: dict[int, complex]
    t_out: dict[int, complex]


def span(d: complex, r_i: float, r_j: float) -> tuple[complex, float]:
    """Direction and length of the span between two discs, d from the first centre to the second."""
    s = np.sqrt(abs(d) ** 2 - (r_i - r_j) ** 2)
    return d / (s - 1j * (r_i - r_j)), s


def around(centers: np.ndarray, radii: np.ndarray, on: tuple[int, ...]) -> Belt:
    """The belt around the discs `on`, whether or not each of them holds it."""
    t_in, t_out, length = {}, {}, 0.0
    for i, j in zip(on, on[1:] + on[:1], strict=True):
        t, s = span(centers[j] - centers[i], radii[i], radii[j])
        t_out[i], t_in[j] = t, t
        length += s
    length += sum(radii[i] * np.angle(t_out[i] / t_in[i]) for i in on)
    return Belt(length, on, t_in, t_out)


def taut(centers: np.ndarray, radii: np.ndarray) -> Belt:
    """The taut belt: the disc that bends it most the wrong way is left out until there is none."""
    on = tuple(range(len(centers)))
    while True:
        belt = around(centers, radii, on)
        turn = {i: np.angle(belt.t_out[i] / belt.t_in[i]) for i in on}
        worst = min(on, key=turn.__getitem__)
        if turn[worst] >= 0.0:
            return belt
        on = tuple(i for i in on if i != worst)
