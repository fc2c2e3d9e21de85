"""Scratch of the kernels: one record a call, in which each case is worked out."""

from __future__ import annotations

from typing import Any

import numpy as np

Work = Any
"""A record of `work_dtype`."""

CONTACTS = 8
"""Rows that the thorough contact search may fill."""


def work_dtype(size: int) -> np.dtype[np.void]:
    """Scratch for machines of `posed_dtype(size)`; nothing of one case is read by the next."""
    real, whole = np.float64, np.int64
    rows = 7 * size  # shapes, stops, struts, tracks and loops' rows
    return np.dtype(
        [
            ("rot", real, (size, 3, 3)),  # frames of bodies, world
            ("org", real, (size, 3)),
            ("places", real, (size, 2)),  # m, where each shape's contact is followed
            ("contacts", real, (size, 7)),  # gap, point, normal
            ("slack", real, rows),
            ("motion", real, (rows, size)),
            ("force", real, (rows, size)),
            ("closure", real, rows),
            ("closing", real, (rows, size)),
            ("load", real, size),
            ("system", real, (2 * size, 2 * size)),  # of linear equations
            ("right", real, 2 * size),
            ("rows", real, (rows, size)),  # motion rows of what is held, then of loops
            ("sides", real, (rows, size)),  # force rows of the same
            ("gaps", real, rows),
            ("forces", real, rows),  # multipliers of the same
            ("start", real, size),  # where Newton began
            ("active", whole, size),  # one-sided rows taken as carrying, ascending
            ("n_active", whole),
            ("chosen_rows", whole, size),
            ("kept", real, (size, 2)),  # places put aside
            ("stiffness", real, (size, size)),
            ("along", real, (size, size)),
            ("across", real, (size, size)),
            ("reduced", real, (size, size)),
            ("found", real, (CONTACTS, 7)),  # of the thorough search
            ("first", real, (6, size)),  # Jacobians of a pair of frames
            ("second", real, (6, size)),
            ("frame", real, (2, 3, 3)),
            ("origin", real, (2, 3)),
            ("gradient", real, size),
            ("turn", real, (size + 2, 3)),  # columns of the tree, see `rover_pin.mechanism.columns`
            ("move", real, (size + 2, 3)),
            ("rates", real, (size + 2, 3)),
            ("slope", real, size + 2),  # a derivative by columns
            ("curved", real, (size + 2, size + 2)),  # second derivatives by columns
            ("half", real, (size + 2, size)),
            ("pull", real, (size + 2, 3)),  # dead forces
            ("spread", real, (size + 2, 3, 3)),
            ("slide", real, (2, 6)),
            ("ends", whole, 2),
            ("tips", real, (2, 3)),  # m, ends of a strut
            ("pulls", real, 6),  # multipliers of a loop
            ("circles", real, (2 * size, 3)),  # m, centres of tracks' circles, world
            ("flat", real, (2 * size, 2)),  # m, in their plane
            ("plane", real, (size, 3, 3)),
            ("following", whole, 2 * size),
            ("spans", real, (2 * size, 3)),
            ("turns", real, 2 * size),
            ("carriers", whole, 2 * size),  # columns of the circles
            ("flat_pulls", real, (2 * size, 2)),
            ("world_pulls", real, (2 * size, 3)),
            ("wrench", real, (size, 6)),  # force and moment on each body
            ("internal", real, size),
            ("masses", real, size),  # of subtrees
            ("subtree", real, (size, 3)),
            ("com", real, 3),  # m
            ("touching", whole, rows),  # rows that touch
            ("n_touching", whole),
            ("chosen", whole, size),  # of the support polygon
            ("corners", whole, 2 * size + 2),
        ],
        align=True,
    )
