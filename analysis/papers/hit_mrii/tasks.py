"""The paper's tasks as scripts of modes: what is rolled, raised and lifted where.

Distances and clearances are the paper's where its text has them. Where it has none (lengths of obstacles, how
far the robot stops before them) they are ours, and a comment says so.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

from rover_pin.analysis.papers.hit_mrii.ground import Box, ground
from rover_pin.control.actions import Drive, Reshape, SteerToward
from rover_pin.control.layout import Layout
from rover_pin.control.modes import (
    CHASSIS_LIFTING,
    ROLLING,
    Mode,
    Speeds,
    chassis_lifting,
    crabbing,
    creeping,
    rolling,
    wheel_lifting,
)
from rover_pin.kinematics.steering import Twist
from rover_pin.terrain import Terrain

HOME, HIGH = 0.25, 0.485
"""m: clearance at home, and that from which front wheels are lifted (ours: the CoM is to the rear there)."""

LOW = 0.2
"""m: clearance from which rear wheels are lifted (ours: the CoM is to the front there)."""

LIFT = 0.18
"""m over the ground: Tasks 6 and 7."""


@dataclass(frozen=True)
class Task:
    """One of the paper's tasks.

    Attributes:
        key: `3`, or `12 RF 100` where a task has several trials.
        title: what is done.
        modes: of the rover's sides and speeds.
        terrain: what it is done on.
        clearance: m, at the start.
        x: m, of the root link at the start.
    """

    key: str
    title: str
    modes: Callable[[Layout, Speeds], list[Mode]]
    terrain: Callable[[], Terrain] = field(default=Terrain.flat)
    clearance: float = HOME
    x: float = 0.0


def task_1() -> Task:
    """WRM: 25 mm/s for 153.82 s."""
    return Task("1", "roll", lambda sides, speeds: [rolling(sides, speeds, 0.025 * 153.82)])


def task_2() -> Task:
    """WRM, WCM to the right, WRM, WCM to the left, WRM past two walls.

    The paper prints the sums, 6422.75 mm ahead and 1363.75 mm across; how they are shared is ours, and so are
    the walls.
    """
    first, second, across = 1.8, 2.7, 1.36375 / 2
    third = 6.42275 - first - second
    walls = (
        Box((first + 1.1, first + 1.3), (0.15, 1.15), 0.3),
        Box((first + second + 1.1, first + second + 1.3), (-1.75, -0.85), 0.3),
    )

    def modes(sides: Layout, speeds: Speeds) -> list[Mode]:
        right, left = (crabbing(sides, speeds, across, sign * math.pi / 2) for sign in (-1.0, 1.0))
        ahead = [rolling(sides, speeds, way) for way in (first, second, third)]
        return [ahead[0], right, ahead[1], left, ahead[2]]

    return Task(
        "2", "crab around walls", modes, partial(ground, walls, (-1.6, 8.4), (-2.2, 1.6), "two walls")
    )


def task_3() -> Task:
    """RCLM over piles of 300 and 450 mm: 250 to 330 to 480 to 250 mm of clearance."""
    piles = (Box((1.1, 1.5), (-0.3, 0.3), 0.3), Box((2.7, 3.1), (-0.3, 0.3), 0.45))

    def modes(sides: Layout, speeds: Speeds) -> list[Mode]:
        return [
            rolling(sides, speeds, 0.5),
            chassis_lifting(sides, speeds, 0.33),
            rolling(sides, speeds, 1.65),
            chassis_lifting(sides, speeds, 0.48),
            rolling(sides, speeds, 1.75),
            chassis_lifting(sides, speeds, HOME),
        ]

    return Task(
        "3", "raise over two piles", modes, lambda: ground(piles, (-1.6, 5.6), (-1.2, 1.2), "two piles")
    )


CREEP = 0.1444
"""m of lift in Tasks 4 and 5: what the paper's five errors and their 17.74 % come from."""


def task_4() -> Task:
    """RCM on level ground, five times."""
    return Task("4", "creep", lambda sides, speeds: [creeping(sides, speeds, HOME, HOME + CREEP, 5)])


def task_5() -> Task:
    """WRM for 437.75 mm up 10 deg, then RCM four times; heights as in Task 4."""

    def modes(sides: Layout, speeds: Speeds) -> list[Mode]:
        return [rolling(sides, speeds, 0.43775), creeping(sides, speeds, HOME, HOME + CREEP, 4)]

    return Task("5", "creep up 10 deg", modes, lambda: Terrain.slope(10.0))


def task_6() -> Task:
    """SWLM: the right wheels over a brick of 150 mm, one after the other.

    The brick is 80 mm long (ours): between front and middle wheel of a raised chassis there is little room.
    """
    brick = Box((0.94, 1.02), (-0.9, -0.4), 0.15)

    def modes(sides: Layout, speeds: Speeds) -> list[Mode]:
        return [
            rolling(sides, speeds, 0.08),
            chassis_lifting(sides, speeds, HIGH),
            wheel_lifting(sides, speeds, ["RF"], LIFT, 0.74),
            chassis_lifting(sides, speeds, HOME),
            wheel_lifting(sides, speeds, ["RM"], LIFT, 0.5),
            chassis_lifting(sides, speeds, LOW),
            rolling(sides, speeds, 0.28),
            wheel_lifting(sides, speeds, ["RB"], LIFT, 0.5),
            chassis_lifting(sides, speeds, HOME),
        ]

    over = partial(ground, (brick,), (-1.7, 4.3), (-1.2, 1.2), "a brick")
    return Task("6", "right wheels over a brick", modes, over, x=-0.1)


STEP = 0.12
"""m: a stair's height (ours; the paper prints none)."""


def task_7() -> Task:
    """DWLM: both front, both middle, both rear wheels onto a stair.

    The rear pair cannot be lifted there: whatever the rockers' angle, the centre of mass is then behind the
    middle wheels, and the front pair would have to be held down.
    """
    edge = 0.96

    def posture(sides: Layout, speeds: Speeds, degrees: float) -> Mode:
        behind = tuple(wheel for side in sides.sides for wheel in side.wheels[1:])
        angle = math.radians(degrees)
        return Mode(
            CHASSIS_LIFTING, (Reshape(sides, None, speeds.lift, behind, angle=angle, label="rockers"),)
        )

    def modes(sides: Layout, speeds: Speeds) -> list[Mode]:
        return [
            rolling(sides, speeds, 0.08),
            chassis_lifting(sides, speeds, HIGH),
            wheel_lifting(sides, speeds, ["LF", "RF"], LIFT, 0.56),
            posture(sides, speeds, 0.0),
            rolling(sides, speeds, 0.1),
            wheel_lifting(sides, speeds, ["LM", "RM"], LIFT, 0.42),
            posture(sides, speeds, -7.6),
            rolling(sides, speeds, 0.4),
            wheel_lifting(sides, speeds, ["LB", "RB"], LIFT, 0.5),
            posture(sides, speeds, 0.0),
        ]

    stair = Box((edge, 9.0), (-9.0, 9.0), STEP)
    up = partial(ground, (stair,), (-1.7, 4.3), (-1.2, 1.2), "a stair")
    return Task("7", "pairs of wheels onto a stair", modes, up, x=-0.1)


def task_10() -> Task:
    """RCLM while it rolls at 15 mm/s: 250, 450, 150, 550, 250 mm of clearance."""

    def modes(sides: Layout, speeds: Speeds) -> list[Mode]:
        actions: list[Reshape | Drive] = []
        for goal in (0.45, 0.15, 0.55, HOME):
            actions.append(Drive(sides, Twist(forward=0.015), 0.15, label="roll"))
            actions.append(Reshape(sides, goal, speeds.lift, forward=0.015, label=f"to {1e3 * goal:.0f} mm"))
        return [Mode(CHASSIS_LIFTING, tuple(actions))]

    return Task("10", "change height while it rolls", modes)


ROCK = (0.15, 0.55, 0.19)
"""m: length, width and height of Task 14's obstacle."""

MARGIN = 0.3
"""m kept around it."""

SLOW = 0.015
"""m/s: Task 14."""


AROUND = 1.1
"""m to the side, on which wheels pass the obstacle: half of both widths and 100 mm (ours)."""


def task_14() -> list[Task]:
    """Around and over one obstacle: WRM, WCM, RCLM, SWLM.

    The paper keeps the robot's centre 300 mm off the obstacle, which leaves the wheels on it; ours pass it.
    On arcs the robot starts 1.2 m before the obstacle (ours): from 300 mm it could not turn away.
    """
    length = 1.85  # over the wheels
    small = ((-1.7, 6.0), (-1.4, 2.6))

    def rock(before: float, y: float = -0.5 * ROCK[1]) -> partial[Terrain]:
        x = 0.5 * length + before
        return partial(ground, (Box((x, x + ROCK[0]), (y, y + ROCK[1]), ROCK[2]),), *small, "a rock")

    def arcs(sides: Layout, speeds: Speeds) -> list[Mode]:
        radius, turn = 1.3, math.acos(1.0 - AROUND / 2.6)
        slow = Speeds(SLOW, speeds.lift, speeds.steer)
        out = [rolling(sides, slow, radius * turn, sign / radius) for sign in (1.0, -1.0)]
        return [*out, rolling(sides, slow, 0.75), *reversed(out)]

    def crab(sides: Layout, speeds: Speeds) -> list[Mode]:
        slow = Speeds(SLOW, speeds.lift, speeds.steer)
        aside = [crabbing(sides, slow, AROUND, sign * math.pi / 2) for sign in (1.0, -1.0)]
        return [aside[0], rolling(sides, slow, 2 * MARGIN + ROCK[0] + length), aside[1]]

    def raised(sides: Layout, speeds: Speeds) -> list[Mode]:
        slow = Speeds(SLOW, speeds.lift, speeds.steer)
        up, down = (chassis_lifting(sides, slow, goal) for goal in (HOME + 0.112, HOME))
        return [up, rolling(sides, slow, 2 * MARGIN + ROCK[0] + length), down]

    def lifted(sides: Layout, speeds: Speeds) -> list[Mode]:
        slow = Speeds(SLOW, speeds.lift, speeds.steer)
        return [
            chassis_lifting(sides, slow, HIGH),
            wheel_lifting(sides, slow, ["RF"], 0.22, 0.8),
            chassis_lifting(sides, slow, HOME),
            rolling(sides, slow, -0.1),
            wheel_lifting(sides, slow, ["RM"], 0.22, 0.65),
            chassis_lifting(sides, slow, LOW),
            rolling(sides, slow, 0.2),
            wheel_lifting(sides, slow, ["RB"], 0.21, 0.6),
            chassis_lifting(sides, slow, HOME),
        ]

    return [
        Task("14 WRM", "around a rock on arcs", arcs, rock(1.2)),
        Task("14 WCM", "around a rock crabbing", crab, rock(MARGIN)),
        Task("14 RCLM", "over a rock, raised", raised, rock(MARGIN)),
        Task("14 SWLM", "over a rock wheel by wheel", lifted, rock(-0.062, -0.927), x=-0.12),
    ]


def task_15() -> list[Task]:
    """Steering at two yaw rates while the chassis is lowered from 450 mm and the wheelbase grows.

    The radius of 1.5 m and the rockers' rate are ours. Wheels are turned in place at a third of the usual
    rate: on the leaning axes of a raised chassis they scrub, and motion constraint 2 counts that.
    """
    found = []
    for rate in (0.02, 0.03):

        def modes(sides: Layout, speeds: Speeds, rate: float = rate) -> list[Mode]:
            twist = Twist.about(0.0, 1.5, rate)
            rockers = dict.fromkeys((side.rocker for side in sides.sides), -0.009)
            turn = Drive(sides, twist, 60.0 * 1.5 * rate, True, rockers, "steer and lower")
            return [Mode(ROLLING, (SteerToward(sides, twist, 0.3 * speeds.steer, rates=rockers), turn))]

        found.append(Task(f"15 {rate:g}", f"steer at {rate:g} rad/s and lower", modes, clearance=0.45))
    return found


def lifts() -> list[Task]:
    """Tasks 12 and 13: wheels and pairs lifted and 900 mm rolled, from the clearances of Task 6 (ours)."""
    found = []
    for number, wheels, height, clearance in (
        *(("12", ("RF",), height, HIGH) for height in (0.1, 0.15, 0.2)),
        *(("12", ("LF", "RF"), height, HIGH) for height in (0.1, 0.15, 0.2)),
        ("13", ("RM",), 0.2, HOME),
        ("13", ("RB",), 0.2, LOW),
        ("13", ("LM", "RM"), 0.2, HOME),
        ("13", ("LB", "RB"), 0.2, LOW),
    ):
        name = f"{number} {'+'.join(wheels)} {1e3 * height:.0f}"

        def modes(
            sides: Layout, speeds: Speeds, wheels: tuple[str, ...] = wheels, height: float = height
        ) -> list[Mode]:
            return [wheel_lifting(sides, speeds, wheels, height, 0.9)]

        found.append(Task(name, f"{' and '.join(wheels)} lifted", modes, clearance=clearance))
    return found
