"""A rover on a board that is tilted: at which slope it no longer stands, and at which it slips."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rover_pin.stability.report import stability

if TYPE_CHECKING:
    from rover_pin.rover import Rover
    from rover_pin.stability.margin import Margin
    from rover_pin.statics.stance import Stance

STEP = math.radians(4.0)
"""Slopes that are looked at first are this far apart."""

CLOSE = 1e-9
"""rad to which a slope is found."""

STEEPEST = math.radians(89.0)


@dataclass(frozen=True)
class Limits:
    """What ends standing in one heading.

    Attributes:
        tip: rad, the slope at which there is no stance any more; NaN where it does not stand on level ground.
        tip_limiting: the wheel, joint or link that ends it.
        tip_status: how that stance ends: `tips`, `grounded`, ...
        slip: rad, the slope from which friction holds it no longer; NaN where it tips before.
        slip_limiting: the contact that slips first, of several alike the first.
    """

    tip: float
    tip_limiting: str
    tip_status: str
    slip: float
    slip_limiting: str


@dataclass
class TiltTable:
    """One heading on a board, tilted from level.

    The heading is an angle in the plane of the board from straight uphill, counterclockwise from above: it stays as
    the board tilts, and a rigid rover tips where tan(slope) = distance of an edge / (height of the centre of mass *
    cos(angle from downhill to the edge's normal)), exactly. The yaw of the stance, which is counted in plan, is
    atan2(sin(heading), cos(heading) cos(slope)).

    Attributes:
        rover: what stands.
        heading: rad.
        friction: coefficient everywhere, or None for what the shapes declare.
        how: further keywords of `rover_pin.settle`.
    """

    rover: Rover
    heading: float
    friction: float | None
    how: Mapping[str, object]
    _standing: dict[float, Stance] = field(default_factory=dict)

    def limits(self) -> Limits:
        """Tip and slip, each within `CLOSE`.

        The slope grows in steps of `STEP` from level ground to the first one without a stance, and the
        bracket is halved; likewise to the first one with a negative `slack`.
        """
        last, first = self._bracket()
        if last is None:
            return Limits(math.nan, first.limiting or "", str(first.status), math.nan, "")
        low, high = last
        while high - low > CLOSE:
            middle = 0.5 * (low + high)
            stance = self.stance(middle)
            if stance.settled:
                low, self._standing[middle] = middle, stance
            else:
                high, first = middle, stance
        slip, contact = self._slip()
        return Limits(0.5 * (low + high), first.limiting or "", str(first.status), slip, contact)

    def stance(self, slope: float) -> Stance:
        """How the rover stands on a slope [rad]."""
        from rover_pin import Terrain, settle

        yaw = math.atan2(math.sin(self.heading), math.cos(self.heading) * math.cos(slope))
        return settle(self.rover, Terrain.slope(math.degrees(slope)), yaw=yaw, **self.how)  # type: ignore[arg-type]

    def _bracket(self) -> tuple[tuple[float, float] | None, Stance]:
        """The last slope that it stands on and the first that it does not, and that first one's stance."""
        stance = self.stance(0.0)
        if not stance.settled:
            return None, stance
        low = 0.0
        while True:
            self._standing[low] = stance
            high = min(low + STEP, STEEPEST)
            stance = self.stance(high)
            if not stance.settled or high >= STEEPEST:
                return (low, high), stance
            low = high

    def _slack(self, slope: float) -> Margin:
        """Of a slope [rad] that it stands on."""
        stance = self._standing.get(slope) or self.stance(slope)
        return stability(stance, ["slack"], self.friction)["slack"]

    def _slip(self) -> tuple[float, str]:
        """The first slope at which friction does not hold it, and the contact that slips."""
        low = -1.0
        tolerance = 1e-9 * self._standing[0.0].weight
        for high in sorted(self._standing):
            margin = self._slack(high)
            if margin.value < -tolerance:
                break
            low = high
        else:
            return math.nan, ""
        if low < 0.0:
            return 0.0, margin.limiting or ""
        while high - low > CLOSE:
            middle = 0.5 * (low + high)
            found = self._slack(middle)
            if found.value < 0.0:
                high, margin = middle, found
            else:
                low = middle
        return 0.5 * (low + high), margin.limiting or ""
