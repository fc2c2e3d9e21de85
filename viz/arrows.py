"""The loads as arrows against gravity from where the wheels touch: one mesh for all."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rover_pin.viz.colours import LIMIT, LOAD
from rover_pin.viz.surfaces import Surface, arrow, joined

if TYPE_CHECKING:
    from rover_pin.statics.stance import Stance


def lightest(stance: Stance) -> str | None:
    """The wheel that carries least, where there is more than one and they differ."""
    loads = stance.loads
    if len(loads) < 2 or max(loads.values()) - min(loads.values()) < 1e-6 * max(stance.weight, 1e-9):
        return None
    return min(loads, key=lambda name: loads[name])


def load_arrows(stance: Stance, span: float) -> Surface:
    """Arrows up from every contact, as long as its load: the heaviest contact's is 0.4 of the wheel span."""
    heaviest = max((contact.load for contact in stance.contacts), default=0.0)
    if heaviest <= 0:
        return joined([])
    up = np.array([0.0, 0.0, 0.4 * span / heaviest])
    light = lightest(stance)
    return joined(
        [
            arrow(c.point, c.point + c.load * up, 0.0095 * span, LIMIT if c.wheel == light else LOAD)
            for c in stance.contacts
            if c.load > 1e-3 * heaviest
        ]
    )
