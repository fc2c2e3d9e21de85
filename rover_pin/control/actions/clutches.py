"""Engaging and releasing clutches, the rover at a standstill."""

from __future__ import annotations

from dataclasses import dataclass

from rover_pin.control.actions.action import Action, Command, Grip, Start
from rover_pin.control.lifting.clutch import engage
from rover_pin.errors import InputError, nearest
from rover_pin.kinematics.instant import Instant
from rover_pin.kinematics.rows import columns


@dataclass(frozen=True)
class Engage(Action):
    """Hold passive joints where they stand.

    Attributes:
        joints: lockable joints.
    """

    joints: tuple[str, ...]

    @property
    def name(self) -> str:
        """What people read."""
        return f"engage {' and '.join(self.joints)}"

    def check(self, at: Instant, start: Start) -> None:
        """The joints can be locked and stand still.

        Raises:
            InputError: a joint that cannot be locked, or that moves: its clutch would tear.
        """
        _refuse_unlockable(at, self.joints)
        engage(self.joints, {joint: float(start.velocity[at.rover.column[joint]]) for joint in self.joints})

    def grip(self, start: Start) -> Grip:
        """The clutches hold where the joints stood."""
        places = columns(start.at, self.name, self.joints)
        held = {joint: float(start.at.q[i]) for joint, i in zip(self.joints, places, strict=True)}
        return Grip({**start.grip.clutches, **held}, start.grip.lifted)

    def command(self, at: Instant, start: Start, dt: float) -> Command:
        """Nothing moves."""
        return Command(())

    def left(self, at: Instant, start: Start) -> float:
        """It is done at once."""
        return 0.0

    def undone(self, start: Start, now: Start) -> Action:
        """Release those that were not engaged before."""
        return Release(tuple(joint for joint in self.joints if joint not in start.grip.clutches))


@dataclass(frozen=True)
class Release(Action):
    """Let passive joints go; every wheel that they held up must stand.

    Attributes:
        joints: lockable joints.
    """

    joints: tuple[str, ...]

    @property
    def name(self) -> str:
        """What people read."""
        return f"release {' and '.join(self.joints)}"

    def check(self, at: Instant, start: Start) -> None:
        """The joints can be locked and no wheel hangs.

        Raises:
            InputError: a joint that has no clutch, or a wheel that is still lifted: it would fall.
        """
        _refuse_unlockable(at, self.joints)
        if start.grip.lifted:
            raise InputError("hangs and would fall", element=" and ".join(start.grip.lifted),
                             cure="let it down before the clutch is released")  # fmt: skip

    def grip(self, start: Start) -> Grip:
        """Without these clutches."""
        kept = {name: value for name, value in start.grip.clutches.items() if name not in self.joints}
        return Grip(kept, start.grip.lifted)

    def command(self, at: Instant, start: Start, dt: float) -> Command:
        """Nothing moves."""
        return Command(())

    def left(self, at: Instant, start: Start) -> float:
        """It is done at once."""
        return 0.0

    def undone(self, start: Start, now: Start) -> Action:
        """Engage those that were engaged before."""
        return Engage(tuple(joint for joint in self.joints if joint in start.grip.clutches))


def _refuse_unlockable(at: Instant, joints: tuple[str, ...]) -> None:
    for joint in joints:
        if joint not in at.rover.lockable:
            raise InputError("is no joint that can be locked", element=joint,
                             cure=nearest(joint, at.rover.lockable))  # fmt: skip
