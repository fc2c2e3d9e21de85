"""A rover on a board that is tilted: at which slope it no longer stands, and at which it slips."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rover_pin.stability.report import stability
from rover_pin.statics.stance import Status

if TYPE_CHECKING:
    from rover_pin.rover import Rover
    from rover_pin.stability.margin import Margin
    from rover_pin.statics.stance import Stance

STEP = math.radians(4.0)
"""Slopes that are looked at first are this far apart."""

CLOSE = 1e-8
"""rad to which a slope is found."""

COARSE = 1e-6
"""rad to which the end of slopes without an answer is found."""

STEEPEST = math.radians(89.0)

NOTHING = 1e-9
"""Share of the weight below which a negative slack is rounding."""


ASIDE = (0.0, 0.13, -0.17, 0.31, -0.37)
"""Where else to ask if a slope has no answer, as shares of the room there is."""


@dataclass(frozen=True)
class Limits:
    """What ends standing in one heading.

    Attributes:
        tip: rad, the slope beyond which there is no stance; NaN where it does not stand on level ground.
        tip_open: rad, how much further it might stand: more than `CLOSE` only where the solver found no
            stance and no end of it.
        tip_limiting: the wheel, joint or link that ends it.
        tip_status: how that stance ends: `tips`, `grounded`, ...
        slip: rad, the slope from which friction holds it no longer; NaN where it tips before.
        slip_open: rad, likewise.
        slip_limiting: the contact that slips first, of several alike any.
    """

    tip: float
    tip_open: float
    tip_limiting: str
    tip_status: str
    slip: float = math.nan
    slip_open: float = math.nan
    slip_limiting: str = ""


@dataclass
class TiltTable:
    """One heading on a board, tilted from level.

    The heading is an angle in the plane of the board from straight uphill, counterclockwise from above. It
    stays as the board tilts, so that a rigid rover tips exactly where, over its edges, tan(slope) is least of
    distance / (height of the centre of mass * cos(angle from downhill to the edge's normal)). The yaw of the
    stance, which is counted in plan, is atan2(sin(heading), cos(heading) cos(slope)).

    A stance that the solver does not find (`no_convergence`) is no answer: slopes beside it are asked, and
    where none has one it counts as no stance, and how far they go is told.

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

        The slope grows in steps of `STEP` from level ground to the first one without a stance; the bracket
        closes by halves and by where the least load would be zero. Likewise for a negative `slack`.
        """
        level = self.stance(0.0)
        if not level.settled:
            return Limits(math.nan, math.nan, level.limiting or "", str(level.status))
        low, high, stance = 0.0, 0.0, level
        while high < STEEPEST:
            high, stance = self._answered(min(high + STEP, STEEPEST), 0.2 * STEP)
            if stance.settled:
                low = high
            elif stance.status is not Status.NO_CONVERGENCE:
                break
        else:
            return Limits(math.nan, math.nan, stance.limiting or "", str(stance.status))
        coarse = sorted(self._standing)
        tip, tip_open, stance = self._tip(low, high, stance)
        near = [slope for slope in (max(self._standing),) if slope > low]
        return Limits(tip, tip_open, stance.limiting or "", str(stance.status), *self._slip([*coarse, *near]))

    def stance(self, slope: float) -> Stance:
        """How the rover stands on a slope [rad]."""
        from rover_pin import Terrain, settle

        yaw = math.atan2(math.sin(self.heading), math.cos(self.heading) * math.cos(slope))
        stance = settle(self.rover, Terrain.slope(math.degrees(slope)), yaw=yaw, **self.how)  # type: ignore[arg-type]
        if stance.settled:
            self._standing[slope] = stance
        return stance

    def _answered(self, slope: float, room: float) -> tuple[float, Stance]:
        """A slope, or one at most `room` beside it, that has an answer; the last one asked if none has."""
        for share in ASIDE:
            beside = min(slope + share * room, STEEPEST)
            stance = self.stance(beside)
            if stance.status is not Status.NO_CONVERGENCE:
                break
        return beside, stance

    def _tip(self, low: float, high: float, fallen: Stance) -> tuple[float, float, Stance]:
        """The steepest slope that it is known to stand on, what is open above it, how it ends there."""
        attempt, edge = 0, high
        while edge - low > CLOSE:
            guess = 0.5 * (low + edge)
            if attempt % 3:
                guess = _beside(self._unloaded(low), low, edge, attempt)
            attempt += 1
            guess, stance = self._answered(guess, min(guess - low, edge - guess))
            if stance.settled:
                low = guess
                continue
            edge = guess
            if stance.status is not Status.NO_CONVERGENCE:
                high, fallen = guess, stance
        while high - edge > COARSE:  # nothing was found just above: from where on is it sure to fall
            guess = 0.5 * (edge + high)
            stance = self.stance(guess)
            if stance.settled or stance.status is Status.NO_CONVERGENCE:
                edge = guess
            else:
                high, fallen = guess, stance
        return low, high - low, fallen

    def _unloaded(self, low: float) -> float:
        """Where the least load would be zero, going on straight from the two steepest stances."""
        steepest = sorted(self._standing)[-2:]
        if len(steepest) < 2:
            return low
        (a, b), (at_a, at_b) = steepest, (self._least_load(slope) for slope in steepest)
        return b + at_b * (b - a) / (at_a - at_b) if at_a > at_b else low

    def _least_load(self, slope: float) -> float:
        return min(load for load in self._standing[slope].loads.values() if load > 0.0)

    def _slack(self, slope: float) -> Margin:
        """Of a slope that it stands on."""
        return stability(self._standing[slope], ["slack"], self.friction)["slack"]

    def _slip(self, slopes: list[float]) -> tuple[float, float, str]:
        """The steepest slope at which friction holds it, what is open above it, the contact that slips."""
        low, within = -1.0, None
        for high in slopes:
            beyond = self._slack(high)
            if beyond.value < -NOTHING * self._standing[high].weight:
                break
            low, within = high, beyond
        else:
            return math.nan, math.nan, ""
        if within is None:
            return 0.0, 0.0, beyond.limiting or ""
        attempt = 0
        while high - low > CLOSE:
            guess = 0.5 * (low + high)
            if attempt % 3 and math.isfinite(beyond.value):
                share = within.value / (within.value - beyond.value)
                guess = _beside(low + share * (high - low), low, high, attempt)
            attempt += 1
            guess, stance = self._answered(guess, min(guess - low, high - guess))
            if not stance.settled:
                break
            found = self._slack(guess)
            if found.value < 0.0:
                high, beyond = guess, found
            else:
                low, within = guess, found
        return low, high - low, beyond.limiting or ""


def _beside(zero: float, low: float, high: float, attempt: int) -> float:
    """A little to one side of where a zero is thought to be, to the other the next time; else the middle."""
    aside = max(0.25 * CLOSE, 1e-3 * (high - low)) * (1.0 if attempt % 3 == 1 else -1.0)
    return zero + aside if low < zero + aside < high else 0.5 * (low + high)
