"""A question for a lift, checked: which wheels of which rover, where, in which posture."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rover_pin.control.lifting.admissible import admissible
from rover_pin.control.lifting.result import Refusal, RefusalStatus
from rover_pin.errors import InputError
from rover_pin.statics.settle import settle
from rover_pin.terrain import Terrain

if TYPE_CHECKING:
    from rover_pin.control.layout import Layout, Side
    from rover_pin.rover import Rover
    from rover_pin.statics.stance import Stance

Posture = str | Mapping[str, float] | None

APART = 0.02
"""rad or m by which a clutch's given value may differ from that of the settled rover."""

_UP = 1e-6  # m


@dataclass(frozen=True)
class Question:
    """Wheels to lift at a place.

    Attributes:
        rover: the rover.
        layout: its sides.
        wheels: to lift.
        terrain: what it stands on.
        x, y, yaw: of the base [m, m, rad].
        gravity: m/s2.
    """

    rover: Rover
    layout: Layout
    wheels: tuple[str, ...]
    terrain: Terrain
    x: float
    y: float
    yaw: float
    gravity: float

    @property
    def sides(self) -> tuple[Side, ...]:
        """The side of each wheel."""
        return tuple(self.layout.side_of(wheel) for wheel in self.wheels)

    def _refused(self) -> Refusal | None:
        """Why the wheels are not lifted whatever the posture, or None."""
        reason = admissible(self.layout, self.wheels)
        if reason is not None:
            return Refusal(self.wheels, RefusalStatus.NOT_ADMISSIBLE, reason)
        for wheel, side in zip(self.wheels, self.sides, strict=True):
            if side.clutch is None:
                reason = f"the {side.name} side has no clutch, without which turning its rocker moves the"
                reason += f" chassis and leaves {wheel} on the ground"
                return Refusal(self.wheels, RefusalStatus.NO_CLUTCH, reason, side.name)
        return None

    def settle(self, posture: Posture, joints: Mapping[str, float]) -> Stance:
        """The rover with driven joints (and wheels' drives) as given and every clutch open."""
        drives = {wheel.drive for wheel in self.rover.wheels}
        held = {name: value for name, value in joints.items() if name in {*self.rover.actuated, *drives}}
        return settle(
            self.rover, self.terrain, x=self.x, y=self.y, yaw=self.yaw, posture=posture, joints=held,
            gravity=self.gravity,
        )  # fmt: skip

    def begin(
        self, posture: Posture, joints: Mapping[str, float]
    ) -> tuple[Stance, dict[str, float]] | Refusal:
        """The stance to lift from and where each clutch locks, or why there is no lift."""
        refusal = self._refused()
        if refusal is not None:
            return refusal
        present = self.settle(posture, joints)
        locked = self._clutches(present, joints) if present.settled else self.no_stance(present)
        return locked if isinstance(locked, Refusal) else (present, locked)

    def no_stance(self, stance: Stance) -> Refusal:
        """The rover does not stand in the posture from which it should lift."""
        reason = f"the rover does not stand in this posture: {stance.status}, {stance.reason}"
        return Refusal(self.wheels, RefusalStatus.NO_STANCE, reason, stance.limiting)

    def lifted_instead(
        self, present: Stance, locked: Mapping[str, float], rockers: Mapping[str, float]
    ) -> str:
        """What the rover does where it settles by itself, clutches engaged and rockers turned, in words."""
        drives = {wheel.drive for wheel in self.rover.wheels}
        held = {
            name: present.joints[name] for name in present.joints if name in {*self.rover.actuated, *drives}
        }
        joints = {**held, **locked, **rockers}
        stance = settle(
            self.rover, self.terrain, x=self.x, y=self.y, yaw=self.yaw, joints=joints, gravity=self.gravity
        )  # fmt: skip
        if not stance.settled:
            return f"left to itself the rover would not stand: {stance.status}, {stance.reason}"
        up = [name for name, gap in stance.gaps.items() if gap > _UP]
        return f"left to itself the rover lifts {' and '.join(up) or 'no wheel'}"

    def _clutches(self, present: Stance, joints: Mapping[str, float]) -> dict[str, float] | Refusal:
        """The joints to lock and where: as given, else as settled."""
        locked = {}
        for side in self.sides:
            name = str(side.clutch)
            settled = present.joints[name]
            given = joints.get(name, settled)
            if abs(given - settled) > APART:
                reason = f"the joints given are no stance: {name} is at {given:.4g} and would settle at"
                return Refusal(self.wheels, RefusalStatus.NO_STANCE, f"{reason} {settled:.4g}", name)
            locked[name] = given
        return locked


def ask(
    rover: Rover,
    layout: Layout,
    wheels: Sequence[str],
    terrain: Terrain | None,
    place: tuple[float, float, float],
    gravity: float,
) -> Question:
    """A question whose words are known.

    Raises:
        InputError: no wheels, an unknown one, one named twice; a layout that is not the rover's.
    """
    layout.checked(rover)
    names = (wheels,) if isinstance(wheels, str) else tuple(wheels)
    if not names:
        raise InputError("no wheel to lift", element="wheels", cure="name one, or one a side")
    for name in names:
        layout.side_of(name)
        if names.count(name) > 1:
            raise InputError("is named twice", element=name, cure="name each wheel once")
    return Question(rover, layout, names, terrain or Terrain.flat(), *place, gravity)


def positive(name: str, value: float, *, zero: bool = False) -> float:
    """A finite number above 0, or from 0 on.

    Raises:
        InputError: it is not.
    """
    number = float(value)
    if math.isfinite(number) and (number > 0.0 or (zero and number == 0.0)):
        return number
    raise InputError("must be 0 or above" if zero else "must be above 0", element=name, value=value)
