"""What a question for a lift ends with: a plan, or a refusal that says why."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from types import MappingProxyType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rover_pin.statics.stance import Stance


class RefusalStatus(str, Enum):
    """Why wheels are not lifted."""

    NOT_ADMISSIBLE = "not_admissible"
    NO_CLUTCH = "no_clutch"
    NO_STANCE = "no_stance"
    NEGATIVE_LOAD = "negative_load"
    RESERVE = "reserve"
    LIMIT = "limit"
    GROUNDED = "grounded"
    OUT_OF_REACH = "out_of_reach"

    def __str__(self) -> str:
        """The word used in tables and files."""
        return self.value


def _empty() -> Mapping[str, float]:
    return MappingProxyType({})


@dataclass(frozen=True)
class Refusal:
    """Wheels that are not lifted, and why.

    Attributes:
        wheels: that were to be lifted.
        status: kind of the reason.
        reason: one clause for people: which wheel, joint or side, with its value.
        limiting: name of that wheel, joint, link or side, or None.
        load: N that the limiting wheel would have to carry, where loads are the reason, else None.
        rockers: angles of the rockers that turn, where it fails on the way up [rad].
        height: m reached before that with every other wheel's load as wanted; 0: not off the ground.
        stances: on the way up to there.
    """

    wheels: tuple[str, ...]
    status: RefusalStatus
    reason: str
    limiting: str | None = None
    load: float | None = None
    rockers: Mapping[str, float] = field(default_factory=_empty)
    height: float = 0.0
    stances: tuple[Stance, ...] = ()


@dataclass(frozen=True)
class LiftPlan:
    """How to lift wheels: stand at `start`, engage the clutches, turn the rockers to `rockers`.

    Angles in rad, lengths in m, forces in N.

    Attributes:
        wheels: that are lifted.
        clutches: joints to lock and the values at which they are locked.
        start: driven rockers, of both sides, when the clutches are engaged.
        rockers: targets of the rockers that turn, one a lifted wheel.
        directions: `folds` or `unfolds` per side that reshapes: whether its front and rear wheel come nearer
            to each other.
        clearance: of the lowest belly point over the terrain at `start`; None without belly points.
        heights: of each lifted wheel at the top, over the ground under its centre.
        loads: per wheel at the top.
        least_load: the least load of a standing wheel on the way up, top included.
        least_wheel: that wheel.
        present: the stance in which the clutches are engaged.
        stances: on the way up, the last one the top.
        approach: stances on the way from the asked posture to `present`; empty where none was needed.
    """

    wheels: tuple[str, ...]
    clutches: Mapping[str, float]
    start: Mapping[str, float]
    rockers: Mapping[str, float]
    directions: Mapping[str, str]
    clearance: float | None
    heights: Mapping[str, float]
    loads: Mapping[str, float]
    least_load: float
    least_wheel: str
    present: Stance
    stances: tuple[Stance, ...]
    approach: tuple[Stance, ...] = ()

    @property
    def top(self) -> Stance:
        """The stance with the wheels lifted."""
        return self.stances[-1]

    @property
    def turns(self) -> dict[str, float]:
        """How far each rocker turns from `start` [rad]."""
        return {rocker: angle - self.start[rocker] for rocker, angle in self.rockers.items()}

    @property
    def load_difference(self) -> float:
        """Largest less least load of the wheels that stand at the top [N]."""
        standing = [load for wheel, load in self.loads.items() if wheel not in self.wheels]
        return max(standing) - min(standing)
