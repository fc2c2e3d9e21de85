"""Rovers that are no six-wheelers: closed loops, a caster, legs with feet; two hundred random steps."""

import sys
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from places import FIXTURES, difference, ground

import rover_pin as rp
from rover_pin.kinematics.advance import Sliding, advance
from rover_pin.kinematics.inverse import InverseKinematics, hanging, usual_limits
from rover_pin.kinematics.limits import LoopsClosed
from rover_pin.kinematics.rolling import contact_rows
from rover_pin.kinematics.tasks import BaseTwist, FrameGoal

ROBOTS = Path(sys.prefix).glob("lib/python*/site-packages/cmeel.prefix/share/example-robot-data/robots")
ANYMAL = next(iter(ROBOTS)) / "anymal_b_simple_description/robots/anymal.urdf"
LEGS = ("LF", "RF", "LH", "RH")
GROUNDS = ("flat", "slope:8", "rough:3,0.02,0.8")


@cache
def rover(name, folder):
    if name != "anymal":
        return rp.load(FIXTURES / name / f"{name}.urdf")
    feet = "".join(f"  - {{frame: {leg}_FOOT, radius: 0.02, friction: 0.7}}\n" for leg in LEGS)
    bent = ", ".join(
        f"{leg}_HFE: {s}0.7, {leg}_KFE: {t}1.4" for leg, s, t in zip(LEGS, "  --", "--  ", strict=True)
    )
    sidecar = folder / "feet.yaml"
    sidecar.write_text(f"schema: 1\npassive: []\ncontacts:\n{feet}postures: {{stand: {{{bent}}}}}\n")
    return rp.load(ANYMAL, sidecar=sidecar)


@pytest.fixture(scope="module")
def resting(tmp_path_factory):
    folder = tmp_path_factory.mktemp("legs")

    @cache
    def stand(name, word):
        posture = "stand" if name == "anymal" else None
        stance = rp.settle(rover(name, folder), ground(word), x=3.3, y=3.4, yaw=0.7, posture=posture)
        assert stance.settled, stance.reason
        inverse = InverseKinematics(rover(name, folder), ground(word))
        return inverse, inverse.at(stance)

    return stand


@pytest.mark.parametrize("word", GROUNDS)
@pytest.mark.parametrize("name", ["four_bar", "turnbuckle"])
def test_rows_of_loops(resting, name, word):
    _, at = resting(name, word)
    rows = LoopsClosed().rows(at, 0.01)
    apart = difference(
        lambda now: np.concatenate([loop.residual(now.mechanism) for loop in now.rover.loops]), at
    )
    assert rows.matrix == pytest.approx(apart, abs=1e-8)
    assert rows.names[0].endswith(" row 1")


@pytest.mark.parametrize("word", GROUNDS)
def test_rows_of_feet(resting, word):
    """A ball that touches: the gap's rate is its centre's along the normal, sliding is rolling about it."""
    _, at = resting("anymal", word)
    which = np.arange(4)
    gaps, *along = np.split(contact_rows(at, which), 3)
    assert gaps == pytest.approx(difference(lambda now: now.contacts[:, 0], at), abs=1e-6)
    places = at.contacts[:, 1:4]
    for rows, directions in zip(along, (at.rolling, at.sideways), strict=True):
        for k in which.tolist():
            body = at.rover.feet[k].joint
            local = at.placed[body].actInv(places[k])

            def moved(now, body=body, local=local, direction=directions[k]):
                return direction @ now.placed[body].act(local)

            assert rows[k] == pytest.approx(difference(moved, at)[0], abs=1e-6)


@pytest.mark.parametrize("name", ["four_bar", "turnbuckle", "caster3", "anymal"])
@given(
    forward=st.floats(-0.05, 0.05), yaw=st.floats(-0.1, 0.1), up=st.floats(-0.02, 0.02),
    word=st.sampled_from(GROUNDS[:2]),
)  # fmt: skip
@settings(max_examples=3, deadline=None, derandomize=True)
def test_two_hundred_steps(resting, name, forward, yaw, up, word):
    """Joints stay within limits, loops and couplings closed to 1e-8, contacts within 5e-6 m."""
    inverse, at = resting(name, word)
    tasks = [BaseTwist(forward=forward, yaw=yaw, up=up if name == "anymal" else None)]
    sliding = Sliding(at)
    for _ in range(200):
        found = inverse.solve(at, tasks, dt=0.005)
        assert found.solved, found.reason
        at = advance(at, found.velocity, 0.005)
        slid = sliding.step(at)
        inside = np.isfinite(at.rover.lower) & np.isfinite(at.rover.upper)
        assert np.all(at.q[inside] >= at.rover.lower[inside] - 1e-9)
        assert np.all(at.q[inside] <= at.rover.upper[inside] + 1e-9)
    for coupling in at.rover.couplings:
        assert coupling.row @ at.q == pytest.approx(coupling.offset, abs=1e-8)
    for loop in at.rover.loops:
        assert loop.residual(at.mechanism) == pytest.approx(0.0, abs=1e-8)
    assert np.max(np.abs(at.contacts[:, 0])) < 5e-6
    if name == "anymal":
        assert np.max(slid) < 1e-3  # feet hold across too, whatever is asked


def test_a_foot_goes_to_its_goal(resting):
    """Three feet stand, the fourth is lifted and carried 10 cm ahead."""
    inverse, at = resting("anymal", "flat")
    along = np.array([np.cos(at.heading), np.sin(at.heading), 0.0])
    goal = at.frame("LF_FOOT")[1] + 0.1 * along + (0.0, 0.0, 0.05)
    tasks = [FrameGoal("LF_FOOT", goal, speed=0.5), BaseTwist(forward=0.0, left=0.0, up=0.0, yaw=0.0)]
    for _ in range(150):
        found = inverse.solve(at, tasks, usual_limits(("LF_FOOT",)))
        assert found.solved, found.reason
        at = advance(at, found.velocity, 0.01)
    assert at.frame("LF_FOOT")[1] == pytest.approx(goal, abs=1e-4)
    assert hanging(at) == ("LF_FOOT",)


def test_a_wheel_in_the_air_stands_once_it_is_down(resting):
    """On rough ground a rigid quadruped stands on three feet; the fourth is not pulled down at once."""
    inverse, at = resting("anymal", GROUNDS[2])
    foot = hanging(at)
    assert len(foot) == 1
    gap = at.contacts[at.index(foot)[0], 0]
    found = inverse.solve(at, [BaseTwist(up=-0.01)])
    assert found.solved, found.reason
    assert not np.any([foot[0] in name for name in found.program.equation_names])
    down = FrameGoal(foot[0], (None, None, float(at.frame(foot[0])[1][2] - gap)), speed=0.1)
    for _ in range(100):
        found = inverse.solve(at, [down])
        assert found.solved, found.reason
        at = advance(at, found.velocity, 0.01)
    assert hanging(at) == ()
    assert np.max(np.abs(at.contacts[:, 0])) < 1e-6


def test_two_instants_at_once(resting):
    """An instant's mechanism, centre of mass and frames are its own while others are made."""
    _, at = resting("four_bar", GROUNDS[2])
    loop = at.rover.loops[0]
    before = loop.residual(at.mechanism), loop.jacobian(at.mechanism), at.com_rows
    rng = np.random.default_rng(2)
    other = at.bodies.at(at.q + 0.1 * rng.normal(size=len(at.q)))
    assert np.abs(loop.residual(other.mechanism)).max() > 1e-3
    assert loop.residual(at.mechanism) == pytest.approx(before[0], abs=1e-15)
    assert other.com.shape == (3,)
    again = at.bodies.at(at.q)
    assert other.frame("upper_link_l")[0] > 0
    assert again.com_rows == pytest.approx(before[2], abs=1e-15)
    assert loop.jacobian(at.mechanism) == pytest.approx(before[1], abs=1e-15)
