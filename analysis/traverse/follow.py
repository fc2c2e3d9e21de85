"""One stance after the other: each found from the one before, as the rover drives."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.analysis.traverse.path import Place
from rover_pin.statics.asked import held_values
from rover_pin.statics.follow import WINDOW, straight
from rover_pin.statics.ground import Footing, let_go
from rover_pin.statics.level import on_level
from rover_pin.statics.report import report
from rover_pin.statics.settle import settle
from rover_pin.statics.stance import Stance, Status

if TYPE_CHECKING:
    from rover_pin.numerics import Array
    from rover_pin.rover import Rover
    from rover_pin.statics.problem import Problem
    from rover_pin.terrain import Terrain

SAME = 1e-9
"""m or rad: a stance this near its footing is that footing's."""


@dataclass(frozen=True)
class Stood:
    """A stance at a place of the path.

    Attributes:
        place: where.
        stance: how it stands there.
        footing: what the next one is found from; None where it does not stand.
        followed: whether it was found from the one before; else the rover was lowered there.
    """

    place: Place
    stance: Stance
    footing: Footing | None = field(repr=False, default=None)
    followed: bool = False


class Follower:
    """A rover held at places along a path.

    From a stance the next one is found by Newton on the same supports; where those change it is let go from
    there and comes to rest on others. Where that finds none, or there is no stance before, it is lowered onto
    the place from level ground (`rover_pin.settle`), and that answer counts.
    """

    def __init__(self, rover: Rover, terrain: Terrain, how: Mapping[str, Any]) -> None:
        self.rover, self.terrain, self._how = rover, terrain, dict(how)
        joints, locks = dict(how.get("joints") or {}), tuple(how.get("locks", ()))
        self._gravity = float(how.get("gravity", 9.81))
        self._asked = (how.get("posture"), joints, locks)
        self._problem: Problem | None = None
        self._locked: tuple[str, ...] = ()

    def at(self, place: Place, before: Stood | None) -> Stood:
        """The stance at a place, from the one before."""
        if before is not None and before.footing is not None:
            footing, stance = self._onward(place, before.footing)
            if stance is not None:
                return Stood(place, stance, footing, True)
        stance = settle(self.rover, self.terrain, x=place.x, y=place.y, yaw=place.yaw, **self._how)
        if not stance.settled:
            return Stood(place, stance)
        problem = self._moved(place)
        z = problem.reduction.pick(np.array(stance.configuration))
        return Stood(place, stance, self._footing(problem, z), False)

    def _moved(self, place: Place) -> Problem:
        if self._problem is None:
            values, self._locked = held_values(self.rover, *self._asked, self._gravity)
            self._problem, _ = on_level(self.rover, values, self._locked, self._gravity)
        return self._problem.moved(place.x, place.y, place.yaw)

    def _onward(self, place: Place, before: Footing) -> tuple[Footing | None, Stance | None]:
        problem = self._moved(place)
        found = straight(problem, before, before.z.copy(), self.terrain)
        stance = None if found is None else self._stance(problem, found)
        if stance is None:
            z = before.z.copy()
            shapes = len(self.rover.shapes)
            z[0] -= min(0.0, float(np.min(problem.state(z, self.terrain).slack[:shapes])))
            found = let_go(problem, z, self.terrain, WINDOW, None)
            stance = self._stance(problem, found) if found.status is Status.SETTLED else None
        if found is None or stance is None:
            return None, None
        z = problem.reduction.pick(np.array(stance.configuration))
        moved = float(np.max(np.abs(z - found.z)))
        return (found if moved <= SAME else self._footing(problem, z)), stance

    def _stance(self, problem: Problem, footing: Footing) -> Stance | None:
        """The stance of a footing where it passes every check."""
        stance = report(problem, footing, self.terrain, self._locked)
        return stance if stance.settled else None

    def _footing(self, problem: Problem, z: Array) -> Footing | None:
        """The supports of a pose that stands."""
        footing = let_go(problem, z, self.terrain, 1e-5, None)
        return footing if footing.status is Status.SETTLED else None
