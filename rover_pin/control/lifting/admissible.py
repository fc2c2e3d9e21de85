"""Which wheels may be off the ground together."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rover_pin.control.layout import Layout

MOST = 2
"""Wheels that may be off the ground at once."""


def admissible(layout: Layout, wheels: Collection[str]) -> str | None:
    """Why these wheels may not be lifted together, or None where they may.

    At most two wheels, at most one a side, no front wheel with a rear one: motion constraint 1 of the
    HIT-MRII paper. Six wheels have 14 such sets, counting the empty one.

    Raises:
        InputError: no wheel of that name.
    """
    names = tuple(dict.fromkeys(wheels))
    sides = [layout.side_of(wheel).name for wheel in names]
    if len(names) > MOST:
        return f"{len(names)} wheels are asked for ({', '.join(names)}), at most {MOST} may be off the ground"
    if len(set(sides)) < len(sides):
        return f"{' and '.join(names)} stand on the {sides[0]} side: at most one wheel a side may be lifted"
    last = len(layout.left.wheels) - 1
    rows = {layout.row_of(wheel): wheel for wheel in names}
    if len(names) == MOST and {0, last} == set(rows):
        return f"{rows[0]} is a front wheel and {rows[last]} a rear one: they may not be lifted together"
    return None
