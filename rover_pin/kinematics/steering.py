"""Steering about an instant centre: the angle at which every steered wheel rolls where it is carried to.

The centre may lie anywhere, on the line through the rover's middle or off it, and the suspension may be in
motion: the direction is that of the velocity of the place where the wheel touches.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from rover_pin.errors import InputError
from rover_pin.kinematics.instant import Instant
from rover_pin.kinematics.model import complete
from rover_pin.kinematics.rolling import contact_rows
from rover_pin.kinematics.rows import number
from rover_pin.numerics import Array, frozen

UPRIGHT = 0.7
"""Cosine: a driven joint above a wheel that is this near to the vertical at home steers it."""

STILL = 1e-9
"""m/s: a wheel carried this slowly keeps its angle."""

EXACT = 1e-10
"""rad: what is left to turn when the angles are exact."""

REFINEMENTS = 20


@dataclass(frozen=True)
class Twist:
    """Motion of the root link in its heading's frame.

    Attributes:
        forward: m/s.
        left: m/s.
        yaw: rad/s.

    Raises:
        InputError: something that is no finite number.
    """

    forward: float = 0.0
    left: float = 0.0
    yaw: float = 0.0

    def __post_init__(self) -> None:
        for word in ("forward", "left", "yaw"):
            number(f"twist: {word}", getattr(self, word))

    @classmethod
    def about(cls, x: float, y: float, yaw: float) -> Twist:
        """Turning at `yaw` rad/s about the centre x ahead of and y to the left of the root link [m].

        Raises:
            InputError: something that is no finite number.
        """
        for name, value in (("x", x), ("y", y), ("yaw", yaw)):
            number(f"instant centre: {name}", value)
        return cls(forward=yaw * y, left=-yaw * x, yaw=yaw)

    @property
    def centre(self) -> tuple[float, float] | None:
        """The instant centre (x ahead, y left) [m] of the root link, or None where it does not turn."""
        if self.yaw == 0.0:
            return None
        return -self.left / self.yaw, self.forward / self.yaw

    def velocity(self, at: Instant) -> Array:
        """(nv,) of the base alone."""
        v = np.zeros(at.rover.model.nv)
        c, s = math.cos(at.heading), math.sin(at.heading)
        v[0], v[1], v[3] = c * self.forward - s * self.left, s * self.forward + c * self.left, self.yaw
        return v


def steering_joints(at: Instant) -> Mapping[str, str]:
    """The steering joint of each wheel that has one: the nearest driven joint above it upright at home."""
    return at.bodies.once("steering", lambda: _find_steering(at.bodies.at(at.rover.neutral)))


def _find_steering(home: Instant) -> Mapping[str, str]:
    model, rover = home.bodies.model, home.rover
    found = {}
    for place, wheel in enumerate(rover.wheels):
        joint = int(home.bodies.packed.joints[place])
        while joint > 1:
            name = str(model.names[joint])
            if name in rover.actuated and abs(float(home.jacobian[5, model.idx_vs[joint]])) > UPRIGHT:
                found[wheel.name] = name
                break
            joint = int(model.parents[joint])
    return found


def steering_for(at: Instant, twist: Twist, *, rates: Mapping[str, float] | None = None) -> dict[str, float]:
    """Angles [rad] of all steering joints for a motion of the base.

    A wheel rolls back rather than turn its steering beyond a joint limit; of two angles within the limits it
    takes the nearer to where it stands. Steering axes may lean with their arms: the angles are refined until
    every wheel rolls where it is carried to.

    Args:
        at: the instant; angles count from the steering as it stands.
        twist: of the root link.
        rates: of other coordinates that carry wheels along while it drives [rad/s or m/s], a rocker's.

    Raises:
        InputError: a wheel that cannot be steered to where it has to go, named with the angle asked for.
    """
    carried = _carrying(at, twist, rates or {})
    joints = steering_joints(at)
    angles = {joint: float(at.q[at.rover.column[joint]]) for joint in joints.values()}
    tried = at
    for _ in range(REFINEMENTS):
        turns = _turns(tried, joints, carried(tried))
        for wheel, joint in joints.items():
            angles[joint] = _nearest(tried, wheel, joint, angles[joint], turns[wheel])
        if max((abs(math.remainder(turn, math.pi)) for turn in turns.values()), default=0.0) < EXACT:
            break
        q = tried.q.copy()
        q[[at.rover.column[joint] for joint in angles]] = list(angles.values())
        tried = at.bodies.at(q)
    return angles


def _carrying(at: Instant, twist: Twist, rates: Mapping[str, float]) -> Callable[[Instant], Array]:
    """What carries the wheels, (nv,): the base alone, or with what moving rockers bring along."""
    if not rates:
        velocity = twist.velocity(at)
        return lambda tried: velocity
    still = {name: 0.0 for name in at.rover.actuated if name not in rates}
    known = {**still, **rates, "forward": twist.forward, "left": twist.left, "yaw": twist.yaw}
    return lambda tried: complete(tried, known, directions=("normal",)).velocity


def _turns(at: Instant, joints: Mapping[str, str], velocity: Array) -> dict[str, float]:
    """By how much each steering has to turn for its wheel to roll where it is carried to [rad]."""
    which = at.index(list(joints))
    rolling, across = np.split(_carried(at, which) @ velocity, 2)
    turns = {}
    for k, (wheel, joint) in enumerate(joints.items()):
        ahead, left = float(rolling[k]), float(across[k])
        if math.hypot(ahead, left) < STILL:
            turns[wheel] = 0.0
            continue
        axis = at.jacobian[3:, at.rover.column[joint]]
        sense = 1.0 if float(axis @ at.contacts[which[k], 4:7]) > 0.0 else -1.0
        turns[wheel] = sense * math.atan2(left, ahead)
    return turns


def _carried(at: Instant, which: np.ndarray[tuple[int], np.dtype[np.int64]]) -> Array:
    """(2k, nv) velocity along and across of where wheels touch, their own drives held."""
    rows = contact_rows(at, which, ("roll", "slip"))
    drives = [at.rover.wheels[i].drive for i in which.tolist()]
    rows[:, [at.rover.column[drive] for drive in drives if drive is not None]] = 0.0
    return rows


def _nearest(at: Instant, wheel: str, joint: str, here: float, turn: float) -> float:
    column = at.rover.column[joint]
    low, high = float(at.rover.lower[column]), float(at.rover.upper[column])
    tried = [here + turn + k * math.pi for k in (0, -2, 2, -1, 1)]  # of two alike, rolling forward
    allowed = [angle for angle in tried if low - 1e-9 <= angle <= high + 1e-9]
    if not allowed:
        raise InputError(
            f"{wheel} cannot be steered to where it has to go",
            element=joint,
            value=f"{math.degrees(here + turn):.4g} deg",
            cure=f"the joint reaches from {math.degrees(low):.4g} to {math.degrees(high):.4g} deg",
        )
    return float(np.clip(min(allowed, key=lambda angle: round(abs(angle - here), 9)), low, high))


def turning_centre(at: Instant) -> Array:
    """(2,) m: where the axes of all wheels meet best, in the root link's heading frame; least squares.

    NaN where the axes are parallel: the rover drives straight or crabs.
    """
    count = len(at.rover.wheels)
    c, s = math.cos(at.heading), math.sin(at.heading)
    turned = np.array([[c, s], [-s, c]])
    along = at.rolling[:count, :2] @ turned.T
    along /= np.linalg.norm(along, axis=1)[:, None]
    places = (at.contacts[:count, 1:3] - at.q[:2]) @ turned.T
    if np.linalg.matrix_rank(along, tol=1e-6) < 2:
        return frozen([np.nan, np.nan])
    return frozen(np.linalg.lstsq(along, np.einsum("ij,ij->i", along, places), rcond=None)[0])
