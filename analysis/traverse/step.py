"""What one place of a path asks of the rover, and what stops it there."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.analysis.traverse.follow import Stood
from rover_pin.numerics import Array
from rover_pin.stability.measure import Standing
from rover_pin.stability.registry import MEASURES
from rover_pin.statics.distribute import smallest_friction
from rover_pin.statics.forces import ForceStatus
from rover_pin.statics.least_torque import least_torque
from rover_pin.statics.stance import Status

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rover_pin.rover import Rover
    from rover_pin.stability.margin import Margin
    from rover_pin.statics.friction_problem import FrictionProblem

ROUNDING = 1e-7
"""Of a coefficient, or share of an effort: less than this beyond a limit is none."""

LIMITS = {Status.TIPS: "tip", Status.GROUNDED: "belly contact"}
"""What a status is called as a limit; the others by their own words."""


@dataclass(frozen=True)
class Step:
    """One place.

    Attributes:
        stood: the stance.
        friction: margin of the measure `friction`; None where it does not stand.
        torque: of `torque`; None where it does not stand or has no driven wheel.
        share: least largest share of the drives' efforts [-]; NaN where no drive has one, or no answer.
        share_at: the drive's wheel that has it.
        limit: what stops it here: `friction`, `torque`, `leap`, `tip`, `belly contact` or a status; or "".
        why: in words.
        limiting: wheel, joint or link.
    """

    stood: Stood
    friction: Margin | None = None
    torque: Margin | None = None
    share: float = math.nan
    share_at: str = ""
    limit: str = ""
    why: str = ""
    limiting: str = ""

    @property
    def needed(self) -> float:
        """Least friction of one for all [-]; inf where none holds it, NaN where it does not stand."""
        return math.nan if self.friction is None else self.friction.details.get("least", math.inf)

    @property
    def passes(self) -> bool:
        """Whether it can be here."""
        return not self.limit


def ask(stood: Stood, friction: float | None) -> Step:
    """Friction and torque of a place, and whether the rover can be there."""
    stance = stood.stance
    if not stance.settled:
        limit = LIMITS.get(stance.status, str(stance.status))
        return Step(stood, limit=limit, why=stance.reason, limiting=stance.limiting or "")
    standing = Standing(stance, friction)
    grip = MEASURES["friction"].evaluate(standing)
    if not grip.answered and smallest_friction(standing.problem).status is ForceStatus.NO_CONVERGENCE:
        return Step(stood, grip, limit=str(Status.NO_CONVERGENCE), why=f"friction: {grip.note}")
    if grip.value < -ROUNDING:
        why = _short(grip, standing.problem) if grip.answered else grip.note
        return Step(stood, grip, limit="friction", why=why, limiting=grip.limiting or "")
    torque = MEASURES["torque"].evaluate(standing)
    if not torque.edges:
        return Step(stood, grip)
    share, wheel = effort_share(stance.rover, standing.problem)
    if share <= 1.0 + ROUNDING or math.isnan(share):
        return Step(stood, grip, torque, share, wheel)
    why = f"the drives would have to give {_above(100.0 * share, 100.0)} % of their efforts"
    return Step(stood, grip, torque, share, wheel, "torque", why, wheel)


def _above(value: float, limit: float) -> str:
    """A figure with as many digits as show that it is above the limit, four at least."""
    texts = (f"{value:.{digits}g}" for digits in range(4, 10))
    return next((text for text in texts if float(text) > limit), f"{value:.10g}")


def _short(grip: Margin, problem: FrictionProblem) -> str:
    """That friction does not hold the rover, in words."""
    if np.ptp(problem.friction) > 0.0:
        return f"every contact lacks {-grip.value:.4g} of friction"
    given = float(problem.friction[0])
    return f"needs friction {_above(grip.details['least'], given)} where there is {given:.4g}"


def effort_share(rover: Rover, problem: FrictionProblem) -> tuple[float, str]:
    """The least, over forces within friction, of the largest |torque| / effort of a drive, and whose it is.

    Efforts are the URDF's; drives without one give any torque. inf where the solver had no answer, which
    fails closed; NaN where no drive that touches has an effort.
    """
    efforts = {
        wheel.name: float(rover.effort[rover.column[wheel.drive]])
        for wheel in rover.wheels
        if wheel.drive is not None and wheel.name in problem.driven
    }
    touching = list(dict.fromkeys(c.wheel for c in problem.contacts))
    wheels = [name for name in touching if math.isfinite(efforts.get(name, math.inf))]
    if not wheels:
        return math.nan, ""
    levers = _levers(problem, wheels, [max(efforts[name], 1e-9) for name in wheels])
    outcome, _, forces = least_torque(problem.space, problem.friction, levers)
    if outcome != "found":
        return math.inf, ""
    rolling = forces[1 : 3 * len(problem.contacts) : 3] * problem.weight
    shares = np.abs(levers @ rolling)
    worst = int(np.argmax(shares))
    return float(shares[worst]), wheels[worst]


def _levers(problem: FrictionProblem, wheels: Sequence[str], efforts: Sequence[float]) -> Array:
    """(w, k) 1/N: lever over effort."""
    return np.array(
        [
            [c.radius / effort if c.wheel == wheel else 0.0 for c in problem.contacts]
            for wheel, effort in zip(wheels, efforts, strict=True)
        ]
    )
