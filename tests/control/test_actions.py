"""Actions one by one: each gets where it says, its undoing goes back, and each refuses what it cannot do."""

import math

import numpy as np
import pytest
from sides import HIT as SIDES

import rover_pin as rp
from rover_pin.control.actions import (
    Drive,
    Engage,
    Grip,
    LiftWheels,
    Release,
    Reshape,
    Start,
    Steer,
    SteerToward,
)
from rover_pin.control.execution import Execution
from rover_pin.control.layout import Layout, Side
from rover_pin.control.modes import Speeds, crabbing, creeping, hybrid, rolling, wheel_lifting
from rover_pin.errors import InputError
from rover_pin.kinematics.advance import advance
from rover_pin.kinematics.inverse import InverseKinematics
from rover_pin.kinematics.steering import Twist, steering_joints, turning_centre
from rover_pin.kinematics.tasks.clearance import clearance
from rover_pin.kinematics.tasks.wheel_lift import height

FLAT = rp.Terrain.flat()
DT = 0.02
MOST = 4000


@pytest.fixture(scope="module")
def inverse(hit):
    return InverseKinematics(hit, FLAT)


def stand(inverse, raised=0.3, grip=Grip()):
    at = inverse.at(rp.settle(inverse.rover, FLAT, posture={"clearance": raised}))
    return Start(at, grip, np.zeros(len(at.q)))


def begun(inverse, action, start, back=False):
    return Execution(inverse, action, start, DT, going_back=back)


def do(inverse, action, start, most=MOST, back=False):
    """The execution, and where the action ends or is after so many cycles."""
    execution, at = begun(inverse, action, start, back), start.at
    for _ in range(most):
        if execution.finished(at):
            break
        found = execution.solve(at, execution.command(at))
        assert found.solved, found.reason
        at = advance(at, found.velocity, DT)
    else:
        assert most < MOST, execution.action.left(at, start)
        return execution, Start(at, execution.grip, np.zeros(len(at.q)))
    return execution, Start(at, execution.grip_after, np.zeros(len(at.q)))


def as_it_was(at, before, within):
    """The same posture and place; drives, which steps of first order take there and back, within 2e-4 rad."""
    drives = [at.rover.column[wheel.drive] for wheel in at.rover.wheels]
    assert np.delete(at.q, drives) == pytest.approx(np.delete(before.q, drives), abs=within)
    assert at.q[drives] == pytest.approx(before.q[drives], abs=2e-4)


ACTIONS = {
    "steer": Steer(SIDES, {"LF_st": 0.4, "RB_st": -0.3}, 1.0),
    "steer to a centre": SteerToward(SIDES, Twist.about(0.1, 1.5, 0.1), 1.0),
    "roll": Drive(SIDES, Twist(forward=0.1), 0.4),
    "roll back": Drive(SIDES, Twist(forward=-0.1), 0.4),
    "raise": Reshape(SIDES, 0.33, 0.01, ("LM", "LB", "RM", "RB")),
    "raise on standing wheels": Reshape(SIDES, 0.33, 0.01, ("LF", "RF"), "wheel"),
    "lower": Reshape(SIDES, 0.28, 0.01, ("LF", "RF")),
    "to an angle": Reshape(SIDES, None, 0.01, ("LM", "RM"), angle=0.25),
    "raise and drive": Reshape(SIDES, 0.32, 0.01, forward=0.02),
    "engage": Engage(("L_bogie", "R_bogie")),
}


@pytest.mark.parametrize("part", [1.0, 0.5], ids=["done", "half done"])
@pytest.mark.parametrize("name", ACTIONS)
def test_undoing_goes_back(inverse, name, part):
    """From its end or from halfway, to the posture and the place where it began, wheels on the ground."""
    start = stand(inverse)
    execution, there = do(inverse, ACTIONS[name], start)
    if part < 1.0:
        whole = 0
        at = start.at
        while not execution.finished(at):
            at, whole = advance(at, execution.solve(at, execution.command(at)).velocity, DT), whole + 1
        execution, there = do(inverse, ACTIONS[name], start, most=whole // 2)
    _, back = do(inverse, execution.undo(there), there, back=True)
    assert back.grip == start.grip
    as_it_was(back.at, start.at, 3e-5)
    assert np.max(np.abs(back.at.contacts[:, 0])) < 1e-6
    if part == 1.0 and name != "engage":
        assert np.max(np.abs(there.at.q - start.at.q)) > 1e-2  # else nothing was undone


def test_goals(inverse):
    start, at = stand(inverse), {}
    for name, action in ACTIONS.items():
        at[name] = do(inverse, action, start)[1].at
    column = inverse.rover.column
    assert at["steer"].q[column["LF_st"]] == pytest.approx(0.4, abs=1e-6)
    assert at["steer"].q[:6] == pytest.approx(start.at.q[:6], abs=1e-4)  # the base stays
    assert turning_centre(at["steer to a centre"]) == pytest.approx((0.1, 1.5), abs=1e-4)
    assert at["roll"].q[0] - start.at.q[0] == pytest.approx(0.4, abs=1e-6)
    assert at["roll back"].q[0] - start.at.q[0] == pytest.approx(-0.4, abs=1e-6)
    assert clearance(at["raise"]) == pytest.approx(0.33, abs=1e-6)
    assert clearance(at["lower"]) == pytest.approx(0.28, abs=1e-6)
    for side in "LR":
        assert at["to an angle"].q[column[f"{side}_act"]] == pytest.approx(0.25, abs=1e-6)
    assert at["raise and drive"].q[0] - start.at.q[0] == pytest.approx(0.02 * 0.02 / 0.01, abs=2e-3)


def test_an_arc_there_and_back(inverse):
    """A quarter circle about a centre 1.5 m to the left, and along it back."""
    twist = Twist.about(0.0, 1.5, 0.05)
    _, start = do(inverse, SteerToward(SIDES, twist, 1.0), stand(inverse))
    execution, there = do(inverse, Drive(SIDES, twist, 1.5 * math.pi / 2), start)
    assert there.at.q[[0, 1, 3]] - start.at.q[[0, 1, 3]] == pytest.approx([1.5, 1.5, math.pi / 2], abs=5e-4)
    _, back = do(inverse, execution.undo(there), there, back=True)
    as_it_was(back.at, start.at, 1e-5)


def test_a_clutch_that_was_engaged_stays_engaged(inverse):
    """Undoing an engagement releases what it engaged, and no more; the same the other way round."""
    at = stand(inverse).at
    held = {"R_bogie": float(at.q[inverse.rover.column["R_bogie"]])}
    start = stand(inverse, grip=Grip(held))
    execution, there = do(inverse, Engage(("L_bogie", "R_bogie")), start)
    assert set(there.grip.clutches) == {"L_bogie", "R_bogie"}
    assert do(inverse, execution.undo(there), there)[1].grip == start.grip
    execution, there = do(inverse, Release(("L_bogie", "R_bogie")), start)
    assert there.grip.clutches == {}
    back = do(inverse, execution.undo(there), there)[1]
    assert dict(back.grip.clutches) == pytest.approx(held, abs=1e-12)


@pytest.mark.parametrize("wheels", [("RM",), ("LM", "RM")])
def test_lifting_there_and_back(inverse, wheels):
    clutches = tuple(f"{wheel[0]}_bogie" for wheel in wheels)
    before = stand(inverse, 0.36)
    _, start = do(inverse, Engage(clutches), before)
    execution, there = do(inverse, LiftWheels(SIDES, wheels, 0.03, 0.01), start)
    assert there.grip.lifted == wheels
    for place in there.at.index(wheels):
        assert height(there.at, int(place)) == pytest.approx(0.03, abs=1e-6)
    stance = rp.settle(
        inverse.rover, FLAT, x=there.at.q[0], y=there.at.q[1], yaw=there.at.q[3],
        joints={name: float(there.at.q[inverse.rover.column[name]]) for name in
                ("L_act", "R_act", *clutches, *steering_joints(there.at).values())},
    )  # fmt: skip
    assert stance.settled, stance.reason
    for wheel in wheels:
        assert stance.loads[wheel] == 0.0
        assert stance.gaps[wheel] == pytest.approx(0.03, abs=1e-5)
    execution, back = do(inverse, execution.undo(there), there, back=True)
    assert back.grip == start.grip
    as_it_was(back.at, start.at, 5e-5)
    assert np.max(np.abs(back.at.contacts[:, 0])) < 1.1e-6


REFUSED = {
    "way": (lambda: Drive(SIDES, Twist(forward=0.1), 0.0), "way: must be above 0 m (got 0.0)"),
    "turning in place": (
        lambda: Drive(SIDES, Twist(yaw=0.1), 1.0),
        "twist: does not move the rover (got Twist(forward=0.0, left=0.0, yaw=0.1));"
        " give forward=, left= or a centre away from the root link",
    ),
    "nan": (lambda: Drive(SIDES, Twist(yaw=math.nan), 1.0), "twist: yaw: must be a finite number (got nan)"),
    "nan direction": (
        lambda: crabbing(SIDES, Speeds(), 1.0, math.nan),
        "twist: forward: must be a finite number (got nan)",
    ),
    "nan way": (lambda: rolling(SIDES, Speeds(), math.nan), "way: must be a finite number (got nan)"),
    "speeds": (lambda: Speeds(lift=-1.0), "speed: lift: must be above 0 (got -1.0)"),
    "creeping": (
        lambda: creeping(SIDES, Speeds(), 0.3, 0.2, 1),
        "creeping: creeping needs low < high and at least one time (got '0.3 to 0.2 m, 1 times')",
    ),
    "height": (lambda: LiftWheels(SIDES, ("RM",), -0.1), "height: must be at least 0 m (got -0.1)"),
    "two of a side": (
        lambda: LiftWheels(SIDES, ("RM", "RB"), 0.1),
        "wheels: one wheel a side is lifted (got 'RM, RB')",
    ),
    "no wheel": (
        lambda: LiftWheels(SIDES, ("RX",), 0.1),
        "RX: no wheel of that name; did you mean 'RM' or 'RF' or 'RB'?",
    ),
    "steering speed": (
        lambda: Steer(SIDES, {"LF_st": 0.1}, 0.0),
        "steering speed: must be above 0 rad/s (got 0.0)",
    ),
    "two goals": (
        lambda: Reshape(SIDES, 0.3, 0.01, ("LM",), angle=0.1),
        "raise or lower: needs a clearance or an angle to go to, one of them",
    ),
    "hold": (
        lambda: Reshape(SIDES, 0.3, 0.01, ("LM",), "hand"),
        "hold: no way to hold (got 'hand'); drive or wheel",
    ),
    "brakes and drive": (
        lambda: Reshape(SIDES, 0.3, 0.01, ("LM",), forward=0.1),
        "raise or lower: needs wheels that are braked, or a speed to drive at, one of them",
    ),
    "clearance": (lambda: Reshape(SIDES, 0.0, 0.01, ("LM",)), "clearance: must be above 0 (got 0.0)"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refused_when_it_is_made(case):
    make, message = REFUSED[case]
    with pytest.raises(InputError) as caught:
        make()
    assert str(caught.value) == message


STANDING = {
    "clutch that is none": (
        Engage(("L_act",)),
        {},
        "L_act: is no joint that can be locked; known: L_bogie, R_bogie",
    ),
    "release of none": (Release(("L_bogi",)), {}, "L_bogi: is no joint that can be locked; did you mean"),
    "lift without clutch": (
        LiftWheels(SIDES, ("RM",), 0.1),
        {},
        "R_bogie: a wheel of the right side is lifted with its clutch engaged; engage it first",
    ),
    "release with a hanging wheel": (
        Release(("R_bogie",)),
        {"grip": Grip({"R_bogie": 0.0}, ("RM",))},
        "RM: hangs and would fall; let it down before the clutch is released",
    ),
    "steering beyond a limit": (Steer(SIDES, {"LF_st": 7.0}), {}, "LF_st"),
    "unknown steering": (Steer(SIDES, {"LF_str": 0.1}), {}, "LF_str"),
    "too fast": (
        Drive(SIDES, Twist(forward=0.3), 1.0),
        {},
        "_dr: roll asks for more speed than the joint has (got '2'); its limit is 1; command a lower speed",
    ),
}


@pytest.mark.parametrize("case", STANDING)
def test_refused_where_it_begins(inverse, case):
    action, state, message = STANDING[case]
    with pytest.raises(InputError) as caught:
        begun(inverse, action, stand(inverse, **state))
    assert message in str(caught.value)


def test_layouts(hit):
    left, right = SIDES.sides
    for sides, message in (
        ((Side("left", ("LF", "LX"), "L_diff", "L_act"), right), "wheel: no wheel of that name (got 'LX')"),
        ((left, Side("right", right.wheels, "R_dif", "R_act")),
         "right: hinge: no joint of that name (got 'R_dif')"),
        ((left, Side("right", right.wheels, "R_diff", "R_bogie")),
         "right: rocker: no driven joint of that name (got 'R_bogie')"),
        ((left, Side("right", right.wheels, "R_diff", "R_act", "R_act")),
         "right: clutch: no joint that can be locked (got 'R_act')"),
        ((left, left), "LF: stands on the sides twice; name each wheel once"),
        ((left, Side("right", right.wheels[:2], "R_diff", "R_act")),
         "sides: sides need as many wheels as each other, at least two (got '3 and 2')"),
    ):  # fmt: skip
        with pytest.raises(InputError) as caught:
            Layout(*sides).checked(hit)
        assert message in str(caught.value)
    assert SIDES.row_of("RB") == 2
    with pytest.raises(InputError, match="XY: no wheel of that name; known: LB, LF, LM, RB, RF, RM"):
        SIDES.side_of("XY")


def test_words_of_modes():
    assert crabbing(SIDES, Speeds(), 1.0).words == ("turn the wheels", "crab", "turn the wheels back")
    assert wheel_lifting(SIDES, Speeds(), ["RM"], 0.1, 0.0).words == (
        "engage R_bogie", "lift RM", "let down RM", "release R_bogie",
    )  # fmt: skip
    assert wheel_lifting(SIDES, Speeds(), ["LM", "RM"], 0.1, 1.0).name == "double_lift"
    both = hybrid("crossing", rolling(SIDES, Speeds(), 1.0), creeping(SIDES, Speeds(), 0.2, 0.3, 2))
    assert (both.name, both.words) == ("crossing", ("roll", "raise", "lower", "raise", "lower"))
    bare = Layout(*(Side(side.name, side.wheels, side.hinge, side.rocker) for side in SIDES.sides))
    with pytest.raises(InputError) as caught:
        wheel_lifting(bare, Speeds(), ["RM"], 0.1, 0.0)
    assert str(caught.value) == "right: clutch: a wheel is lifted by a side with a clutch (got 'RM')"
