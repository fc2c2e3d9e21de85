"""The nearest posture from which a lift goes: both rockers turned together, clutches open."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.control.lifting.places import clearance_of
from rover_pin.control.lifting.plan import lift_from
from rover_pin.control.lifting.result import LiftPlan, Refusal
from rover_pin.errors import InputError

if TYPE_CHECKING:
    from rover_pin.control.lifting.question import Question
    from rover_pin.statics.stance import Stance

STRIDE = 0.04
"""rad of rocker motion between two postures that are tried."""

FINE = 1e-5
"""rad to which the nearest posture that serves is found."""

_NUDGE = 1e-3  # rad
_FLAT = 1e-3  # m/rad: a rocker that raises the centre of mass less than this does not move the chassis


def raising(question: Question, present: Stance) -> dict[str, float]:
    """1 or -1 for each rocker: the direction of turning that raises the chassis, by the statics.

    Raises:
        InputError: a rocker that does not move the chassis.
    """
    senses = {}
    for side in question.layout.sides:
        rise = []
        for nudge in (_NUDGE, -_NUDGE):
            turned = _within(question, side.rocker, present.joints[side.rocker] + nudge)
            stance = question.settle({**present.joints, side.rocker: turned}, {})
            rise.append(float(stance.com[2]) if stance.settled else float(present.com[2]))
        if abs(rise[0] - rise[1]) < _FLAT * _NUDGE:
            raise InputError(
                "this rocker does not raise or lower the chassis with the clutches open",
                element=side.rocker, value=f"{abs(rise[0] - rise[1]) / _NUDGE:.2g} m/rad",
                cure="name the driven joint that reshapes the side",
            )  # fmt: skip
        senses[side.rocker] = math.copysign(1.0, rise[0] - rise[1])
    return senses


def _within(question: Question, joint: str, value: float) -> float:
    column = question.rover.column[joint]
    return float(np.clip(value, question.rover.lower[column], question.rover.upper[column]))


@dataclass(frozen=True)
class Search:
    """Lifts tried after both rockers have turned together from the present stance.

    Attributes:
        question: which wheels, where.
        present: the stance asked from.
        senses: of each rocker, as `raising` says.
        height, step: as for `plan_lift` [m].
        reserve: load that every standing wheel must keep [N].
    """

    question: Question
    present: Stance
    senses: Mapping[str, float]
    height: float
    step: float
    reserve: float

    def nearest(self) -> LiftPlan | Refusal:
        """The lift from the present posture, else from the nearest clearance that serves."""
        first = self.lift(0.0)
        if isinstance(first, LiftPlan):
            return first
        tried = [(0.0, first)]
        best: tuple[float, LiftPlan] | None = None
        for sense in (1.0, -1.0):
            within = math.inf if best is None else self._change(best[1].present)
            found = self._outward(sense, within, tried)
            if found is not None and self._change(found[1].present) < within:
                best = found
        if best is None:
            return self._none(tried)
        turns = np.linspace(0.0, best[0], math.ceil(abs(best[0]) / STRIDE) + 1)
        return replace(best[1], approach=tuple(self.stand(float(turn)) for turn in turns))

    def lift(self, turn: float) -> LiftPlan | Refusal:
        """The lift after the rockers have turned together by `turn` [rad], upwards where positive."""
        stance = self.stand(turn)
        if not stance.settled:
            return self.question.no_stance(stance)
        locked = {str(side.clutch): stance.joints[str(side.clutch)] for side in self.question.sides}
        return lift_from(self.question, stance, locked, self.height, self.step, self.reserve)

    def stand(self, turn: float) -> Stance:
        """The rover with both rockers turned together, clutches open."""
        turned = {name: self.present.joints[name] + sense * turn for name, sense in self.senses.items()}
        return self.question.settle({**self.present.joints, **turned}, {})

    def _outward(
        self, sense: float, within: float, tried: list[tuple[float, Refusal]]
    ) -> tuple[float, LiftPlan] | None:
        """The least turn in one direction that serves, if it changes the chassis less than `within` [m]."""
        room, failed = self._room(sense), 0.0
        for turn in [*np.arange(STRIDE, room, STRIDE).tolist(), room]:
            if not self.stand(sense * turn).settled or self._change(self.stand(sense * failed)) >= within:
                return None
            found = self.lift(sense * turn)
            if isinstance(found, LiftPlan):
                return self._bisected(sense, failed, turn, found)
            tried.append((sense * turn, found))
            failed = turn
        return None

    def _bisected(self, sense: float, failed: float, served: float, plan: LiftPlan) -> tuple[float, LiftPlan]:
        """The least turn that serves between one that fails and one that serves."""
        while served - failed > FINE:
            middle = (served + failed) / 2.0
            found = self.lift(sense * middle)
            if isinstance(found, LiftPlan):
                served, plan = middle, found
            else:
                failed = middle
        return sense * served, plan

    def _room(self, sense: float) -> float:
        """How far both rockers can turn together before one of them reaches its limit [rad]."""
        rover, room = self.question.rover, math.pi
        for rocker, raises in self.senses.items():
            column = rover.column[rocker]
            up = sense * raises > 0.0
            limit = float(rover.upper[column] if up else rover.lower[column])
            room = min(room, abs(limit - self.present.joints[rocker]))
        return room

    def _change(self, stance: Stance) -> float:
        """How much higher or lower the chassis stands than at present [m]."""
        now, then = clearance_of(stance), clearance_of(self.present)
        if now is None or then is None:
            return abs(float(stance.com[2] - self.present.com[2]))
        return abs(now - then)

    def _none(self, tried: list[tuple[float, Refusal]]) -> Refusal:
        """No posture serves: what came nearest."""
        turn, best = max(tried, key=lambda each: -math.inf if each[1].load is None else each[1].load)
        clearance = clearance_of(self.stand(turn))
        place = f"at clearance {1e3 * clearance:.0f} mm" if clearance is not None else "at its best"
        head = f"no posture of both rockers together serves; {place}, {best.reason}"
        return replace(best, reason=head)
