"""One step of inverse kinematics: against another solver, and what it must obey whatever is asked."""

import clarabel
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from places import GROUNDS, ground, resting, rover
from scipy import sparse

import rover_pin as rp
from rover_pin.errors import InputError, OffMapError
from rover_pin.kinematics.advance import Sliding, advance
from rover_pin.kinematics.inverse import InverseKinematics, usual_limits
from rover_pin.kinematics.limits import Clutch, ContactKept, Held, JointLimits, SpeedLimits, rolling_contacts
from rover_pin.kinematics.rolling import contact_rows
from rover_pin.kinematics.rows import Aim, Rows
from rover_pin.kinematics.solution import Outcome
from rover_pin.kinematics.steering import steering_joints
from rover_pin.kinematics.tasks import (
    BaseTwist,
    CenterOfMass,
    Clearance,
    FrameGoal,
    Posture,
    Rates,
    WheelLift,
)

STEERING = tuple(f"{wheel}_st" for wheel in ("LF", "LM", "LB", "RF", "RM", "RB"))


def kinematics(name="hit_mrii", word="flat"):
    return InverseKinematics(rover(name), ground(word)), resting(name, word)


class Between:
    """A limit given by hand."""

    def __init__(self, name, row, low, high, bend=np.inf):
        self.parts = (name,), np.atleast_2d(row), np.array([low]), np.array([high]), bend

    def rows(self, at, dt):
        return Rows(*self.parts)


def unit(at, name):
    row = np.zeros(len(at.q))
    row[at.rover.column[name]] = 1.0
    return row


def by_clarabel(program):
    """The same program by an interior-point method."""
    p, n = program, len(program.gradient)
    rows, sides, cones = [p.equations], [p.right], [clarabel.ZeroConeT(len(p.right))]
    for matrix, side in (
        (p.matrix, p.high), (-p.matrix, -p.low), (np.eye(n), p.ceiling), (-np.eye(n), -p.floor)
    ):  # fmt: skip
        finite = np.isfinite(side)
        rows.append(matrix[finite])
        sides.append(side[finite])
        cones.append(clarabel.NonnegativeConeT(int(finite.sum())))
    options = clarabel.DefaultSettings()
    options.verbose = False
    options.tol_gap_abs = options.tol_gap_rel = options.tol_feas = 1e-12
    solver = clarabel.DefaultSolver(
        sparse.triu(sparse.csc_matrix(p.hessian)).tocsc(), p.gradient, sparse.csc_matrix(np.vstack(rows)),
        np.concatenate(sides), cones, options,
    )  # fmt: skip
    return np.array(solver.solve().x)


@pytest.mark.parametrize("word", GROUNDS)
@pytest.mark.parametrize("name", ["hit_mrii", "rocker_bogie", "rigid4"])
def test_another_solver_finds_the_same(name, word):
    inverse, at = kinematics(name, word)
    rng = np.random.default_rng(5)
    for _ in range(4):
        speed = rng.normal(scale=0.1, size=3)
        tasks = [BaseTwist(forward=speed[0], left=speed[1], yaw=speed[2])]
        slow = SpeedLimits(dict.fromkeys(at.rover.actuated, 0.2))
        limits = (*usual_limits()[:2], ContactKept(directions=("normal",)), JointLimits(), slow,
                  Between("creep", unit(at, "base_x"), -0.01, 0.01),
                  Between("soft", unit(at, "base_y"), -0.001, 0.001, bend=3.0))  # fmt: skip
        found = inverse.solve(at, tasks, limits)
        assert found.solved, found.reason
        expected = by_clarabel(found.program)
        assert found.velocity == pytest.approx(expected[: len(at.q)], abs=2e-5)
        p = found.program
        cost = [0.5 * x @ p.hessian @ x + p.gradient @ x for x in (
            np.concatenate([found.velocity, list(found.slack.values())]), expected)]  # fmt: skip
        assert cost[0] == pytest.approx(cost[1], abs=1e-8)


def test_what_bends_gives_way_by_its_weight():
    """Forward at 1 against a bound of 0 that bends: w (v - 1) + b v = 0, and the task may be that weak."""
    inverse, at = kinematics()
    still = Between("soft wall", np.cos(0.7) * unit(at, "base_x") + np.sin(0.7) * unit(at, "base_y"),
                    -np.inf, 0.0, bend=3.0)  # fmt: skip
    found = inverse.solve(at, [BaseTwist(forward=1.0, left=0.0, yaw=0.0)], (still,))
    assert found.slack["soft wall"] == pytest.approx(-0.25, abs=1e-4)
    assert found.missed["base twist"] == pytest.approx(0.75, abs=1e-4)


@given(
    forward=st.floats(-0.5, 0.5), left=st.floats(-0.5, 0.5), yaw=st.floats(-0.5, 0.5),
    rate=st.floats(-0.05, 0.05), word=st.sampled_from(GROUNDS),
)  # fmt: skip
@settings(max_examples=12, deadline=None)
def test_whatever_is_asked(forward, left, yaw, rate, word):
    """Couplings stay, wheels stay on the ground, joints within limits of place and speed."""
    inverse, at = kinematics("hit_mrii", word)
    start = at
    slip = ContactKept(directions=("slip",), bend=10.0)
    limits = (*usual_limits()[:2], ContactKept(directions=("normal", "roll")), slip, *usual_limits()[4:])
    for _ in range(40):
        tasks = [BaseTwist(forward=forward, left=left, yaw=yaw), Clearance(rate=rate)]
        found = inverse.solve(at, tasks, limits, dt=0.02)
        assert found.solved, found.reason
        assert max(found.residuals.values()) < 1e-7
        assert np.all(np.abs(found.velocity) <= at.rover.velocity + 1e-7)
        at = advance(at, found.velocity, 0.02)
        assert np.all(at.q >= at.rover.lower - 1e-9)
        assert np.all(at.q <= at.rover.upper + 1e-9)
    for coupling in at.rover.couplings:
        assert coupling.row @ at.q - coupling.offset == pytest.approx(0.0, abs=1e-8)
    way = np.linalg.norm(at.q[:2] - start.q[:2])
    assert np.max(np.abs(at.contacts[:, 0])) < 2e-6 + 3e-4 * way


def test_tasks_reach_their_goals():
    inverse, at = kinematics()
    goals = [Clearance(goal=0.3, speed=0.05), BaseTwist(forward=0.0, left=0.0, yaw=0.0, weight=0.1)]
    still = Held(STEERING, "steering")
    for _ in range(200):
        at = advance(at, inverse.solve(at, goals, (*usual_limits(), still)).velocity, 0.01)
    assert goals[0].aim(at, 0.01).target[0] == pytest.approx(0.0, abs=1e-4)
    wanted = at.com[:2] + 0.05 * np.array([np.cos(at.heading), np.sin(at.heading)])
    goals = [CenterOfMass((*wanted, None), gain=0.2)]
    for _ in range(300):
        found = inverse.solve(at, goals, (*usual_limits(), still, Held(("L_act", "R_act"))))
        at = advance(at, found.velocity, 0.01)
    assert at.com[:2] == pytest.approx(wanted, abs=1e-4)
    along = np.array([np.cos(at.heading), np.sin(at.heading), 0.0])
    wanted = at.frame("base_link")[1] + 0.03 * along + (0.0, 0.0, 0.02)
    for _ in range(300):
        found = inverse.solve(at, [FrameGoal("base_link", wanted)], usual_limits())
        at = advance(at, found.velocity, 0.01)
    assert at.frame("base_link")[1] == pytest.approx(wanted, abs=1e-4)
    for _ in range(200):
        found = inverse.solve(at, [Posture({"LF_st": 0.2, "RF_st": 0.2}, speed=1.0)], usual_limits())
        at = advance(at, found.velocity, 0.01)
    assert at.q[at.rover.column["LF_st"]] == pytest.approx(0.2, abs=1e-3)


def test_a_lifted_wheel():
    inverse, at = kinematics()
    clutch = Clutch({"R_bogie": float(at.q[at.rover.column["R_bogie"]])})
    limits = (*usual_limits()[:2], *rolling_contacts(("RF",)), *usual_limits()[4:], clutch)
    for _ in range(300):
        found = inverse.solve(at, [WheelLift("RF", height=0.02, speed=0.02)], limits)
        assert found.solved, found.reason
        at = advance(at, found.velocity, 0.01)
    assert at.contacts[at.index(["RF"])[0], 0] == pytest.approx(0.02, abs=1e-5)
    assert at.q[at.rover.column["R_bogie"]] == pytest.approx(clutch.joints["R_bogie"], abs=1e-9)


def test_the_same_instant_gives_the_same_answer():
    inverse, at = kinematics("hit_mrii", "rough:3,0.04,0.8")
    asked = [BaseTwist(forward=0.02)]
    first = inverse.solve(at, asked)
    inverse.solve(resting("hit_mrii", "flat"), [BaseTwist(forward=-0.3, yaw=1.0)])
    again = inverse.solve(at, asked)
    for part in ("hessian", "gradient", "equations", "right", "matrix", "low", "high", "floor", "ceiling"):
        assert np.array_equal(getattr(again.program, part), getattr(first.program, part)), part
    # ProxQP adds in another order where its memory lies otherwise
    assert again.velocity == pytest.approx(first.velocity, abs=1e-12)


def test_units_do_not_matter():
    """A rover twice as large twice as fast has twice the speeds and the same rates of joints."""
    small = rp.load("rocker_bogie")
    inverse = InverseKinematics(small, ground("flat"))
    at = inverse.at(rp.settle(small, ground("flat")))
    found = inverse.solve(at, [BaseTwist(forward=0.1, weight=1.0)])
    other = inverse.solve(at, [BaseTwist(forward=0.2, weight=1.0)])
    assert other.velocity == pytest.approx(2.0 * found.velocity, abs=1e-6)


def test_refusals():
    inverse, at = kinematics()
    for make, message in (
        (lambda: BaseTwist(), "base twist: asks for nothing; give forward=, left=, yaw=, ..."),
        (lambda: BaseTwist(forward=np.nan), r"base twist: forward: must be a finite number \(got nan\)"),
        (lambda: Clearance(), "clearance: needs a rate or a goal, one of them"),
        (lambda: Posture({}), "posture: names no joint"),
        (lambda: Rates({"L_act": np.inf}), r"rates: L_act: must be a finite number \(got inf\)"),
        (lambda: JointLimits(0.0), r"joint limits: gain: a gain lies above 0 and is at most 1 \(got 0.0\)"),
        (lambda: SpeedLimits({"L_act": 0.0}), r"speed of L_act: a speed limit is above 0 \(got 0.0\)"),
        (lambda: ContactKept(directions=("up",)), r"contact: is no direction of a contact \(got 'up'\)"),
        (lambda: FrameGoal("base_link", rotation=np.ones((3, 3))), "rotation: is no rotation matrix"),
        (lambda: FrameGoal("base_link", rotation=np.diag([1.0, 1.0, -1.0])),
         "frame base_link: rotation: is no rotation matrix"),
        (lambda: FrameGoal("base_link", rotation=np.eye(3), lever=0.0), "lever: must be above 0"),
        (lambda: Posture({"L_act": 0.0}, speed=-0.1), r"posture: speed: must be above 0 \(got -0.1\)"),
        (lambda: Clearance(goal=0.3, speed=0.0), r"clearance: speed: must be above 0 \(got 0.0\)"),
        (lambda: WheelLift("RF", height=0.1, speed=np.nan), "lift of RF: speed: must be a finite number"),
        (lambda: BaseTwist(yaw=1.0, weight=-1.0), r"a weight is a finite number, at least 0 \(got -1.0\)"),
        (lambda: ContactKept(bend=-1.0), r"contact: bend: a weight is a finite number, at least 0"),
        (lambda: ContactKept(directions=()), "contact: keeps no direction; known: normal, roll, slip"),
        (lambda: CenterOfMass((None, None, None)), "centre of mass: needs x, y, z, one of them a number"),
        (lambda: WheelLift("RF"), "lift of RF: needs a rate or a height, one of them"),
        (lambda: InverseKinematics(rover("rigid4"), ground("flat"), damping=0.0), "damping: must be above 0"),
        (lambda: inverse.solve(at, [BaseTwist(forward=1.0)], dt=0.0), r"dt: must be above 0 s \(got 0.0\)"),
        (lambda: inverse.solve(at, [Rates({"L_akt": 1.0})]),
         r"rates: no coordinate of that name \(got 'L_akt'\); did you mean"),
        (lambda: inverse.solve(at, [], (Clutch({"L_act": 0.0}),)),
         r"clutch: is no joint that can be locked \(got 'L_act'\)"),
        (lambda: inverse.solve(at, [], (Between("gauge", unit(at, "L_act"), np.nan, 1.0),)),
         "gauge: has an entry that is no finite number; a rate, a measured value"),
    ):  # fmt: skip
        with pytest.raises(InputError, match=message):
            make()


def test_steering_does_not_wander():
    """Free steering would serve a step's slip a little and leave wheels askew: it holds unless asked."""
    inverse, at = kinematics("rocker_bogie", "rough:3,0.04,0.8")
    joints = [at.rover.column[joint] for joint in steering_joints(at).values()]
    before, sliding = at.q[joints], Sliding(at)
    for _ in range(200):
        at = advance(at, inverse.solve(at, [BaseTwist(forward=0.05)], dt=0.02).velocity, 0.02)
        slid = sliding.step(at)
    assert np.array_equal(at.q[joints], before)
    assert np.max(slid) < 1e-3
    turned = inverse.solve(at, [BaseTwist(forward=0.05), Rates({"steer_fl": 0.1}, weight=100.0)])
    assert turned.rates["steer_fl"] == pytest.approx(0.1, abs=1e-3)
    assert turned.rates["steer_fr"] == 0.0


def test_a_users_task_is_named():
    class Mine:
        name = "my task"

        def aim(self, at, dt):
            return Aim(np.full((1, len(at.q)), np.nan), np.zeros(1), np.ones(1))

    inverse, at = kinematics()
    with pytest.raises(InputError, match="my task: has an entry that is no finite number"):
        inverse.solve(at, [BaseTwist(forward=0.0), Mine()])


def test_tasks_of_one_name_are_told_apart():
    inverse, at = kinematics()
    found = inverse.solve(at, [Rates({"LF_st": 0.1}), Rates({"RF_st": 0.2}), BaseTwist(yaw=0.0)], ())
    assert list(found.missed) == ["rates", "rates 2", "base twist"]
    assert found.missed["rates 2"] < 1e-6


def test_what_equations_that_bend_are_missed_by():
    """Skid steering: what the slip rows are missed by is told like any other slack."""
    inverse, at = kinematics("rigid4", "flat")
    limits = (*usual_limits()[:2], *rolling_contacts(slip=1e-3), *usual_limits()[4:])
    found = inverse.solve(at, [BaseTwist(yaw=0.3, forward=0.0)], limits)
    assert found.solved, found.reason
    slip = contact_rows(at, np.arange(4), ("slip",)) @ found.velocity
    assert np.abs(slip).max() > 0.05
    told = [found.slack[f"side slip of {name}"] for name in at.bodies.names]
    assert told == pytest.approx(-slip, abs=1e-9)


def test_the_edge_of_the_map():
    small = rp.Terrain.from_grid(np.zeros((41, 41)), spacing=0.1)
    inverse = InverseKinematics(rover("hit_mrii"), small)
    at = inverse.at(rp.settle(rover("hit_mrii"), small, x=2.0, y=2.0))
    assert inverse.solve(at, [BaseTwist(forward=0.1)]).solved
    with pytest.raises(OffMapError) as caught:
        inverse.solve(list(at.q + 1.2 * np.eye(len(at.q))[0]), [BaseTwist(forward=0.1)])
    assert str(caught.value) == "LF: is not over the map; the map spans x 0 to 4 m, y 0 to 4 m"


def test_nothing_asked_is_standing_still():
    inverse, at = kinematics()
    assert inverse.solve(at, []).velocity == pytest.approx(0.0, abs=1e-12)
    assert inverse.solve(at, []).outcome is Outcome.SOLVED
    assert inverse.solve(at, []).rates["L_act"] == pytest.approx(0.0, abs=1e-12)
