"""Which wheels may be off the ground together, in words."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

from rover_pin.control.motion_constraints.lifted_set import broken_rules

if TYPE_CHECKING:
    from rover_pin.control.layout import Layout


def admissible(layout: Layout, wheels: Collection[str]) -> str | None:
    """Why these wheels may not be lifted together, or None where they may (`broken_rules`).

    Raises:
        InputError: no wheel of that name.
    """
    broken = broken_rules(layout, wheels)
    return f"{', '.join(wheels)} may not be lifted together: {', '.join(broken)}" if broken else None
