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
    rows = 6 * size  # shapes, stops, struts and loops' rows
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
