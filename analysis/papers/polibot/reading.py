"""A stance in the paper's words: mm, deg, N; X rearwards from wheel 3's contact, nose down positive."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.mechanism.kinematics import Kinematics

if TYPE_CHECKING:
    from rover_pin.numerics import Array
    from rover_pin.rover import Rover
    from rover_pin.statics.stance import Stance

ARMS = ("bogie_rear", "bogie_front", "rear_arm", "front_arm")
"""Joints of theta1 to theta4; the paper's angles are the arms' own, without the pitch in them."""

TOUCHING = 1e-3
"""N, above which a wheel counts as in contact."""


@dataclass(frozen=True)
class Reading:
    """What the paper tabulates of a stance; NaN throughout where the rover does not stand.

    Attributes:
        x_a: mm, of the sprocket's axis, rearwards of wheel 3's contact.
        z_a: mm.
        theta: deg, pitch.
        arms: (4,) deg, theta1 to theta4; empty where the rover has no such arms.
        tension: N, of the first track.
        loads: N, by wheel that should carry.
        springs: N, by spring.
    """

    x_a: float
    z_a: float
    theta: float
    arms: tuple[float, ...]
    tension: float
    loads: dict[str, float]
    springs: dict[str, float]

    @property
    def touching(self) -> int:
        """n_cont: wheels that carry."""
        return sum(load > TOUCHING for load in self.loads.values())

    @property
    def spread(self) -> float:
        """sigma_N, the paper's (12), over the wheels that should carry."""
        loads = np.array(list(self.loads.values()))
        return float(np.std(loads) / np.mean(loads))


def read(stance: Stance) -> Reading:
    """The paper's quantities of a stance."""
    rover = stance.rover
    nan = float("nan")
    names = [rover.shapes[i].name for i in rover.bearing]
    if not stance.settled:
        return Reading(nan, nan, nan, (nan,) * 4, nan, dict.fromkeys(names, nan), {})
    front = front_wheel(rover)
    place = wheel_centers(stance)[front][0]
    pitch = float(np.degrees(stance.rpy[1]))
    arms = tuple(float(np.degrees(stance.joints[name])) + pitch for name in ARMS if name in stance.joints)
    return Reading(
        1e3 * float(place - stance.position[0]),
        1e3 * float(stance.position[2]),
        pitch,
        arms,
        next(iter(stance.tensions.values())),
        {name: stance.loads[name] for name in names},
        dict(stance.springs),
    )


def front_wheel(rover: Rover) -> str:
    """The foremost wheel that should carry, as the rover is at home."""
    return _from_the_rear(rover)[-1]


def rear_wheel(rover: Rover) -> str:
    """The last wheel that should carry, as the rover is at home."""
    return _from_the_rear(rover)[0]


def _from_the_rear(rover: Rover) -> list[str]:
    at = Kinematics(rover.model, rover.model.createData(), np.array(rover.neutral))
    names = {rover.shapes[i].name for i in rover.bearing}
    places = {w.name: float(at.point(w.joint, w.center)[0]) for w in rover.wheels if w.name in names}
    return sorted(places, key=places.__getitem__)


def wheel_centers(stance: Stance) -> dict[str, Array]:
    """(x, z) [m, world] of every wheel's centre."""
    at = kinematics(stance)
    return {w.name: at.point(w.joint, w.center)[[0, 2]] for w in stance.rover.wheels}


def kinematics(stance: Stance) -> Kinematics:
    """The model as it stands."""
    model = stance.rover.model
    return Kinematics(model, model.createData(), stance.configuration)
