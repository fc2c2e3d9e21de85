"""Infeasible steps name a smallest set of rows that fight."""

import dataclasses

import numpy as np
import pytest
from places import ground, resting, rover
from scipy.optimize import linprog

from rover_pin.kinematics.conflict import conflict
from rover_pin.kinematics.inverse import InverseKinematics, usual_limits
from rover_pin.kinematics.limits import Held, SpeedLimits
from rover_pin.kinematics.rows import Rows
from rover_pin.kinematics.solution import Outcome
from rover_pin.kinematics.tasks import BaseTwist

DRIVES = tuple(f"{wheel}_dr" for wheel in ("LF", "LM", "LB", "RF", "RM", "RB"))


class Forward:
    """The root link's speed along x, between two."""

    def __init__(self, low, high=np.inf):
        self.sides = np.array([low]), np.array([high])

    def rows(self, at, dt):
        row = np.zeros((1, len(at.q)))
        row[0, 0], row[0, 1] = np.cos(at.heading), np.sin(at.heading)
        return Rows(("forward speed",), row, *self.sides)


def step(*limits, name="hit_mrii", word="flat"):
    inverse = InverseKinematics(rover(name), ground(word))
    return inverse.solve(resting(name, word), [BaseTwist(yaw=0.0)], limits)


def agrees(program, without=None, names=None):
    """Whether rows hold together by linprog; only those whose name is in `names`, but for `without`."""
    p, n = program, len(program.gradient)
    bounds = [f"bound {i} {side}" for i in range(n) for side in ("low", "high")]

    def kept(name):
        return (names is None or name in names) and name != without

    equal = [i for i, name in enumerate(p.equation_names) if kept(name)]
    between = [i for i, name in enumerate(p.row_names) if kept(name)]
    upper = [(p.matrix[i], p.high[i]) for i in between if np.isfinite(p.high[i])]
    upper += [(-p.matrix[i], -p.low[i]) for i in between if np.isfinite(p.low[i])]
    limits = []
    for i in range(n):
        low, high = (
            side if kept(bounds[2 * i + k]) else None for k, side in enumerate((p.floor[i], p.ceiling[i]))
        )
        limits.append((low if low is not None and np.isfinite(low) else None,
                       high if high is not None and np.isfinite(high) else None))  # fmt: skip
    found = linprog(
        np.zeros(n),
        A_ub=np.array([row for row, _ in upper]) if upper else None,
        b_ub=[side for _, side in upper] if upper else None,
        A_eq=p.equations[equal] if equal else None,
        b_eq=p.right[equal] if equal else None,
        bounds=limits,
    )
    return found.status != 2


CASES = {
    "brakes": (*usual_limits(), Held(DRIVES), Forward(0.05)),
    "speed": (*usual_limits()[:4], SpeedLimits(dict.fromkeys(DRIVES, 0.1)), Forward(0.05)),
    "box": (SpeedLimits({"L_act": 0.1}), *usual_limits()[:4], Forward(0.02, 0.01)),
}


@pytest.mark.parametrize("case", CASES)
def test_the_set_is_smallest(case):
    found = step(*CASES[case])
    assert found.outcome is Outcome.INFEASIBLE
    assert not np.any(found.velocity)
    assert found.fighting
    program, nv = found.program, found.program.nv
    names = {
        (i, upper): f"bound {i} {'high' if upper else 'low'}" for i in range(nv) for upper in (False, True)
    }
    fighting = {side.name for side in conflict(program, names)}
    assert not agrees(program)
    assert not agrees(program, names=fighting)
    for name in fighting:
        assert agrees(program, without=name, names=fighting), name


def test_words():
    found = step(*CASES["brakes"])
    assert found.reason.startswith("these cannot hold together: ")
    assert "forward speed >= 0.05" in found.reason
    assert "brake of" in found.reason
    told = step(Forward(0.02, 0.01)).reason
    assert told == "these cannot hold together: forward speed >= 0.02; forward speed <= 0.01"


def test_a_box_that_contradicts_itself():
    class Wrong:
        def box(self, at, dt):
            low = np.full(len(at.q), -1.0)
            low[at.rover.column["L_act"]] = 0.5
            high = np.full(len(at.q), 1.0)
            high[at.rover.column["L_act"]] = 0.4
            return low, high

        def bound_name(self, dof, upper):
            return f"{'most' if upper else 'least'} of {dof}"

    told = step(Wrong()).reason
    assert told == "these cannot hold together: least of L_act >= 0.5; most of L_act <= 0.4"


def test_rows_that_agree_do_not_fight():
    found = step(*usual_limits())
    assert conflict(found.program, {}) == ()


def test_no_precision_is_a_status(monkeypatch):
    """Where the solver stops short and nothing fights, that is what is said."""
    from rover_pin.kinematics import inverse

    def stops(program):
        from rover_pin.kinematics.solver import Answer

        return Answer(np.zeros(len(program.gradient)), False, 0.5, 0.1, 100)

    monkeypatch.setattr(inverse, "solve", stops)
    monkeypatch.setattr(inverse, "solve_patiently", stops)
    found = step(*usual_limits())
    assert found.outcome is Outcome.NO_CONVERGENCE
    assert found.reason == "the solver did not reach its precision (rows missed by 0.5)"


def test_a_wrong_answer_is_not_believed():
    """Residuals are worked out from the program, whatever the solver says of itself."""
    from rover_pin.kinematics.solver import solve

    program = step(*usual_limits()).program
    assert solve(program).solved
    torn = dataclasses.replace(program, ceiling=program.floor - 1.0)
    assert not solve(torn).solved
