"""Programs of steps against their conditions of optimality, solved exactly for the constraints that bind."""

import clarabel
import numpy as np
import pytest
from places import GROUNDS, ground, resting, rover
from scipy import sparse

from rover_pin.kinematics.inverse import InverseKinematics, usual_limits
from rover_pin.kinematics.limits import ContactKept, Held, JointLimits, SpeedLimits
from rover_pin.kinematics.rows import Rows
from rover_pin.kinematics.solver import solve
from rover_pin.kinematics.tasks import BaseTwist, Posture

MET = 1e-9
CLOSE = 5e-6
"""rad/s: of steering whose wheels bend sideways; damping alone decides there. Most agree within 1e-8."""


def one_sided(p):
    """(k, n), (k,): all inequalities of a program as rows x <= sides."""
    n = len(p.gradient)
    parts = ((p.matrix, p.high), (-p.matrix, -p.low), (np.eye(n), p.ceiling), (-np.eye(n), -p.floor))
    rows = np.vstack([matrix[np.isfinite(side)] for matrix, side in parts])
    return rows, np.concatenate([side[np.isfinite(side)] for _, side in parts])


def exactly(p):
    """The least of a program and how many inequalities bind.

    Clarabel proposes those that bind, linear equations give the point and the multipliers, and what is
    violated or pushes the wrong way changes places until the conditions of optimality hold.
    """
    rows, sides = one_sided(p)
    binding = proposed(p, rows, sides)
    for _ in range(50):
        x, pushes = bound_point(p, rows[binding], sides[binding])
        over = rows @ x - sides
        over[binding] = -np.inf
        if np.max(over) > MET:
            binding[np.argmax(over)] = True
        elif len(pushes) and np.min(pushes) < -MET:
            binding[np.flatnonzero(binding)[np.argmin(pushes)]] = False
        else:
            return x, int(binding.sum())
    raise AssertionError("no set of binding rows meets the conditions")


def bound_point(p, bound, sides):
    """Where equations and these rows hold with equality: the least point, multipliers of the rows."""
    n, held = len(p.gradient), np.vstack([p.equations, bound])
    kkt = np.block([[p.hessian, held.T], [held, np.zeros((len(held), len(held)))]])
    found = np.linalg.lstsq(kkt, np.concatenate([-p.gradient, p.right, sides]), rcond=1e-14)[0]
    return found[:n], found[n + len(p.right) :]


def proposed(p, rows, sides):
    """(k,) which of the rows bind, by an interior-point method."""
    options = clarabel.DefaultSettings()
    options.verbose = False
    found = clarabel.DefaultSolver(
        sparse.triu(sparse.csc_matrix(1e3 * p.hessian)).tocsc(), 1e3 * p.gradient,
        sparse.csc_matrix(np.vstack([p.equations, rows])), np.concatenate([p.right, sides]),
        [clarabel.ZeroConeT(len(p.right)), clarabel.NonnegativeConeT(len(sides))], options,
    ).solve()  # fmt: skip
    equal = len(p.right)
    return np.array(found.z)[equal:] > np.array(found.s)[equal:]


class Slow:
    """The base's height and roll between two rates, one of them bending."""

    def __init__(self, rate, bend):
        self.rate, self.bend = rate, bend

    def rows(self, at, dt):
        matrix = np.zeros((2, len(at.q)))
        matrix[0, 2], matrix[1, 5] = 1.0, 1.0
        return Rows(("height", "roll"), matrix, np.full(2, -self.rate), np.full(2, self.rate), self.bend)


@pytest.mark.parametrize("word", GROUNDS)
@pytest.mark.parametrize("name", ["hit_mrii", "rocker_bogie", "rigid4"])
def test_the_least_is_found(name, word):
    inverse, at = InverseKinematics(rover(name), ground(word)), resting(name, word)
    rng, bound = np.random.default_rng(7), 0
    for _ in range(6):
        speed = rng.normal(scale=0.2, size=3)
        fast = SpeedLimits(dict.fromkeys(at.rover.actuated, float(rng.uniform(0.05, 0.4))))
        bend = float(rng.choice([np.inf, 3.0]))
        tasks = [BaseTwist(forward=speed[0], left=speed[1], yaw=speed[2])]
        contacts = ContactKept(directions=("normal",)), ContactKept(directions=("roll",), bend=20.0)
        limits = (*usual_limits()[:2], *contacts, JointLimits(), fast, Slow(1e-3, bend))
        found = inverse.solve(at, tasks, limits)
        assert found.solved, found.reason
        expected, count = exactly(found.program)
        assert found.velocity == pytest.approx(expected[: len(at.q)], abs=CLOSE)
        bound += count
    assert bound > 6  # else nothing was at its limit, and this were linear algebra


@pytest.mark.parametrize("word", GROUNDS)
@pytest.mark.parametrize("name", ["hit_mrii", "rocker_bogie", "rigid4"])
def test_infeasible_steps_do_not_spin(name, word):
    """Left alone the solver takes ten thousand iterations, a hundred milliseconds, over some of these."""
    inverse, at = InverseKinematics(rover(name), ground(word)), resting(name, word)
    contradiction, brakes = Slow(-1.0, np.inf), Held(tuple(wheel.drive for wheel in at.rover.wheels))
    for limits in ((contradiction,), (contradiction, brakes)):
        found = inverse.solve(at, [BaseTwist(forward=1.0)], (*usual_limits(), *limits))
        assert found.fighting
        assert solve(found.program).iterations <= 300


def test_tasks_beyond_all_measure():
    """A wheel asked for 100 m/s: the usual manner gives up, the patient one does not."""
    inverse, at = InverseKinematics(rover("hit_mrii"), ground("flat")), resting("hit_mrii", "flat")
    found = inverse.solve(at, [BaseTwist(forward=1e4, yaw=-1e4)], usual_limits())
    assert found.solved, found.reason
    assert np.all(np.abs(found.velocity) <= at.rover.velocity + 1e-7)


@pytest.mark.parametrize(
    "held",
    [
        (Held(("LM_dr", "LB_dr")), Held(("LB_dr", "LM_dr"), "parking brake")),
        (Held(("L_act",)), Held(("L_act",)), Held(("L_act", "R_act"), "rocker")),
    ],
)
def test_a_joint_held_twice(held):
    """Two limits that say the same of a joint agree, whatever pulls at it."""
    inverse, at = InverseKinematics(rover("hit_mrii"), ground("flat")), resting("hit_mrii", "flat")
    tasks = [BaseTwist(forward=0.5, weight=100.0), Posture({"L_act": 0.3}, weight=100.0)]
    found = inverse.solve(at, tasks, (*usual_limits(), *held))
    assert found.solved, found.reason
    once = {joint: limit for limit in held for joint in limit.joints}
    single = inverse.solve(at, tasks, (*usual_limits(), Held(tuple(once))))
    assert found.velocity == pytest.approx(single.velocity, abs=1e-8)


def test_everything_held():
    inverse, at = InverseKinematics(rover("hit_mrii"), ground("flat")), resting("hit_mrii", "flat")
    found = inverse.solve(at, [BaseTwist(forward=1.0)], (Held(at.rover.dof_names),))
    assert found.solved, found.reason
    assert not np.any(found.velocity)
    assert found.missed["base twist"] == pytest.approx(1.0)
