"""The plain path's contact search as a pointer.

The search is large, and numba compiles what a function calls into it again; a pointer is called as it is.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numba
from numba import types

from rover_pin.contact.place import RING
from rover_pin.contact.search import find_contacts
from rover_pin.numerics import Array

Search = Any
"""What `contact_search` gives."""


@cache
def contact_search() -> Search:
    """`find_contacts` for rings.

    It takes kind, table, params, spacing, center, axis, ring, tread, window, out: table and params as a
    Terrain has them, read-only; center and axis (3,), out (K, 7).
    """
    line, real = types.Array(types.float64, 1, "C"), types.float64
    fixed = [types.Array(real, dims, "C", readonly=True) for dims in (2, 1)]
    signature = types.int64(
        types.int64, *fixed, real, line, line, real, real, real, types.Array(real, 2, "C")
    )  # fmt: skip
    return numba.cfunc(signature, cache=True, error_model="numpy")(_search_ring)


def _search_ring(
    kind: int, table: Array, params: Array, spacing: float, center: Array, axis: Array, ring: float,
    tread: float, window: float, out: Array,
) -> int:  # fmt: skip
    count: int = find_contacts(kind, table, params, spacing, RING, center, axis, ring, tread, window, out)
    return count
