"""Motion modes as sequences of actions; hybrids are their sums.

Wheel rolling (WRM), wheel crabbing (WCM), chassis lifting (RCLM), creeping (RCM), single and double wheel
lifting (SWLM, DWLM), as the HIT-MRII paper names them, for any rover with two sides.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from rover_pin.control.actions import Action, Drive, Engage, LiftWheels, Release, Reshape, Start, SteerToward
from rover_pin.control.layout import Layout
from rover_pin.control.lifting import Refusal, prepare_lift
from rover_pin.errors import InputError
from rover_pin.kinematics.instant import Instant
from rover_pin.kinematics.steering import Twist, steering_joints
from rover_pin.kinematics.tasks.clearance import clearance as clearance_of
from rover_pin.rover import Rover

ROLLING, CRABBING, CHASSIS_LIFTING = "rolling", "crabbing", "chassis_lifting"
CREEPING, SINGLE_LIFT, DOUBLE_LIFT = "creeping", "single_lift", "double_lift"
MODES = (ROLLING, CRABBING, CHASSIS_LIFTING, CREEPING, SINGLE_LIFT, DOUBLE_LIFT)

STRAIGHT = 1e-3
"""rad: steering this near to 0 is straight."""

NEAR = 1e-3
"""m: a clearance this near to the one that is needed will do."""

LEVEL = 1e-3
"""rad: rockers this near to each other stand alike."""


@dataclass(frozen=True)
class Speeds:
    """How fast modes move.

    Attributes:
        roll: m/s of the root link.
        lift: m/s of the belly or of a lifted wheel.
        steer: rad/s.
    """

    roll: float = 0.025
    lift: float = 0.0036
    steer: float = 0.1

    def __post_init__(self) -> None:
        for word in ("roll", "lift", "steer"):
            value = getattr(self, word)
            if not (math.isfinite(value) and value > 0.0):
                raise InputError("must be above 0", element=f"speed: {word}", value=value)


@dataclass(frozen=True)
class Mode:
    """A named sequence of actions.

    Attributes:
        name: of MODES.
        actions: in order.
    """

    name: str
    actions: tuple[Action, ...]

    @property
    def words(self) -> tuple[str, ...]:
        """Names of its actions."""
        return tuple(action.name for action in self.actions)


def rolling(layout: Layout, speeds: Speeds, way: float, curvature: float = 0.0) -> Mode:
    """Roll a way [m] with the suspension still, along an arc of that curvature [1/m], left positive.

    On an arc the wheels turn to its centre first and back to straight afterwards.
    """
    sign = math.copysign(1.0, way)
    twist = Twist(forward=sign * speeds.roll, yaw=sign * speeds.roll * curvature)
    word = "roll" if curvature == 0.0 else "roll on an arc"
    drive = Drive(layout, twist, abs(way), label=word)
    if curvature == 0.0:
        return Mode(ROLLING, (drive,))
    return Mode(ROLLING, _steered(layout, twist, speeds, drive))


def crabbing(layout: Layout, speeds: Speeds, way: float, direction: float = 0.5 * math.pi) -> Mode:
    """Turn all wheels in place, drive a way [m] in that direction [rad, from the heading], turn them back."""
    sign = math.copysign(1.0, way)
    v = sign * speeds.roll
    twist = Twist(forward=v * math.cos(direction), left=v * math.sin(direction))
    drive = Drive(layout, twist, abs(way), label="crab")
    return Mode(CRABBING, _steered(layout, twist, speeds, drive))


def chassis_lifting(layout: Layout, speeds: Speeds, goal: float) -> Mode:
    """Raise or lower the chassis to a clearance [m], front wheels following the others, which are braked."""
    return Mode(CHASSIS_LIFTING, (Reshape(layout, goal, speeds.lift, _behind(layout)),))


def creeping(
    layout: Layout, speeds: Speeds, low: float, high: float, times: int, hold: str = "drive"
) -> Mode:
    """Raise with the front braked, lower with the others braked, again and again: it creeps forward.

    Args:
        layout: the rover's sides.
        speeds: of the modes.
        low: m, clearance at the bottom.
        high: m, clearance at the top.
        times: how often.
        hold: what a brake holds, the `drive` (the wheel rolls with the arm that carries it) or the `wheel`.
    """
    if times < 1 or not low < high:
        raise InputError("creeping needs low < high and at least one time", element=CREEPING,
                         value=f"{low:g} to {high:g} m, {times} times")  # fmt: skip
    front = tuple(side.wheels[0] for side in layout.sides)
    up = Reshape(layout, high, speeds.lift, front, hold, label="raise")
    down = Reshape(layout, low, speeds.lift, _behind(layout), hold, label="lower")
    return Mode(CREEPING, (up, down) * times)


def wheel_lifting(layout: Layout, speeds: Speeds, wheels: Sequence[str], height: float, way: float) -> Mode:
    """Engage the clutches, lift wheels, roll a way [m], let them down, release.

    Args:
        layout: the rover's sides.
        speeds: of the modes.
        wheels: one, or two of different sides.
        height: m over the ground below.
        way: m rolled while they hang; 0 for none.
    """
    lifted = tuple(wheels)
    clutches = tuple(_clutch(layout, wheel) for wheel in lifted)
    actions: list[Action] = [Engage(clutches), LiftWheels(layout, lifted, height, speeds.lift)]
    if way != 0.0:
        twist = Twist(forward=math.copysign(speeds.roll, way))
        actions.append(Drive(layout, twist, abs(way), label="roll with lifted wheels"))
    actions += [LiftWheels(layout, lifted, 0.0, speeds.lift), Release(clutches)]
    return Mode(SINGLE_LIFT if len(lifted) == 1 else DOUBLE_LIFT, tuple(actions))


def prepared_lifting(
    rover: Rover,
    layout: Layout,
    speeds: Speeds,
    wheels: Sequence[str],
    height: float,
    way: float,
    *,
    clearance: float,
    reserve: float = 5.0,
) -> list[Mode]:
    """Raise or lower the chassis as far as a lift needs it, lift, roll, let down, and go back.

    Args:
        rover: the rover, on level ground.
        layout: its sides.
        speeds: of the modes.
        wheels: one, or two of different sides.
        height: m over the ground below.
        way: m rolled while they hang.
        clearance: m, where it stands and goes back to.
        reserve: N that every standing wheel has to keep.

    Raises:
        InputError: no clearance makes the lift possible; says why, in the words of the statics.
    """
    found = prepare_lift(
        rover, layout, wheels, height, posture={"clearance": clearance}, reserve=reserve
    )  # fmt: skip
    if isinstance(found, Refusal):
        raise InputError(f"is not lifted: {found.reason}", element=" and ".join(wheels))
    lifting = wheel_lifting(layout, speeds, wheels, height, way)
    if found.clearance is None or abs(found.clearance - clearance) < NEAR:
        return [lifting]
    there, back = (chassis_lifting(layout, speeds, goal) for goal in (found.clearance, clearance))
    return [there, lifting, back]


def refuse_start(mode: Mode, layout: Layout, at: Instant, start: Start) -> None:
    """Refuse a mode from a posture it cannot start in.

    Raises:
        InputError: wheels hang, a clutch is engaged, wheels are steered where they have to be straight, or
            sides stand differently where both move together; says which and what to do first.
    """
    grip = start.grip
    if grip.lifted:
        raise InputError(f"{mode.name} starts with every wheel on the ground", element=grip.lifted[0],
                         cure="let it down first")  # fmt: skip
    if grip.clutches:
        raise InputError(f"{mode.name} starts with the clutches released", element=next(iter(grip.clutches)),
                         cure="release it first")  # fmt: skip
    if mode.name in (CHASSIS_LIFTING, CREEPING, SINGLE_LIFT, DOUBLE_LIFT):
        for joint in steering_joints(at).values():
            angle = float(at.q[at.rover.column[joint]])
            if abs(angle) > STRAIGHT:
                raise InputError(
                    f"{mode.name} starts with the wheels straight",
                    element=joint,
                    value=f"{math.degrees(angle):.4g} deg",
                    cure="steer it to 0 first",
                )
    if mode.name in (CHASSIS_LIFTING, CREEPING):
        left, right = (float(at.q[at.rover.column[side.rocker]]) for side in layout.sides)
        if abs(left - right) > LEVEL:
            raise InputError(
                f"{mode.name} moves both sides together and starts with their rockers alike",
                element=f"{layout.left.rocker}, {layout.right.rocker}",
                value=f"{math.degrees(left):.4g} and {math.degrees(right):.4g} deg",
                cure="bring them to the same angle first",
            )
        if not at.rover.belly:
            clearance_of(at)  # says that a belly is missing


def _steered(layout: Layout, twist: Twist, speeds: Speeds, drive: Drive) -> tuple[Action, ...]:
    there = SteerToward(layout, twist, speeds.steer)
    return there, drive, SteerToward(layout, None, speeds.steer, "turn the wheels back")


def _behind(layout: Layout) -> tuple[str, ...]:
    return tuple(wheel for side in layout.sides for wheel in side.wheels[1:])


def _clutch(layout: Layout, wheel: str) -> str:
    side = layout.side_of(wheel)
    if side.clutch is None:
        raise InputError(
            "a wheel is lifted by a side with a clutch", element=f"{side.name}: clutch", value=wheel
        )
    return side.clutch


def hybrid(name: str, *modes: Mode) -> Mode:
    """Modes one after the other under one name, and so under one set of thresholds."""
    return Mode(name, tuple(action for mode in modes for action in mode.actions))
